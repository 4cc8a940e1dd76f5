#include "gallery/studio.h"

namespace diaphane::gallery {
namespace {

absl::Status hang(const Scene& scene, const std::optional<TextureData>& picture, std::optional<TextureHandle>* handle) {
  if (!picture) return absl::OkStatus();
  const absl::StatusOr<TextureHandle> added = scene.add_texture(*picture);
  if (added.ok()) *handle = *added;
  return added.status();
}

absl::StatusOr<MeshHandle> add_body(const Scene& scene, const Body& body) {
  Material dressed = body.material;
  absl::Status hung = hang(scene, body.pictures.albedo, &dressed.textures.albedo);
  if (hung.ok()) hung = hang(scene, body.pictures.normal, &dressed.textures.normal);
  if (hung.ok()) hung = hang(scene, body.pictures.roughness, &dressed.textures.roughness);
  if (!hung.ok()) return hung;
  const absl::StatusOr<MaterialHandle> material = scene.add_material(dressed);
  if (!material.ok()) return material.status();
  return scene.add_mesh(body.mesh, {.material = *material});
}

// The handle of the first body.
absl::StatusOr<MeshHandle> furnish(const Scene& scene, const Still& still) {
  for (const Light& light : still.lights) {
    if (const auto handle = scene.add_light(light); !handle.ok()) return handle.status();
  }
  if (still.environment) {
    if (const auto revision = scene.set_environment(*still.environment); !revision.ok()) return revision.status();
  }
  absl::StatusOr<MeshHandle> first = absl::InvalidArgumentError("still: must have a body, got none");
  for (const Body& body : still.bodies) {
    absl::StatusOr<MeshHandle> handle = add_body(scene, body);
    if (!handle.ok()) return handle;
    if (!first.ok()) first = std::move(handle);
  }
  return first;
}

absl::Status shoot_pose(const Scene& scene, const Still& still, std::span<const RenderSettings> settings,
                        std::vector<LinearFrame>* frames) {
  for (const RenderSettings& one : settings) {
    const absl::StatusOr<RenderedFrame> rendered = scene.render({.camera = still.camera,
                                                                 .size = still.size,
                                                                 .settings = one,
                                                                 .format = ImageFormat::kExr,
                                                                 .channels = {Channel::kPosition}});
    if (!rendered.ok()) return rendered.status();
    absl::StatusOr<LinearFrame> frame = decode_exr(rendered->image);
    if (!frame.ok()) return frame.status();
    frames->push_back(*std::move(frame));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<LinearFrame>> shoot_in(const Scene& scene, const Still& still,
                                                  std::span<const RenderSettings> settings) {
  const absl::StatusOr<MeshHandle> body = furnish(scene, still);
  if (!body.ok()) return body.status();
  std::vector<LinearFrame> frames;
  if (still.poses.empty()) {
    if (absl::Status status = shoot_pose(scene, still, settings, &frames); !status.ok()) return status;
  }
  for (const std::vector<Vec3>& pose : still.poses) {
    if (const auto revision = scene.update_positions(*body, pose); !revision.ok()) return revision.status();
    if (absl::Status status = shoot_pose(scene, still, settings, &frames); !status.ok()) return status;
  }
  return frames;
}

}  // namespace

absl::StatusOr<Studio> Studio::open(const std::string& address) {
  std::optional<PrivateServer> server;
  if (address.empty()) {
    absl::StatusOr<PrivateServer> started = PrivateServer::start();
    if (!started.ok()) return started.status();
    server = *std::move(started);
  }
  absl::StatusOr<Client> client = Client::connect(server ? server->address() : address);
  if (!client.ok()) return client.status();
  return Studio(std::move(server), *std::move(client));
}

absl::StatusOr<std::vector<LinearFrame>> Studio::shoot(const Still& still,
                                                       std::span<const RenderSettings> settings) const {
  const absl::StatusOr<Scene> scene =
      client_.create_scene({.display_name = "gallery", .millimetres_per_unit = still.millimetres_per_unit});
  if (!scene.ok()) return scene.status();
  absl::StatusOr<std::vector<LinearFrame>> frames = shoot_in(*scene, still, settings);
  const absl::Status removed = scene->remove();
  if (frames.ok() && !removed.ok()) return removed;
  return frames;
}

}  // namespace diaphane::gallery
