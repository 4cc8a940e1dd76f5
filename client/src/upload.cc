#include "upload.h"

#include <limits>
#include <memory>
#include <utility>

#include "fmt/format.h"
#include "payload.h"

namespace diaphane::internal {
namespace {

// The server counts what it receives; these are what it could not tell from the stream.
absl::Status check_counts(std::span<const Vec3> positions, std::span<const Vec3> normals) {
  if (positions.size() > std::numeric_limits<uint32_t>::max()) {
    return absl::InvalidArgumentError(fmt::format("positions: must be at most 2^32 - 1, got {}", positions.size()));
  }
  if (!normals.empty() && normals.size() != positions.size()) {
    return absl::InvalidArgumentError(
        fmt::format("normals: must be none or one per position ({}), got {}", positions.size(), normals.size()));
  }
  return absl::OkStatus();
}

absl::Status check_attributes(const MeshData& mesh) {
  for (const auto& [field, count] :
       {std::pair("texture_coordinates", mesh.texture_coordinates.size()), std::pair("colors", mesh.colors.size())}) {
    if (count == 0 || count == mesh.positions.size()) continue;
    return absl::InvalidArgumentError(
        fmt::format("{}: must be none or one per position ({}), got {}", field, mesh.positions.size(), count));
  }
  return absl::OkStatus();
}

template <typename Request, typename Response>
absl::StatusOr<Response> stream(const Connection& connection,
                                std::unique_ptr<grpc::ClientWriter<Request>> (SceneStub::*method)(grpc::ClientContext*,
                                                                                                  Response*),
                                const Request& header, const Payload& payload) {
  Response response;
  const absl::Status status = connection.run([&](grpc::ClientContext& context) {
    const auto writer = (connection.scene_service().get()->*method)(&context, &response);
    // A write fails once the server has refused; Finish says why.
    const bool open = writer->Write(header) && payload.for_each_chunk([&](std::string chunk) {
      Request part;
      part.set_chunk(std::move(chunk));
      return writer->Write(part);
    });
    if (open) writer->WritesDone();
    return writer->Finish();
  });
  if (!status.ok()) return status;
  return response;
}

}  // namespace

absl::StatusOr<MeshHandle> upload_mesh(const Connection& connection, const std::string& scene, const MeshData& mesh,
                                       const MeshOptions& options) {
  if (absl::Status status = check_counts(mesh.positions, mesh.normals); !status.ok()) return status;
  if (mesh.triangles.size() % 3 != 0 || mesh.triangles.size() / 3 > std::numeric_limits<uint32_t>::max()) {
    return absl::InvalidArgumentError(
        fmt::format("triangles: must be three indices per triangle, at most 2^32 - 1 triangles, got {} indices",
                    mesh.triangles.size()));
  }
  if (absl::Status status = check_attributes(mesh); !status.ok()) return status;
  Payload payload;
  payload.append(mesh.positions);
  payload.append(mesh.normals);
  payload.append(std::span<const TextureCoordinate>(mesh.texture_coordinates));
  payload.append(std::span<const Rgb>(mesh.colors));
  payload.append(mesh.triangles);
  for (const std::vector<Vec3>& target : mesh.morph_targets) {
    if (target.size() != mesh.positions.size()) {
      return absl::InvalidArgumentError(fmt::format("morph_targets: each must have {} displacements, one has {}",
                                                    mesh.positions.size(), target.size()));
    }
    payload.append(std::span<const Vec3>(target));
  }

  v1::UploadMeshRequest request;
  v1::MeshHeader& header = *request.mutable_header();
  header.set_parent(scene);
  header.mutable_mesh()->set_material(options.material.name);
  header.mutable_mesh()->mutable_scene_from_mesh()->Assign(mesh.scene_from_mesh.begin(), mesh.scene_from_mesh.end());
  header.set_vertex_count(static_cast<uint32_t>(mesh.positions.size()));
  header.set_triangle_count(static_cast<uint32_t>(mesh.triangles.size() / 3));
  header.set_has_normals(!mesh.normals.empty());
  header.set_has_texture_coordinates(!mesh.texture_coordinates.empty());
  header.set_has_colors(!mesh.colors.empty());
  header.set_morph_target_count(static_cast<uint32_t>(mesh.morph_targets.size()));
  header.set_total_bytes(payload.total_bytes());
  header.set_sha256(payload.sha256());
  header.set_request_id(new_request_id());
  const auto response = stream(connection, &SceneStub::UploadMesh, request, payload);
  if (!response.ok()) return response.status();
  return MeshHandle{response->mesh().name()};
}

absl::StatusOr<uint64_t> upload_environment(const Connection& connection, const std::string& scene,
                                            const EnvironmentMap& map, const EnvironmentOptions& options) {
  if (map.radiance.size() != uint64_t{map.width_px} * map.height_px) {
    return absl::InvalidArgumentError(fmt::format("radiance: must be width_px·height_px = {} pixels, got {}",
                                                  uint64_t{map.width_px} * map.height_px, map.radiance.size()));
  }
  Payload payload;
  payload.append(std::span<const Rgb>(map.radiance));

  v1::UploadEnvironmentRequest request;
  v1::EnvironmentHeader& header = *request.mutable_header();
  header.set_parent(scene);
  v1::Environment& environment = *header.mutable_environment();
  environment.set_width_px(map.width_px);
  environment.set_height_px(map.height_px);
  environment.set_rotation_deg(options.rotation_deg);
  environment.set_intensity(options.intensity);
  environment.set_occlusion(options.occlusion);
  header.set_total_bytes(payload.total_bytes());
  header.set_sha256(payload.sha256());
  header.set_request_id(new_request_id());
  const auto response = stream(connection, &SceneStub::UploadEnvironment, request, payload);
  if (!response.ok()) return response.status();
  return response->scene_revision();
}

absl::StatusOr<TextureHandle> upload_texture(const Connection& connection, const std::string& scene,
                                             const TextureData& texture) {
  if (texture.rgba.size() != uint64_t{4} * texture.width_px * texture.height_px) {
    return absl::InvalidArgumentError(fmt::format("rgba: must be 4·width_px·height_px = {} bytes, got {}",
                                                  uint64_t{4} * texture.width_px * texture.height_px,
                                                  texture.rgba.size()));
  }
  Payload payload;
  payload.append(std::span<const uint8_t>(texture.rgba));

  v1::UploadTextureRequest request;
  v1::TextureHeader& header = *request.mutable_header();
  header.set_parent(scene);
  header.mutable_texture()->set_width_px(texture.width_px);
  header.mutable_texture()->set_height_px(texture.height_px);
  header.mutable_texture()->set_srgb(texture.srgb);
  header.mutable_texture()->set_clamp_u(texture.clamp_u);
  header.mutable_texture()->set_clamp_v(texture.clamp_v);
  header.set_total_bytes(payload.total_bytes());
  header.set_sha256(payload.sha256());
  header.set_request_id(new_request_id());
  const auto response = stream(connection, &SceneStub::UploadTexture, request, payload);
  if (!response.ok()) return response.status();
  return TextureHandle{response->texture().name()};
}

absl::StatusOr<uint64_t> upload_positions(const Connection& connection, const MeshHandle& handle,
                                          std::span<const Vec3> positions, std::span<const Vec3> normals) {
  if (absl::Status status = check_counts(positions, normals); !status.ok()) return status;
  Payload payload;
  payload.append(positions);
  payload.append(normals);

  v1::UpdatePositionsRequest request;
  v1::PositionsHeader& header = *request.mutable_header();
  header.set_name(handle.name);
  header.set_vertex_count(static_cast<uint32_t>(positions.size()));
  header.set_has_normals(!normals.empty());
  header.set_total_bytes(payload.total_bytes());
  header.set_sha256(payload.sha256());
  header.set_request_id(new_request_id());
  const auto response = stream(connection, &SceneStub::UpdatePositions, request, payload);
  if (!response.ok()) return response.status();
  return response->scene_revision();
}

}  // namespace diaphane::internal
