#include "readers/gltf_scene.h"

#include <algorithm>

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

template <size_t count>
std::array<double, count> values_or(const std::vector<double>& values, std::array<double, count> otherwise) {
  if (!values.empty()) std::copy_n(values.begin(), count, otherwise.begin());
  return otherwise;
}

bool is_zero(const std::array<double, 4>& rotation) { return rotation == std::array<double, 4>{}; }

class ScenePlacer {
 public:
  ScenePlacer(const tinygltf::Model& model, const GltfExtensions& extensions, GltfAccessors& accessors,
              const Source& source)
      : model_(model),
        extensions_(extensions),
        accessors_(accessors),
        source_(source),
        reached_(model.nodes.size(), false) {
    placement_.scene_from_node.resize(model.nodes.size());
  }

  absl::StatusOr<GltfPlacement> place() {
    const bool any_placed = std::any_of(model_.nodes.begin(), model_.nodes.end(),
                                        [](const tinygltf::Node& node) { return node.mesh >= 0; });
    if (!any_placed) {
      for (size_t mesh = 0; mesh < model_.meshes.size(); ++mesh) placement_.instances.push_back({mesh});
      return std::move(placement_);
    }
    absl::StatusOr<std::vector<int>> roots = find_roots();
    if (!roots.ok()) return roots.status();
    const absl::Status status = walk(*roots);
    if (!status.ok()) return status;
    return std::move(placement_);
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
      placement_.scene_from_node[static_cast<size_t>(visit.node)] = scene_from_node;
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
    const std::array<double, 4> rotation = values_or<4>(node.rotation, {0, 0, 0, 1});
    if (is_zero(rotation)) return source_.malformed("a rotation of length 0", place, "must be a unit quaternion");
    return compose(values_or<3>(node.translation, {0, 0, 0}), rotation, values_or<3>(node.scale, {1, 1, 1}));
  }

  absl::Status place_mesh(const tinygltf::Node& node, int index, const Matrix& scene_from_node) {
    if (node.mesh < 0) return absl::OkStatus();
    const Place place{"node", static_cast<uint64_t>(index)};
    if (static_cast<size_t>(node.mesh) >= model_.meshes.size()) {
      return source_.malformed(fmt::format("mesh {}", node.mesh), place,
                               fmt::format("there are {}", model_.meshes.size()));
    }
    const auto instancing = extensions_.instancing_of_node.find(static_cast<size_t>(index));
    return instancing == extensions_.instancing_of_node.end()
               ? add_instance(node.mesh, index, scene_from_node)
               : place_instances(node.mesh, index, scene_from_node, instancing->second);
  }

  absl::Status add_instance(int mesh, int node, const Matrix& scene_from_mesh) {
    const Place place{"node", static_cast<uint64_t>(node)};
    if (!fits_float(scene_from_mesh)) return source_.malformed("a transform that is not finite", place);
    const size_t count = placement_.instances.size() + 1;
    if (count > source_.limits.max_nodes) return source_.over_limit("instances", count, source_.limits.max_nodes);
    placement_.instances.push_back({static_cast<size_t>(mesh), node, scene_from_mesh});
    return absl::OkStatus();
  }

  // EXT_mesh_gpu_instancing: each transform goes between the node's and the mesh; one of no attributes is the node's.
  absl::Status place_instances(int mesh, int node, const Matrix& scene_from_node, const GltfInstancing& instancing) {
    uint64_t count = 1;
    for (const int accessor : {instancing.translation, instancing.rotation, instancing.scale}) {
      if (accessor < 0) continue;
      const absl::StatusOr<uint64_t> elements = accessors_.count(accessor);
      if (!elements.ok()) return elements.status();
      count = *elements;
    }
    if (count > source_.limits.max_nodes) return source_.over_limit("instances", count, source_.limits.max_nodes);
    std::vector<Vec3> translations(count), scales(count, Vec3{1, 1, 1});
    std::vector<GltfFloat4> rotations(count, GltfFloat4{0, 0, 0, 1});
    absl::Status status = read_if(instancing.translation, translations, &GltfAccessors::read_offsets);
    if (status.ok()) status = read_if(instancing.scale, scales, &GltfAccessors::read_offsets);
    if (status.ok()) status = read_if(instancing.rotation, rotations, &GltfAccessors::read_quaternions);
    for (size_t i = 0; i < count && status.ok(); ++i) {
      const auto& [x, y, z, w] = rotations[i];
      const std::array<double, 4> rotation = {x, y, z, w};
      if (is_zero(rotation)) {
        return source_.malformed(fmt::format("rotation {} of length 0", i), Place{"node", static_cast<uint64_t>(node)},
                                 "must be a unit quaternion");
      }
      const Matrix node_from_mesh = compose({translations[i].x, translations[i].y, translations[i].z}, rotation,
                                            {scales[i].x, scales[i].y, scales[i].z});
      status = add_instance(mesh, node, multiply(scene_from_node, node_from_mesh));
    }
    return status;
  }

  template <typename T>
  absl::Status read_if(int accessor, std::vector<T>& values,
                       absl::StatusOr<std::vector<T>> (GltfAccessors::*read)(int, uint64_t)) {
    if (accessor < 0) return absl::OkStatus();
    absl::StatusOr<std::vector<T>> elements = (accessors_.*read)(accessor, values.size());
    if (elements.ok()) values = *std::move(elements);
    return elements.status();
  }

  const tinygltf::Model& model_;
  const GltfExtensions& extensions_;
  GltfAccessors& accessors_;
  const Source& source_;
  std::vector<bool> reached_;
  std::vector<Visit> open_;
  GltfPlacement placement_;
};

}  // namespace

absl::StatusOr<GltfPlacement> place_gltf_meshes(const tinygltf::Model& model, const GltfExtensions& extensions,
                                                GltfAccessors& accessors, const Source& source) {
  return ScenePlacer(model, extensions, accessors, source).place();
}

}  // namespace diaphane::readers
