#include <cmath>
#include <fstream>
#include <system_error>

#include "fmt/format.h"
#include "media/animation.h"
#include "webp/encode.h"
#include "webp/mux.h"

namespace diaphane::media {
namespace {

namespace fs = std::filesystem;

// libwebp's trade of time against size, 0..6.
constexpr int kEffort = 2;

struct DeleteEncoder {
  void operator()(WebPAnimEncoder* encoder) const { WebPAnimEncoderDelete(encoder); }
};

struct WebpPicture : WebPPicture {
  WebpPicture() { WebPPictureInit(this); }
  ~WebpPicture() { WebPPictureFree(this); }
  WebpPicture(const WebpPicture&) = delete;
  WebpPicture& operator=(const WebpPicture&) = delete;
};

struct WebpData : WebPData {
  WebpData() { WebPDataInit(this); }
  ~WebpData() { WebPDataClear(this); }
  WebpData(const WebpData&) = delete;
  WebpData& operator=(const WebpData&) = delete;
};

class WebpWriter final : public AnimationWriter {
 public:
  WebpWriter(fs::path path, const AnimationOptions& options, WebPAnimEncoder* encoder)
      : path_(std::move(path)), options_(options), encoder_(encoder) {}

  absl::Status add(const Picture& frame) override {
    if (absl::Status status = check_frame(frame, options_); !status.ok()) return status;
    const Picture opaque = over(frame, {});
    WebpPicture picture;
    picture.use_argb = 1;
    picture.width = frame.width_px;
    picture.height = frame.height_px;
    WebPConfig config;
    if (WebPConfigPreset(&config, WEBP_PRESET_PICTURE, static_cast<float>(options_.quality)) == 0 ||
        WebPPictureImportRGBA(&picture, opaque.rgba.data(), 4 * frame.width_px) == 0) {
      return absl::InternalError("libwebp: no memory for a frame");
    }
    config.method = kEffort;
    if (WebPAnimEncoderAdd(encoder_.get(), &picture, time_ms(count_), &config) == 0) return failed();
    ++count_;
    return absl::OkStatus();
  }

  absl::Status finish() override {
    if (count_ == 0) return absl::FailedPreconditionError("an animation must have a frame");
    WebpData file;
    if (WebPAnimEncoderAdd(encoder_.get(), nullptr, time_ms(count_), nullptr) == 0 ||
        WebPAnimEncoderAssemble(encoder_.get(), &file) == 0) {
      return failed();
    }
    std::ofstream output(path_, std::ios::binary);
    output.write(reinterpret_cast<const char*>(file.bytes), static_cast<std::streamsize>(file.size));
    if (output.flush()) return absl::OkStatus();
    std::error_code ignored;
    fs::remove(path_, ignored);
    return absl::DataLossError(fmt::format("{}: cannot be written", path_.string()));
  }

  std::string encoder() const override { return "libwebp"; }

 private:
  int time_ms(int frame) const { return static_cast<int>(std::lround(1000 * frame / options_.frames_per_second)); }

  absl::Status failed() const {
    return absl::InternalError(fmt::format("libwebp: {}", WebPAnimEncoderGetError(encoder_.get())));
  }

  fs::path path_;
  AnimationOptions options_;
  std::unique_ptr<WebPAnimEncoder, DeleteEncoder> encoder_;
  int count_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<AnimationWriter>> open_webp(const fs::path& path, const AnimationOptions& options) {
  if (absl::Status status = check_animation_options(options); !status.ok()) return status;
  WebPAnimEncoderOptions settings;
  if (WebPAnimEncoderOptionsInit(&settings) == 0) return absl::InternalError("libwebp: another version");
  WebPAnimEncoder* encoder = WebPAnimEncoderNew(options.width_px, options.height_px, &settings);
  if (encoder == nullptr) return absl::InternalError("libwebp: no memory for an animation");
  return std::make_unique<WebpWriter>(path, options, encoder);
}

}  // namespace diaphane::media
