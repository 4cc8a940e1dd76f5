#include "render/gl_renderer.h"

#include <iterator>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "base/log.h"
#include "diffusion/simd_level.h"
#include "fmt/format.h"
#include "gl/context.h"
#include "render/scene_painter.h"

namespace diaphane::render {
namespace {

const char* technique_path(Technique technique, bool native) {
  switch (technique) {
    case Technique::kIntegral:
      return native ? "integral: native tree, native raster" : "integral: native tree, forward";
    case Technique::kPaper:
      return native ? "paper: native cube, native taps" : "paper: six draws, full-screen taps";
    case Technique::kReference:
      return "reference: native brute force";
    case Technique::kLambert:
      break;
  }
  return "lambert: full-screen";
}

/// Thread: the one that made it, as FrameRenderer asks; recycle() any.
class GlRenderer final : public FrameRenderer {
 public:
  GlRenderer(std::unique_ptr<gl::Context> context, Shading shading, bool native)
      : context_(std::move(context)), painter_(std::move(shading), native) {}

  absl::StatusOr<Frame> render(const FrameRequest& request, const std::atomic<bool>& cancelled) override {
    Frame spare = take_spare();
    std::string path = std::move(spare.path);
    absl::StatusOr<Frame> frame = painter_.paint(request, cancelled, std::move(spare));
    if (absl::Status errors = context_->take_errors(); frame.ok() && !errors.ok()) return errors;
    if (frame.ok()) {
      path.clear();
      fmt::format_to(std::back_inserter(path), "{}; {}; {}",
                     technique_path(request.settings.technique, painter_.was_native()),
                     context_->info().software ? "software" : "gpu", diffusion::simd_level());
      frame->path = std::move(path);
    }
    return frame;
  }

  void recycle(Frame frame) override {
    absl::MutexLock lock(&spares_mutex_);
    if (spares_.size() < kMostSpares) spares_.push_back(std::move(frame));
  }

  RendererInfo info() const override {
    const gl::ContextInfo& info = context_->info();
    return {info.renderer, info.vendor, info.version, info.software, info.reason};
  }

 private:
  static constexpr size_t kMostSpares = 4;

  Frame take_spare() {
    absl::MutexLock lock(&spares_mutex_);
    if (spares_.empty()) return {};
    Frame spare = std::move(spares_.back());
    spares_.pop_back();
    return spare;
  }

  absl::Mutex spares_mutex_;
  std::vector<Frame> spares_ ABSL_GUARDED_BY(spares_mutex_);
  std::unique_ptr<gl::Context> context_;  // first in, last out: the painter frees GL objects
  ScenePainter painter_;
};

/// A tetrahedron: enough to make every program compile.
FrameRequest warm_up_request() {
  const std::vector<glm::vec3> corners = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  auto mesh = std::make_shared<scene::Mesh>();
  mesh->name = "warm-up";
  mesh->topology = *geometry::build_topology(corners, {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}});
  mesh->shape = std::make_shared<geometry::MeshShape>(geometry::MeshShape{corners, {}});
  auto scene = std::make_shared<scene::SceneSnapshot>();
  scene->meshes.push_back(std::move(mesh));
  FrameRequest request;
  request.scene = std::move(scene);
  request.camera.eye = {0, 0, 6};
  request.width_px = request.height_px = 16;
  request.settings.paper.face_size_px = 16;
  return request;
}

/// Draws with every program and variant of one.
absl::Status warm_up(FrameRenderer& renderer) {
  FrameRequest request = warm_up_request();
  for (const Technique technique : {Technique::kIntegral, Technique::kPaper, Technique::kLambert}) {
    request.settings.technique = technique;
    for (const bool shadows : {false, true}) {
      request.settings.shadows = shadows;
      request.channels.clear();
      for (const PixelFormat format : {PixelFormat::kSrgb8, PixelFormat::kLinearFloat, PixelFormat::kLinearFloat}) {
        request.format = format;
        const auto frame = renderer.render(request, std::atomic<bool>(false));
        if (!frame.ok()) return frame.status();
        if (format == PixelFormat::kLinearFloat) request.channels = {Channel::kIrradiance};
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<FrameRenderer>> make_gl_renderer(const GlRendererOptions& options) {
  absl::StatusOr<std::unique_ptr<gl::Context>> context = gl::Context::create({options.device});
  if (!context.ok()) return context.status();
  const gl::ContextInfo& info = (*context)->info();
  const bool native = options.raster == Raster::kAuto ? info.software : options.raster == Raster::kNative;
  spdlog::log(info.software ? spdlog::level::warn : spdlog::level::info, "renderer=\"{}\" version=\"{}\" {}: {}",
              info.renderer, info.version, info.software ? "SOFTWARE RENDERING" : "GPU", info.reason);
  absl::StatusOr<Shading> shading = Shading::load(gl::ShaderLibrary(options.shader_dir));
  if (!shading.ok()) return shading.status();
  auto renderer = std::make_unique<GlRenderer>(*std::move(context), *std::move(shading), native);
  if (options.warm_all) {
    if (absl::Status warm = warm_up(*renderer); !warm.ok()) return warm;
  }
  return std::unique_ptr<FrameRenderer>(std::move(renderer));
}

}  // namespace diaphane::render
