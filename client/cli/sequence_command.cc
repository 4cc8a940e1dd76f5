#include "sequence_command.h"

#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "diaphane/texture.h"
#include "fmt/format.h"
#include "frame_folder.h"
#include "json.h"
#include "media/animation.h"
#include "moving_plan.h"
#include "output_file.h"
#include "progress.h"
#include "scene_upload.h"
#include "status.h"

namespace diaphane::cli {
namespace {

namespace fs = std::filesystem;

/// Changes whenever the meshes do: FNV-1a over their bytes.
uint64_t fingerprint(const std::vector<MeshData>& meshes) {
  uint64_t hash = 14695981039346656037u;
  const auto add = [&](const auto& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (size_t i = 0; i < values.size() * sizeof(values[0]); ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
  };
  for (const MeshData& mesh : meshes) {
    add(mesh.positions);
    add(mesh.triangles);
    add(mesh.scene_from_mesh);
  }
  return hash;
}

std::string_view extension_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::kExr:
      return ".exr";
    case ImageFormat::kJpeg:
      return ".jpg";
    case ImageFormat::kWebp:
      return ".webp";
    default:
      return ".png";
  }
}

std::string job_text(const SequenceArguments& arguments, const MovingPlan& moving, const std::string& job) {
  Json json{{"frames", moving.motion->frame_count()},
            {"frames_per_second", arguments.motion.frames_per_second},
            {"meshes", fmt::format("{:016x}", fingerprint(moving.plan.meshes))},
            {"options", Json::array()}};
  for (size_t at = 0; at < job.size();) {
    const size_t end = job.find('\n', at);
    json["options"].push_back(job.substr(at, end - at));
    at = end + 1;
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Frames on a server, one after the other.
class FrameMaker {
 public:
  FrameMaker(const MovingPlan& moving, const Scene& scene, std::vector<MeshHandle> meshes)
      : moving_(moving), scene_(scene), meshes_(std::move(meshes)), first_camera_(moving.plan.options.camera) {}

  absl::StatusOr<RenderedFrame> make(uint32_t frame) {
    const absl::StatusOr<std::vector<MeshPose>> poses = moving_.motion->poses(frame);
    if (!poses.ok()) return with_exit_code(poses.status(), kExitFile);
    for (size_t i = 0; i < poses->size(); ++i) {
      const auto revision = scene_.update_positions(meshes_[i], (*poses)[i].positions, (*poses)[i].normals);
      if (!revision.ok()) return revision.status();
    }
    RenderOptions options = moving_.plan.options;
    options.camera = moving_.motion->camera(frame, first_camera_);
    return scene_.render(options);
  }

 private:
  const MovingPlan& moving_;
  const Scene& scene_;
  const std::vector<MeshHandle> meshes_;
  const Camera first_camera_;
};

struct Made {
  uint32_t total = 0, rendered = 0, found = 0;
  double seconds = 0;
};

absl::Status make_frames(const GlobalOptions& global, const SequenceArguments& arguments, MovingPlan* moving,
                         const FrameFolder& folder, Progress& progress, Made* made) {
  std::vector<uint32_t> missing;
  for (uint32_t frame = 0; frame < moving->motion->frame_count(); ++frame) {
    if (arguments.shard && !arguments.shard->has(frame)) continue;
    ++made->total;
    if (!folder.has(frame)) missing.push_back(frame);
  }
  made->found = made->total - static_cast<uint32_t>(missing.size());
  if (missing.empty()) return absl::OkStatus();
  absl::StatusOr<UploadedScene> uploaded = upload_plan(global, &moving->plan, progress);
  if (!uploaded.ok()) return uploaded.status();
  FrameMaker maker(*moving, uploaded->scene.scene(), std::move(uploaded->meshes));
  const auto begin = std::chrono::steady_clock::now();
  for (const uint32_t frame : missing) {
    progress.bar(fmt::format("frame {} of {}", made->found + made->rendered + 1, made->total),
                 static_cast<double>(made->found + made->rendered) / made->total);
    const absl::StatusOr<RenderedFrame> rendered = maker.make(frame);
    if (!rendered.ok()) return rendered.status();
    if (absl::Status written = folder.write(frame, rendered->image); !written.ok()) return written;
    ++made->rendered;
  }
  made->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return uploaded->scene.remove();
}

absl::Status write_movie(const SequenceArguments& arguments, const MovingPlan& moving, const FrameFolder& folder,
                         Progress& progress) {
  const fs::path path = arguments.output;
  const media::AnimationOptions options{.width_px = static_cast<int>(moving.plan.options.size.width_px),
                                        .height_px = static_cast<int>(moving.plan.options.size.height_px),
                                        .frames_per_second = arguments.motion.frames_per_second};
  const bool webp = path.extension() == ".webp" || path.extension() == ".WEBP";
  auto movie = webp ? media::open_webp(path, options) : media::open_mp4(path, options);
  if (!movie.ok()) return with_exit_code(movie.status(), kExitFile);
  const uint32_t frames = moving.motion->frame_count();
  for (uint32_t frame = 0; frame < frames; ++frame) {
    progress.bar(fmt::format("encoding {}", path.filename().string()), static_cast<double>(frame) / frames);
    absl::StatusOr<TextureData> picture = read_texture_file(folder.path_of(frame), true);
    absl::Status status = picture.status();
    if (status.ok()) {
      status = (*movie)->add({options.width_px, options.height_px, std::move(picture->rgba)});
    }
    if (!status.ok()) return with_exit_code(status, kExitFile);
  }
  if (absl::Status finished = (*movie)->finish(); !finished.ok()) return with_exit_code(finished, kExitFile);
  folder.remove(frames);
  return absl::OkStatus();
}

absl::Status check(const SequenceArguments& arguments) {
  if (arguments.render.channels && arguments.picture_format != ImageFormat::kExr) {
    return usage_error("--aov", "only --format exr has extra channels");
  }
  if (!arguments.is_movie) return absl::OkStatus();
  if (arguments.shard) return usage_error("--shard", fmt::format("needs a folder, got '{}'", arguments.output));
  if (arguments.picture_format) {
    return usage_error("--format", fmt::format("is of pictures in a folder, got '{}'", arguments.output));
  }
  return check_writable(arguments.output);
}

void report(const GlobalOptions& global, const SequenceArguments& arguments, const Made& made) {
  if (!global.json) {
    fmt::print("{}\n", arguments.output);
    return;
  }
  Json json{{"output", arguments.output},
            {"frames", made.total},
            {"rendered", made.rendered},
            {"found", made.found},
            {"seconds", made.seconds}};
  print_json(json);
}

}  // namespace

absl::Status run_sequence(const GlobalOptions& global, const SequenceArguments& arguments, const std::string& job) {
  if (absl::Status status = check(arguments); !status.ok()) return status;
  Progress progress;
  progress.step("reading");
  absl::StatusOr<MovingPlan> moving = plan_motion(arguments.render, arguments.motion);
  progress.clear();
  if (!moving.ok()) return moving.status();
  for (const std::string& note : moving->plan.notes) print_note(note);
  moving->plan.options.format = arguments.picture_format.value_or(ImageFormat::kPng);

  const fs::path place = arguments.is_movie ? fs::path(arguments.output + ".frames") : fs::path(arguments.output);
  const absl::StatusOr<FrameFolder> folder =
      FrameFolder::open(place, extension_of(moving->plan.options.format), job_text(arguments, *moving, job));
  if (!folder.ok()) return folder.status();
  Made made;
  absl::Status status = make_frames(global, arguments, &*moving, *folder, progress, &made);
  if (status.ok() && arguments.is_movie) status = write_movie(arguments, *moving, *folder, progress);
  progress.clear();
  if (!status.ok()) return status;
  report(global, arguments, made);
  return absl::OkStatus();
}

}  // namespace diaphane::cli
