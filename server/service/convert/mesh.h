#pragma once

#include "absl/status/statusor.h"
#include "diaphane/v1/mesh.pb.h"
#include "diaphane/v1/scene_service.pb.h"
#include "google/protobuf/field_mask.pb.h"
#include "google/protobuf/repeated_field.h"
#include "scene/scene_store.h"

namespace diaphane::service {

/// mesh.scene_from_mesh: 16 finite numbers of an affine, invertible matrix, or none for the identity.
absl::StatusOr<glm::mat4> matrix_from_proto(const google::protobuf::RepeatedField<float>& scene_from_mesh);

/// The values of `message` that `mask` names: material, scene_from_mesh.
absl::StatusOr<scene::MeshPatch> from_proto(const v1::Mesh& message, const google::protobuf::FieldMask& mask);

void to_proto(const scene::Mesh& mesh, v1::Mesh& message);
void to_proto(const scene::Changed<scene::Mesh>& changed, v1::MeshResponse& message);

}  // namespace diaphane::service
