// Any bytes as any request: what the service makes of it is a refusal in one line, or values in their ranges.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/status.h"
#include "diaphane/v1/render_service.pb.h"
#include "diaphane/v1/scene_service.pb.h"
#include "fmt/format.h"
#include "geometry/topology.h"
#include "glm/matrix.hpp"
#include "service/convert/edit.h"
#include "service/convert/frame.h"
#include "service/convert/light.h"
#include "service/convert/material.h"
#include "service/convert/mesh.h"
#include "service/convert/scene.h"
#include "service/convert/status.h"
#include "service/convert/upload.h"
#include "service/convert/vertex_positions.h"
#include "tests/fuzz/promises.h"

namespace diaphane::fuzz {
namespace {

constexpr uint64_t kMostPixels = 1 << 24;
constexpr uint64_t kMostPayloadBytes = 1 << 16;

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_refusal(const absl::Status& status) {
  require(status.code() == absl::StatusCode::kInvalidArgument, "a refusal that blames the argument");
  require(!base::field_violation(status).field.empty(), "a refusal that names the field");
  const grpc::Status sent = service::to_grpc(status);
  require(sent.error_code() == grpc::StatusCode::INVALID_ARGUMENT, "the same code on the wire");
  require(!sent.error_details().empty(), "details on the wire");
}

// Whether there is a value to look at.
template <typename T>
bool is_accepted(const absl::StatusOr<T>& value) {
  if (!value.ok()) check_refusal(value.status());
  return value.ok();
}

bool is_accepted(const absl::Status& status) {
  if (!status.ok()) check_refusal(status);
  return status.ok();
}

void convert(const v1::RenderFrameRequest& request, std::string_view) {
  const auto task = service::from_proto(request, kMostPixels);
  if (!is_accepted(task)) return;
  const scene::Camera& camera = task->request.camera;
  require(is_finite(camera.eye) && is_finite(camera.target) && is_finite(camera.up), "a finite camera");
  require(camera.fov_y_deg >= 1 && camera.fov_y_deg <= 170, "a view of 1..170 degrees");
  require(uint64_t{task->request.width_px} * task->request.height_px <= kMostPixels, "at most the most pixels");
  require(task->request.width_px > 0 && task->request.height_px > 0, "a pixel");
  require(task->request.channels.size() <= 5, "each channel once");
}

void check_light(const scene::LightKind& kind) {
  if (const auto* point = std::get_if<scene::PointLight>(&kind)) {
    require(is_finite(point->position) && is_finite(point->intensity_w_sr), "a finite light");
  } else if (const auto* directional = std::get_if<scene::DirectionalLight>(&kind)) {
    require(std::abs(glm::length(directional->direction) - 1) < 1e-3f, "a unit direction");
  } else {
    const auto& spot = std::get<scene::SpotLight>(kind);
    require(spot.inner_angle_deg >= 0 && spot.inner_angle_deg <= spot.outer_angle_deg, "a cone within a cone");
    require(spot.outer_angle_deg <= 90, "a cone of at most a half space");
  }
}

void convert(const v1::CreateLightRequest& request, std::string_view) {
  if (const auto light = service::from_proto(request.light()); is_accepted(light)) check_light(*light);
}

void convert(const v1::UpdateLightRequest& request, std::string_view) {
  const auto patch = service::from_proto(request.light(), request.update_mask());
  if (!is_accepted(patch)) return;
  require(patch->kind || patch->position || patch->intensity_w_sr, "a patch of something");
  if (patch->kind) check_light(*patch->kind);
}

void convert(const v1::CreateMaterialRequest& request, std::string_view) {
  const auto material = service::from_proto(request.material());
  if (!is_accepted(material)) return;
  const optics::Coefficients c = optics::resolve(material->form, material->profile).coefficients;
  require(is_finite(c.absorption_mm) && is_finite(c.reduced_scattering_mm), "finite coefficients");
  require(c.refractive_index >= 1 && c.refractive_index <= 3, "an index of 1..3");
}

void convert(const v1::UpdateMaterialRequest& request, std::string_view) { is_accepted(service::from_proto(request)); }

void convert(const v1::CreateSceneRequest& request, std::string_view) {
  const auto patch = service::from_proto(request.scene());
  if (is_accepted(patch)) require(*patch->millimetres_per_unit > 0, "a unit of some length");
}

void convert(const v1::UpdateSceneRequest& request, std::string_view) {
  is_accepted(service::from_proto(request.scene(), request.update_mask()));
}

void convert(const v1::UpdateMeshRequest& request, std::string_view) {
  const auto patch = service::from_proto(request.mesh(), request.update_mask());
  if (is_accepted(patch) && patch->scene_from_mesh) {
    require(std::isfinite(glm::determinant(glm::dmat4(*patch->scene_from_mesh))), "a finite transform");
  }
}

// A payload as the header promises, made of what is there.
void take_payload(const service::PayloadSpec& spec, std::string_view bytes) {
  if (spec.total_bytes > kMostPayloadBytes) return;
  std::string payload(bytes.substr(0, spec.total_bytes));
  payload.resize(spec.total_bytes, '\0');
  auto arrays = service::read_arrays(spec, payload);
  if (!is_accepted(arrays)) return;
  require(arrays->positions.size() == spec.counts.vertex_count, "all positions");
  if (spec.counts.triangle_count == 0) return;  // positions alone
  const auto topology = geometry::build_topology(arrays->positions, std::move(arrays->triangles));
  if (!topology.ok()) return check_refusal(topology.status());
}

void convert(const v1::UploadMeshRequest& request, std::string_view bytes) {
  const auto spec = service::from_proto(request.header());
  is_accepted(service::matrix_from_proto(request.header().mesh().scene_from_mesh()));
  if (is_accepted(spec)) take_payload(*spec, bytes);
}

void convert(const v1::UpdatePositionsRequest& request, std::string_view bytes) {
  const auto spec = service::from_proto(request.header());
  if (is_accepted(spec)) take_payload(*spec, bytes);
}

void check_positions(const scene::PositionsPatch& patch) {
  require(!patch.positions.empty(), "a position");
  require(patch.indices.empty() || patch.indices.size() == patch.positions.size(), "a position an index");
  for (const glm::vec3& position : patch.positions) require(is_finite(position), "finite positions");
}

constexpr uint64_t kMostDecodedBytes = uint64_t{64} << 20;  // as the store's memory bounds a server

/// Feeds what is to come, in pieces of what there is; false where it is refused, or there is too little.
template <typename Reader>
bool feed(Reader& reader, std::string_view bytes) {
  size_t piece = 12;
  while (reader.bytes_to_come() > 0) {
    piece = std::min<uint64_t>({piece, bytes.size(), reader.bytes_to_come()});
    if (!is_accepted(reader.add(bytes.substr(0, piece)))) return false;
    bytes.remove_prefix(piece);
    piece = 2 * piece + 12;
  }
  return true;
}

/// Of the same bytes, where they hold what is named.
absl::StatusOr<std::string_view> shared_bytes(std::string_view bytes, const v1::SharedBytes& named) {
  if (named.offset() > bytes.size() || named.bytes() > bytes.size() - named.offset()) {
    return base::invalid_field("shared.bytes", fmt::format("within {} bytes", bytes.size()), "others");
  }
  return bytes.substr(named.offset(), named.bytes());
}

void convert(const v1::VertexPositions& request, std::string_view bytes) {
  if (service::decoded_bytes(request) > kMostDecodedBytes) return;
  const auto find_shared = [&](const v1::SharedBytes& named) { return shared_bytes(bytes, named); };
  auto reader = service::PositionsReader::begin(request, find_shared);
  if (!is_accepted(reader) || !feed(*reader, bytes)) return;
  const scene::PositionsPatch patch = reader->finish();
  check_positions(patch);
  if (request.meshopt_count() == 0 && request.payload_bytes() == 0 && !request.has_shared()) return;
  require(patch.positions.size() * sizeof(glm::vec3) <= service::decoded_bytes(request), "the memory that was told");
}

void convert(const v1::SceneEdit& request, std::string_view bytes) {
  if (service::decoded_bytes(request) > kMostDecodedBytes) return;
  const auto find_shared = [&](const v1::SharedBytes& named) { return shared_bytes(bytes, named); };
  auto reader = service::EditReader::begin(request, find_shared);
  if (!is_accepted(reader) || !feed(*reader, bytes)) return;
  const std::vector<scene::SceneChange> made = reader->finish();
  require(!made.empty() && made.size() == static_cast<size_t>(request.changes_size()), "every change");
  for (const scene::SceneChange& change : made) {
    if (const auto* positions = std::get_if<scene::PositionsPatch>(&change.patch)) check_positions(*positions);
    if (const auto* sphere = std::get_if<scene::SpherePatch>(&change.patch)) {
      require(sphere->amount >= 0 && sphere->amount <= 1, "an amount of 0..1");
    }
    if (const auto* weights = std::get_if<scene::WeightsPatch>(&change.patch)) {
      for (const float weight : weights->weights) require(std::abs(weight) <= 1e6f, "weights within ±1e6");
    }
  }
}

template <typename Request>
void parse(std::string_view message, std::string_view bytes) {
  Request request;
  if (request.ParseFromArray(message.data(), static_cast<int>(message.size()))) convert(request, bytes);
}

using Parse = void (*)(std::string_view message, std::string_view bytes);

// The order is that of the seeds' first byte.
constexpr Parse kRequests[] = {
    parse<v1::RenderFrameRequest>,     parse<v1::CreateLightRequest>,    parse<v1::UpdateLightRequest>,
    parse<v1::CreateMaterialRequest>,  parse<v1::UpdateMaterialRequest>, parse<v1::CreateSceneRequest>,
    parse<v1::UpdateSceneRequest>,     parse<v1::UpdateMeshRequest>,     parse<v1::UploadMeshRequest>,
    parse<v1::UpdatePositionsRequest>, parse<v1::VertexPositions>,       parse<v1::SceneEdit>};

}  // namespace
}  // namespace diaphane::fuzz

// Which request, how many bytes of message (two bytes, little-endian), the message, and what is left is its payload.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  if (size < 3) return 0;
  const size_t length = data[1] + size_t{256} * data[2];
  const std::string_view rest = input.substr(3);
  diaphane::fuzz::kRequests[data[0] % std::size(diaphane::fuzz::kRequests)](rest.substr(0, length),
                                                                            rest.substr(std::min(length, rest.size())));
  return 0;
}
