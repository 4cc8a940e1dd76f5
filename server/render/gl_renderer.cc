#include "render/gl_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "base/log.h"
#include "fmt/format.h"
#include "gl/context.h"
#include "render/gpu_mesh.h"
#include "render/lights.h"
#include "render/projection.h"
#include "render/shading.h"
#include "render/view_targets.h"

namespace diaphane::render {
namespace {

// Larger pictures are drawn tile by tile, so that targets stay small whatever is asked for.
constexpr uint32_t kTile_px = 2048;
// Atlases beyond this are the least recently used meshes' to lose.
constexpr size_t kMaxAtlasBytes = size_t{1} << 30;

const optics::Coefficients& material_of(const scene::SceneSnapshot& scene, const scene::Mesh& mesh) {
  static const optics::Coefficients kFallback;
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [&](const scene::Material& m) { return m.name == mesh.material; });
  return found == scene.materials.end() ? kFallback : found->coefficients;
}

geometry::Bounds enclose(const geometry::Bounds& a, const geometry::Bounds& b) {
  return {glm::min(a.lowest, b.lowest), glm::max(a.highest, b.highest)};
}

/// Copies a tile, rows bottom to top, into a picture with rows top to bottom.
void place_tile(const uint8_t* tile, uint32_t tile_width, uint32_t tile_height, uint8_t* picture, uint32_t width,
                uint32_t height, uint32_t x, uint32_t y, size_t bytes_per_pixel) {
  for (uint32_t row = 0; row < tile_height; ++row) {
    const size_t to = (size_t{height - 1 - y - row} * width + x) * bytes_per_pixel;
    std::memcpy(picture + to, tile + size_t{row} * tile_width * bytes_per_pixel, tile_width * bytes_per_pixel);
  }
}

/// Thread: the one that made it, as FrameRenderer asks.
class GlRenderer final : public FrameRenderer {
 public:
  GlRenderer(std::unique_ptr<gl::Context> context, Shading shading)
      : context_(std::move(context)), shading_(std::move(shading)) {}

  absl::StatusOr<Frame> render(const FrameRequest& request, const std::atomic<bool>& cancelled) override;

  RendererInfo info() const override {
    const gl::ContextInfo& info = context_->info();
    return {info.renderer, info.vendor, info.version, info.software, info.reason};
  }

 private:
  struct Drawn {
    const scene::Mesh* mesh;
    GpuMesh* gpu;
    optics::Coefficients material;
  };

  void forget_orphans();
  void bound_atlases(const std::vector<Drawn>& in_use);
  void update_atlas(const Drawn& drawn, const std::vector<LightStorage>& lights, uint32_t face_size_px,
                    StageClock& clock);
  absl::Status draw_tiles(const FrameRequest& request, const std::vector<Drawn>& meshes, const ViewUniforms& view,
                          const std::atomic<bool>& cancelled, StageClock& clock, uint8_t* picture);

  std::unique_ptr<gl::Context> context_;  // first in, last out: everything below frees GL objects
  Shading shading_;
  std::map<std::string, GpuMesh> meshes_;
  std::optional<ViewTargets> targets_;
};

void GlRenderer::forget_orphans() {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.orphaned(); });
}

void GlRenderer::bound_atlases(const std::vector<Drawn>& in_use) {
  size_t bytes = 0;
  for (const auto& [name, mesh] : meshes_) bytes += mesh.atlas.has_value() ? mesh.atlas->bytes() : 0;
  for (auto& [name, mesh] : meshes_) {
    if (bytes <= kMaxAtlasBytes) return;
    const bool busy = std::any_of(in_use.begin(), in_use.end(), [&](const Drawn& d) { return d.gpu == &mesh; });
    if (busy || !mesh.atlas.has_value()) continue;
    bytes -= mesh.atlas->bytes();
    mesh.atlas.reset();
  }
}

