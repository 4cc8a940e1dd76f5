#include "readers/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

using Matrix = std::array<double, 16>;  // column-major

constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 4; ++row) {
      for (size_t k = 0; k < 4; ++k) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return product;
}

double determinant(const Matrix& m) {
  return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) + m[8] * (m[1] * m[6] - m[5] * m[2]);
}

// Translation · rotation · scale, glTF 2.0 section 3.5.3; the quaternion is x, y, z, w.
Matrix compose(const std::vector<double>& translation, const std::vector<double>& rotation,
               const std::vector<double>& scale) {
  Matrix m = kIdentity;
  if (!rotation.empty()) {
    const double length = std::hypot(std::hypot(rotation[0], rotation[1]), std::hypot(rotation[2], rotation[3]));
    const double x = rotation[0] / length, y = rotation[1] / length, z = rotation[2] / length, w = rotation[3] / length;
    m = {1 - 2 * (y * y + z * z),
         2 * (x * y + w * z),
         2 * (x * z - w * y),
         0,
         2 * (x * y - w * z),
         1 - 2 * (x * x + z * z),
         2 * (y * z + w * x),
         0,
         2 * (x * z + w * y),
         2 * (y * z - w * x),
         1 - 2 * (x * x + y * y),
         0,
         0,
         0,
         0,
         1};
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t row = 0; row < 3; ++row) m[4 * axis + row] *= scale.empty() ? 1 : scale[axis];
    m[12 + axis] = translation.empty() ? 0 : translation[axis];
  }
  return m;
}

class ScenePlacer {
 public:
  ScenePlacer(const tinygltf::Model& model, const Source& source, std::vector<std::string>& warnings)
      : model_(model), source_(source), warnings_(warnings), reached_(model.nodes.size(), false) {}

  absl::StatusOr<std::vector<GltfInstance>> place() {
    const bool any_placed = std::any_of(model_.nodes.begin(), model_.nodes.end(),
                                        [](const tinygltf::Node& node) { return node.mesh >= 0; });
    if (!any_placed) {
      for (size_t mesh = 0; mesh < model_.meshes.size(); ++mesh) instances_.push_back({mesh});
      return std::move(instances_);
    }
    absl::StatusOr<std::vector<int>> roots = find_roots();
    if (!roots.ok()) return roots.status();
    const absl::Status status = walk(*roots);
    if (!status.ok()) return status;
    if (flattened_ > 0) warnings_.push_back(fmt::format("left out: {} instances of no volume (scale 0)", flattened_));
    return std::move(instances_);
  }

 private:
  struct Visit {
    int node;
    Matrix scene_from_parent;
  };

  absl::StatusOr<std::vector<int>> find_roots() const {
    if (!model_.scenes.empty()) {
      const int scene = std::max(model_.defaultScene, 0);
      if (static_cast<size_t>(scene) >= model_.scenes.size()) {
        return source_.malformed(fmt::format("scene {}", scene), "", fmt::format("there are {}", model_.scenes.size()));
      }
      return model_.scenes[static_cast<size_t>(scene)].nodes;
    }
    std::vector<bool> is_child(model_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes) {
      for (int child : node.children) {
        if (child >= 0 && static_cast<size_t>(child) < is_child.size()) is_child[static_cast<size_t>(child)] = true;
      }
    }
    std::vector<int> roots;
    for (size_t node = 0; node < is_child.size(); ++node) {
      if (!is_child[node]) roots.push_back(static_cast<int>(node));
    }
    return roots;
  }

  // Without recursion, so that a deep chain is no danger. A node is marked when it is put on the list: neither a cycle
  // nor a child that is named a million times makes the list longer than there are nodes.
  absl::Status walk(const std::vector<int>& roots) {
    absl::Status status = put_off(roots, kIdentity);
    while (status.ok() && !open_.empty()) {
      const Visit visit = open_.back();
      open_.pop_back();
      const tinygltf::Node& node = model_.nodes[static_cast<size_t>(visit.node)];
      const absl::StatusOr<Matrix> local = local_matrix(node, visit.node);
      if (!local.ok()) return local.status();
      const Matrix scene_from_node = multiply(visit.scene_from_parent, *local);
      status = place_mesh(node, visit.node, scene_from_node);
      if (status.ok()) status = put_off(node.children, scene_from_node);
    }
    return status;
  }

  // Puts nodes on the list of those to visit, the first on top.
  absl::Status put_off(const std::vector<int>& nodes, const Matrix& scene_from_parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
      if (*node < 0 || static_cast<size_t>(*node) >= model_.nodes.size()) {
        return source_.malformed(fmt::format("node {}", *node), "", fmt::format("there are {}", model_.nodes.size()));
      }
      if (reached_[static_cast<size_t>(*node)]) {
        return source_.malformed("is reached twice", Place{"node", static_cast<uint64_t>(*node)},
                                 "the nodes must be a tree");
      }
      reached_[static_cast<size_t>(*node)] = true;
      open_.push_back({*node, scene_from_parent});
    }
    return absl::OkStatus();
  }

  absl::StatusOr<Matrix> local_matrix(const tinygltf::Node& node, int index) const {
    const Place place{"node", static_cast<uint64_t>(index)};
    const auto has = [](const std::vector<double>& values, size_t count) {
      return values.empty() || values.size() == count;
    };
    if (!has(node.matrix, 16) || !has(node.translation, 3) || !has(node.rotation, 4) || !has(node.scale, 3)) {
      return source_.malformed("a transform of the wrong length", place, "must be matrix 16, rotation 4, others 3");
    }
    if (!node.matrix.empty()) {
      Matrix matrix;
      std::copy(node.matrix.begin(), node.matrix.end(), matrix.begin());
      if (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1) {
        return source_.malformed("a matrix that is not affine", place, "its last row must be 0 0 0 1");
      }
      return matrix;
    }
    if (!node.rotation.empty() &&
        std::all_of(node.rotation.begin(), node.rotation.end(), [](double v) { return v == 0; })) {
      return source_.malformed("a rotation of length 0", place, "must be a unit quaternion");
    }
    return compose(node.translation, node.rotation, node.scale);
  }

  absl::Status place_mesh(const tinygltf::Node& node, int index, const Matrix& scene_from_mesh) {
    if (node.mesh < 0) return absl::OkStatus();
    const Place place{"node", static_cast<uint64_t>(index)};
    if (static_cast<size_t>(node.mesh) >= model_.meshes.size()) {
      return source_.malformed(fmt::format("mesh {}", node.mesh), place,
                               fmt::format("there are {}", model_.meshes.size()));
    }
    const bool fits = std::all_of(scene_from_mesh.begin(), scene_from_mesh.end(),
                                  [](double value) { return std::abs(value) <= std::numeric_limits<float>::max(); });
    if (!fits) return source_.malformed("a transform that is not finite", place);
    if (determinant(scene_from_mesh) == 0) {
      ++flattened_;
    } else {
      instances_.push_back({static_cast<size_t>(node.mesh), index, scene_from_mesh});
    }
    return absl::OkStatus();
  }

  const tinygltf::Model& model_;
  const Source& source_;
  std::vector<std::string>& warnings_;
  std::vector<bool> reached_;
  std::vector<Visit> open_;
  std::vector<GltfInstance> instances_;
  uint64_t flattened_ = 0;
};

}  // namespace

absl::StatusOr<std::vector<GltfInstance>> place_gltf_meshes(const tinygltf::Model& model, const Source& source,
                                                            std::vector<std::string>& warnings) {
  return ScenePlacer(model, source, warnings).place();
}

}  // namespace diaphane::readers
