#include "frame_sink.h"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "diaphane/texture.h"
#include "fmt/format.h"
#include "frame_folder.h"
#include "media/animation.h"
#include "output_file.h"
#include "status.h"

namespace diaphane::cli {
namespace {

namespace fs = std::filesystem;

class StdoutSink : public FrameSink {
 public:
  absl::Status add(const StreamedFrame& frame) override {
    const std::string& bytes = frame.frame.image;
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0) {
      return absl::OkStatus();
    }
    return with_exit_code(absl::DataLossError("stdout: cannot be written"), kExitFile);
  }
};

class FileSink : public FrameSink {
 public:
  explicit FileSink(fs::path path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {}
  ~FileSink() override {
    if (file_ != nullptr) std::fclose(file_);
  }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  bool opened() const { return file_ != nullptr; }
  absl::Status add(const StreamedFrame& frame) override {
    const std::string& bytes = frame.frame.image;
    return written(std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size());
  }
  absl::Status finish() override { return written(std::fclose(std::exchange(file_, nullptr)) == 0); }

 private:
  absl::Status written(bool well) const {
    if (well) return absl::OkStatus();
    return with_exit_code(absl::DataLossError(fmt::format("{}: cannot be written", path_.string())), kExitFile);
  }

  fs::path path_;
  std::FILE* file_;
};

class FolderSink : public FrameSink {
 public:
  explicit FolderSink(FrameFolder folder) : folder_(std::move(folder)) {}
  absl::Status add(const StreamedFrame& frame) override { return folder_.write(count_++, frame.frame.image); }

 private:
  FrameFolder folder_;
  uint32_t count_ = 0;
};

class MovieSink : public FrameSink {
 public:
  MovieSink(std::unique_ptr<media::AnimationWriter> movie, const Size& size) : movie_(std::move(movie)), size_(size) {}

  absl::Status add(const StreamedFrame& frame) override {
    absl::StatusOr<TextureData> picture = decode_texture(frame.frame.image, true);
    absl::Status status = picture.status();
    if (status.ok()) {
      status =
          movie_->add({static_cast<int>(size_.width_px), static_cast<int>(size_.height_px), std::move(picture->rgba)});
    }
    return with_exit_code(status, kExitFile);
  }
  absl::Status finish() override { return with_exit_code(movie_->finish(), kExitFile); }

 private:
  const std::unique_ptr<media::AnimationWriter> movie_;
  const Size size_;
};

std::string_view extension_of(ImageFormat format) {
  return format == ImageFormat::kPng ? ".png" : format == ImageFormat::kWebp ? ".webp" : ".jpg";
}

}  // namespace

absl::StatusOr<std::unique_ptr<FrameSink>> open_frame_sink(const std::string& output, ImageFormat format,
                                                           const Size& size, double frames_per_second) {
  if (output == "-") return std::make_unique<StdoutSink>();
  const std::string extension = fs::path(output).extension().string();
  if (extension == ".h264" || extension == ".mp4") {
    const bool bare = extension == ".h264";
    if (bare != (format == ImageFormat::kH264)) {
      return usage_error("--encoding", bare ? "must be h264 for an .h264" : "must be a picture's for an .mp4");
    }
    if (absl::Status status = check_writable(output); !status.ok()) return status;
    if (bare) {
      auto file = std::make_unique<FileSink>(output);
      if (file->opened()) return file;
      return with_exit_code(absl::InternalError(fmt::format("{}: cannot be opened", output)), kExitFile);
    }
    auto movie = media::open_mp4(output, {.width_px = static_cast<int>(size.width_px),
                                          .height_px = static_cast<int>(size.height_px),
                                          .frames_per_second = std::min(frames_per_second, 120.0)});
    if (!movie.ok()) return with_exit_code(movie.status(), kExitFile);
    return std::make_unique<MovieSink>(*std::move(movie), size);
  }
  if (format == ImageFormat::kH264) return usage_error("--encoding", "h264 goes to an .h264 or to stdout");
  absl::StatusOr<FrameFolder> folder = FrameFolder::open(output, extension_of(format), "{\"stream\": true}\n");
  if (!folder.ok()) return folder.status();
  return std::make_unique<FolderSink>(*std::move(folder));
}

}  // namespace diaphane::cli