void GlRenderer::update_atlas(const Drawn& drawn, const std::vector<LightStorage>& lights, uint32_t face_size_px,
                              StageClock& clock) {
  AtlasKey key{drawn.gpu->generation(), lights, drawn.material.refractive_index, face_size_px};
  if (drawn.gpu->atlas.has_value() && drawn.gpu->atlas->key() == key) {
    clock.sleep("atlas");
    return;
  }
  clock.run("atlas", [&] {
    const BoxUniforms box = fit_box(drawn.gpu->bounds_mm(), face_size_px);
    drawn.gpu->atlas.emplace(std::move(key), box);
    shading_.bind(box);
    shading_.bind(material_uniforms(drawn.material));
    drawn.gpu->atlas->render(shading_.atlas(), [&] { drawn.gpu->draw(); });
    glFinish();
  });
}

absl::Status GlRenderer::draw_tiles(const FrameRequest& request, const std::vector<Drawn>& meshes,
                                    const ViewUniforms& view, const std::atomic<bool>& cancelled, StageClock& clock,
                                    uint8_t* picture) {
  const uint32_t width = request.width_px;
  const uint32_t height = request.height_px;
  const uint32_t target_width = std::min(width, kTile_px);
  const uint32_t target_height = std::min(height, kTile_px);
  if (!targets_.has_value() || !targets_->fits(target_width, target_height, request.format)) {
    targets_.reset();
    targets_.emplace(target_width, target_height, request.format);
  }
  const size_t bytes_per_pixel = request.format == PixelFormat::kSrgb8 ? 4 : 4 * sizeof(float);
  std::vector<uint8_t> tile(size_t{target_width} * target_height * bytes_per_pixel);
  for (uint32_t y = 0; y < height; y += kTile_px) {
    for (uint32_t x = 0; x < width; x += kTile_px) {
      if (cancelled.load()) return absl::CancelledError("the frame was cancelled while it was drawn");
      glViewport(-static_cast<GLint>(x), -static_cast<GLint>(y), static_cast<GLsizei>(width),
                 static_cast<GLsizei>(height));
      const auto bind_view = [&](size_t index) {
        ViewUniforms of_mesh = view;
        of_mesh.mesh_id = static_cast<float>(index + 1);
        of_mesh.flipped = meshes[index].gpu->flipped() ? 1.0f : 0.0f;
        shading_.bind(of_mesh);
      };
      clock.run("gbuffer", [&] {
        targets_->begin_gbuffer();
        glUseProgram(shading_.gbuffer().id());
        for (size_t i = 0; i < meshes.size(); ++i) {
          bind_view(i);
          meshes[i].gpu->draw();
        }
        glFinish();
      });
      clock.run("shade", [&] {
        targets_->begin_shading();
        glViewport(0, 0, static_cast<GLsizei>(target_width), static_cast<GLsizei>(target_height));
        for (size_t i = 0; i < meshes.size(); ++i) {
          bind_view(i);
          shading_.bind(material_uniforms(meshes[i].material));
          if (request.settings.technique == Technique::kPaper) {
            shading_.shade_paper(*meshes[i].gpu->atlas, request.settings.paper);
          } else {
            shading_.shade_lambert();
          }
        }
        glFinish();
      });
      clock.run("read_back", [&] {
        const uint32_t tile_width = std::min(kTile_px, width - x);
        const uint32_t tile_height = std::min(kTile_px, height - y);
        targets_->read_back(tile_width, tile_height, tile.data());
        place_tile(tile.data(), tile_width, tile_height, picture, width, height, x, y, bytes_per_pixel);
      });
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<Frame> GlRenderer::render(const FrameRequest& request, const std::atomic<bool>& cancelled) {
  const scene::SceneSnapshot& scene = *request.scene;
  forget_orphans();
  if (scene.meshes.empty()) return absl::FailedPreconditionError(fmt::format("{}: has no mesh to draw", scene.name));

  StageClock clock;
  std::vector<Drawn> meshes;
  for (const auto& mesh : scene.meshes) {
    GpuMesh& gpu = meshes_[mesh->name];
    gpu.update(*mesh, scene.millimetres_per_unit, clock);
    meshes.push_back({mesh.get(), &gpu, material_of(scene, *mesh)});
  }
  geometry::Bounds bounds = meshes.front().gpu->bounds_mm();
  for (const Drawn& drawn : meshes) bounds = enclose(bounds, drawn.gpu->bounds_mm());
  const std::vector<LightStorage> lights = lights_of(scene, bounds);
  shading_.bind(lights);
  if (request.settings.technique == Technique::kPaper) {
    for (const Drawn& drawn : meshes) {
      if (cancelled.load()) return absl::CancelledError("the frame was cancelled while it was drawn");
      update_atlas(drawn, lights, request.settings.paper.face_size_px, clock);
    }
    bound_atlases(meshes);
  }

  ViewUniforms view;
  const float aspect = static_cast<float>(request.width_px) / static_cast<float>(request.height_px);
  view.clip_from_world = clip_from_world(request.camera, scene.millimetres_per_unit, aspect, bounds);
  view.eye_mm = glm::vec4(request.camera.eye * static_cast<float>(scene.millimetres_per_unit), 1);
  view.radiance_scale = request.format == PixelFormat::kSrgb8 ? std::exp2(request.settings.exposure_ev) : 1.0f;

  Frame frame;
  frame.scene_revision = scene.revision;
  const size_t pixels = size_t{request.width_px} * request.height_px;
  uint8_t* picture = nullptr;
  if (request.format == PixelFormat::kSrgb8) {
    auto& image = frame.image.emplace<base::Image8>(
        base::Image8{request.width_px, request.height_px, std::vector<uint8_t>(4 * pixels)});
    picture = image.rgba.data();
  } else {
    auto& image = frame.image.emplace<base::ImageF>(
        base::ImageF{request.width_px, request.height_px, {"R", "G", "B", "A"}, std::vector<float>(4 * pixels)});
    picture = reinterpret_cast<uint8_t*>(image.values.data());
  }
  if (absl::Status drawn = draw_tiles(request, meshes, view, cancelled, clock, picture); !drawn.ok()) return drawn;
  if (absl::Status errors = context_->take_errors(); !errors.ok()) return errors;
  frame.stages = clock.take();
  frame.path = fmt::format(
      "{}, {}",
      request.settings.technique == Technique::kPaper ? "paper: six draws, full-screen taps" : "lambert: full-screen",
      context_->info().software ? "software" : "gpu");
  return frame;
}

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

}  // namespace

absl::StatusOr<std::unique_ptr<FrameRenderer>> make_gl_renderer(const GlRendererOptions& options) {
  absl::StatusOr<std::unique_ptr<gl::Context>> context = gl::Context::create({options.device});
  if (!context.ok()) return context.status();
  const gl::ContextInfo& info = (*context)->info();
  spdlog::log(info.software ? spdlog::level::warn : spdlog::level::info, "renderer=\"{}\" version=\"{}\" {}: {}",
              info.renderer, info.version, info.software ? "SOFTWARE RENDERING" : "GPU", info.reason);
  absl::StatusOr<Shading> shading = Shading::load(gl::ShaderLibrary(options.shader_dir));
  if (!shading.ok()) return shading.status();
  auto renderer = std::make_unique<GlRenderer>(*std::move(context), *std::move(shading));
  if (options.warm_all) {
    FrameRequest request = warm_up_request();
    for (const Technique technique : {Technique::kPaper, Technique::kLambert}) {
      request.settings.technique = technique;
      for (const PixelFormat format : {PixelFormat::kSrgb8, PixelFormat::kLinearFloat}) {
        request.format = format;
        if (auto frame = renderer->render(request, std::atomic<bool>(false)); !frame.ok()) return frame.status();
      }
    }
  }
  return std::unique_ptr<FrameRenderer>(std::move(renderer));
}

}  // namespace diaphane::render
