#include "service/convert/mesh.h"

#include <cmath>

#include "base/status.h"
#include "fmt/format.h"
#include "glm/geometric.hpp"
#include "glm/mat3x3.hpp"
#include "glm/matrix.hpp"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

constexpr std::string_view kField = "mesh.scene_from_mesh";
constexpr double kSmallestScale = 1e-12;
constexpr double kLargestScale = 1e12;
constexpr double kSmallestSpread = 1e-6;

absl::Status check_invertible(const glm::dmat3& linear) {
  double box = 1;  // volume of a box with edges as long as the columns
  for (int c = 0; c < 3; ++c) {
    const double scale = glm::length(linear[c]);
    if (scale < kSmallestScale || scale > kLargestScale) {
      return base::invalid_field(kField, fmt::format("invertible: column {} of length 1e-12..1e12", c), scale);
    }
    box *= scale;
  }
  // 1 while the axes are perpendicular, 0 when they fall into a plane.
  const double spread = std::abs(glm::determinant(linear)) / box;
  if (spread >= kSmallestSpread) return absl::OkStatus();
  return base::invalid_field(kField, "invertible: |determinant| at least 1e-6 of the product of the columns' lengths",
                             spread);
}

}  // namespace

absl::StatusOr<glm::mat4> matrix_from_proto(const google::protobuf::RepeatedField<float>& scene_from_mesh) {
  glm::mat4 matrix(1);
  if (scene_from_mesh.empty()) return matrix;
  if (scene_from_mesh.size() != 16) return base::invalid_field(kField, "16 numbers, or none", scene_from_mesh.size());
  for (int i = 0; i < 16; ++i) {
    const float value = scene_from_mesh[i];
    const std::string field = fmt::format("{}[{}]", kField, i);
    absl::Status finite = check_range(field, value, -kLargestCoordinate, kLargestCoordinate);
    if (!finite.ok()) return finite;
    const float affine = i == 15 ? 1 : 0;
    if (i % 4 == 3 && value != affine) {
      return base::invalid_field(field, fmt::format("{}, as in every affine matrix", affine), value);
    }
    matrix[i / 4][i % 4] = value;
  }
  if (absl::Status invertible = check_invertible(glm::dmat3(matrix)); !invertible.ok()) return invertible;
  return matrix;
}

absl::StatusOr<scene::MeshPatch> from_proto(const v1::Mesh& message, const google::protobuf::FieldMask& mask) {
  absl::Status known = check_mask(mask, {"material", "scene_from_mesh"});
  if (!known.ok()) return known;
  scene::MeshPatch patch;
  if (names(mask, "material")) patch.material = message.material();
  if (names(mask, "scene_from_mesh")) {
    const absl::StatusOr<glm::mat4> matrix = matrix_from_proto(message.scene_from_mesh());
    if (!matrix.ok()) return matrix.status();
    patch.scene_from_mesh = *matrix;
  }
  return patch;
}

void to_proto(const scene::Mesh& mesh, v1::Mesh& message) {
  message.set_name(mesh.name);
  message.set_material(mesh.material);
  for (int i = 0; i < 16; ++i) message.add_scene_from_mesh(mesh.scene_from_mesh[i / 4][i % 4]);
  message.set_vertex_count(mesh.topology->vertex_count);
  message.set_triangle_count(static_cast<uint32_t>(mesh.topology->triangles.size()));
  message.set_has_normals(!mesh.shape->normals.empty());
  message.set_positions_revision(mesh.positions_revision);
  if (mesh.morph_targets != nullptr) message.set_morph_target_count(static_cast<uint32_t>(mesh.morph_targets->count));
  if (mesh.attributes == nullptr) return;
  message.set_has_texture_coordinates(!mesh.attributes->texture_coordinates.empty());
  message.set_has_colors(!mesh.attributes->colors.empty());
}

void to_proto(const scene::Changed<scene::Mesh>& changed, v1::MeshResponse& message) {
  to_proto(changed.value, *message.mutable_mesh());
  message.set_scene_revision(changed.scene_revision);
}

}  // namespace diaphane::service
