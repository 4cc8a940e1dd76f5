#include "readers/gltf_skin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

constexpr int kMostSets = 4;  // of four joints and weights a vertex; real files have one or two

constexpr uint64_t kCostOfJoint = 16;  // in accessor elements: the product of two matrices

std::string set_name(const char* attribute, int set) { return fmt::format("{}_{}", attribute, set); }

Vec3 transform(const std::array<float, 12>& m, const Vec3& p) {
  return {m[0] * p.x + m[3] * p.y + m[6] * p.z + m[9], m[1] * p.x + m[4] * p.y + m[7] * p.z + m[10],
          m[2] * p.x + m[5] * p.y + m[8] * p.z + m[11]};
}

// The matrix of cofactors: the inverse transposed, times the determinant.
std::array<float, 9> cofactors(const std::array<float, 12>& m) {
  return {m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],
          m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7],
          m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]};
}

Vec3 transform_normal(const std::array<float, 9>& c, float sign, const Vec3& n) {
  const Vec3 turned{c[0] * n.x + c[3] * n.y + c[6] * n.z, c[1] * n.x + c[4] * n.y + c[7] * n.z,
                    c[2] * n.x + c[5] * n.y + c[8] * n.z};
  const float length = std::hypot(turned.x, turned.y, turned.z);
  if (!(length > 0)) return {};
  return {sign * turned.x / length, sign * turned.y / length, sign * turned.z / length};
}

}  // namespace

absl::StatusOr<bool> GltfSkins::poses(int skin, const tinygltf::Primitive& primitive) {
  if (skin < 0 || !primitive.attributes.contains("JOINTS_0") || !primitive.attributes.contains("WEIGHTS_0")) {
    return false;
  }
  const absl::Status status = load(skin);
  if (!status.ok()) return status;
  return complete_;
}

// One skin at a time: files name the same for all primitives of a mesh, and what others cost is counted.
absl::Status GltfSkins::load(int index) {
  if (index == loaded_) return absl::OkStatus();
  if (static_cast<size_t>(index) >= model_.skins.size()) {
    return source_.malformed(fmt::format("skin {}", index), "", fmt::format("there are {}", model_.skins.size()));
  }
  const std::string where = fmt::format("skin {}", index);
  const tinygltf::Skin& skin = model_.skins[static_cast<size_t>(index)];
  const size_t count = skin.joints.size();
  if (count > kMostJoints) return source_.over_limit("joints of a skin", count, kMostJoints);
  const absl::Status status = accessors_.spend(kCostOfJoint * count, where);
  if (!status.ok()) return status;
  std::vector<std::array<float, 16>> joint_from_mesh;
  if (skin.inverseBindMatrices >= 0) {
    const absl::StatusOr<uint64_t> matrices = accessors_.count(skin.inverseBindMatrices);
    if (!matrices.ok()) return matrices.status();
    if (*matrices < count || *matrices > kMostJoints) {
      return source_.malformed(fmt::format("{} inverse bind matrices", *matrices), where,
                               fmt::format("must be {}..{}", count, kMostJoints));
    }
    absl::StatusOr<std::vector<std::array<float, 16>>> read =
        accessors_.read_matrices(skin.inverseBindMatrices, *matrices);
    if (!read.ok()) return read.status();
    joint_from_mesh = *std::move(read);
  }
  loaded_ = -1;
  complete_ = true;
  scene_from_mesh_.clear();
  for (size_t joint = 0; joint < count; ++joint) {
    const int node = skin.joints[joint];
    if (node < 0 || static_cast<size_t>(node) >= model_.nodes.size()) {
      return source_.malformed(fmt::format("joint {} is node {}", joint, node), where,
                               fmt::format("there are {}", model_.nodes.size()));
    }
    const std::optional<Matrix>& scene_from_joint = placement_.scene_from_node[static_cast<size_t>(node)];
    complete_ = complete_ && scene_from_joint.has_value();
    Matrix bind = kIdentity;
    if (!joint_from_mesh.empty()) std::copy_n(joint_from_mesh[joint].begin(), bind.size(), bind.begin());
    const Matrix m = multiply(scene_from_joint.value_or(kIdentity), bind);
    Affine& affine = scene_from_mesh_.emplace_back();
    for (size_t column = 0; column < 4; ++column) {
      for (size_t row = 0; row < 3; ++row) affine[3 * column + row] = static_cast<float>(m[4 * column + row]);
    }
  }
  loaded_ = index;
  return absl::OkStatus();
}

absl::StatusOr<std::vector<GltfSkins::Influences>> GltfSkins::read_influences(const tinygltf::Primitive& primitive,
                                                                              uint64_t count, std::string_view where) {
  std::vector<Influences> sets;
  for (int set = 0; set < kMostSets; ++set) {
    const auto joints = primitive.attributes.find(set_name("JOINTS", set));
    const auto weights = primitive.attributes.find(set_name("WEIGHTS", set));
    if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) break;
    absl::StatusOr<std::vector<GltfFloat4>> read = accessors_.read_joints(joints->second, count);
    if (!read.ok()) return read.status();
    absl::StatusOr<std::vector<GltfFloat4>> read_weights = accessors_.read_weights(weights->second, count);
    if (!read_weights.ok()) return read_weights.status();
    // What has no weight may name any joint.
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < 4; ++k) {
        if ((*read_weights)[i][k] == 0) (*read)[i][k] = 0;
        if ((*read)[i][k] < static_cast<float>(scene_from_mesh_.size()) || (*read_weights)[i][k] == 0) continue;
        return source_.malformed(fmt::format("joint {} of vertex {}", (*read)[i][k], i), where,
                                 fmt::format("skin {} has {} joints", loaded_, scene_from_mesh_.size()));
      }
    }
    sets.push_back({*std::move(read), *std::move(read_weights)});
  }
  return sets;
}

absl::Status GltfSkins::pose(int skin, const tinygltf::Primitive& primitive, std::string_view where, MeshData& mesh) {
  absl::Status status = load(skin);
  if (!status.ok()) return status;
  const absl::StatusOr<std::vector<Influences>> sets = read_influences(primitive, mesh.positions.size(), where);
  if (!sets.ok()) return sets.status();
  size_t mirrored = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    Affine blended{};
    float sum = 0;
    for (const Influences& set : *sets) {
      for (size_t k = 0; k < 4; ++k) {
        const float weight = set.weights[i][k];
        if (weight == 0) continue;
        sum += weight;
        const Affine& joint = scene_from_mesh_[static_cast<size_t>(set.joints[i][k])];
        for (size_t e = 0; e < blended.size(); ++e) blended[e] += weight * joint[e];
      }
    }
    if (!(sum > 0)) continue;
    for (float& element : blended) element /= sum;
    mesh.positions[i] = transform(blended, mesh.positions[i]);
    const std::array<float, 9> c = cofactors(blended);
    const bool mirrors = blended[0] * c[0] + blended[1] * c[1] + blended[2] * c[2] < 0;
    mirrored += mirrors ? 1 : 0;
    if (!mesh.normals.empty()) mesh.normals[i] = transform_normal(c, mirrors ? -1 : 1, mesh.normals[i]);
  }
  if (2 * mirrored > mesh.positions.size()) {
    for (size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
  }
  return absl::OkStatus();
}

}  // namespace diaphane::readers
