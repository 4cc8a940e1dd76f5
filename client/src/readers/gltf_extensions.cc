#include "readers/gltf_extensions.h"

#include <functional>
#include <limits>

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

using nlohmann::json;

/// The members of one extension object; the first that is of the wrong type is kept in status().
class Members {
 public:
  Members(const json& object, std::string where, const Source& source)
      : object_(object), where_(std::move(where)), source_(source) {}

  uint64_t integer(const char* name, bool required = true) {
    const auto member = object_.find(name);
    if (member == object_.end() && !required) return 0;
    if (member != object_.end() && member->is_number_unsigned()) return member->get<uint64_t>();
    refuse(name, "must be an integer of 0 or more");
    return 0;
  }

  std::string text(const char* name, const char* otherwise) {
    const auto member = object_.find(name);
    if (member == object_.end()) return otherwise;
    if (member->is_string()) return member->get<std::string>();
    refuse(name, "must be a string");
    return {};
  }

  /// Members of the object `name`, all of them integers.
  std::map<std::string, uint32_t> integers(const char* name) {
    std::map<std::string, uint32_t> values;
    const auto member = object_.find(name);
    if (member == object_.end() || !member->is_object()) {
      refuse(name, "must be an object");
      return values;
    }
    for (const auto& [key, value] : member->items()) {
      if (value.is_number_unsigned() && value.get<uint64_t>() <= std::numeric_limits<int32_t>::max()) {
        values[key] = value.get<uint32_t>();
      } else {
        refuse(name, "must hold integers of 0 or more");
      }
    }
    return values;
  }

  const absl::Status& status() const { return status_; }

 private:
  void refuse(const char* name, std::string_view range) {
    if (status_.ok()) status_ = source_.malformed(fmt::format("{} of the wrong type or missing", name), where_, range);
  }

  const json& object_;
  const std::string where_;
  const Source& source_;
  absl::Status status_;
};

absl::Status read_meshopt(const json& object, const std::string& where, const Source& source, GltfMeshopt& meshopt) {
  Members members(object, where, source);
  meshopt.buffer = members.integer("buffer");
  meshopt.byte_offset = members.integer("byteOffset", false);
  meshopt.byte_length = members.integer("byteLength");
  meshopt.byte_stride = members.integer("byteStride");
  meshopt.count = members.integer("count");
  meshopt.mode = members.text("mode", "");
  meshopt.filter = members.text("filter", "NONE");
  return members.status();
}

absl::Status read_draco(const json& object, const std::string& where, const Source& source, GltfDraco& draco) {
  Members members(object, where, source);
  draco.buffer_view = static_cast<int>(members.integer("bufferView"));
  draco.unique_ids = members.integers("attributes");
  return members.status();
}

absl::Status read_instancing(const json& object, const std::string& where, const Source& source,
                             GltfInstancing& instancing) {
  Members members(object, where, source);
  const std::map<std::string, uint32_t> attributes = members.integers("attributes");
  for (const auto& [name, accessor] : {std::pair{"TRANSLATION", &instancing.translation},
                                       {"ROTATION", &instancing.rotation},
                                       {"SCALE", &instancing.scale}}) {
    if (const auto found = attributes.find(name); found != attributes.end())
      *accessor = static_cast<int>(found->second);
  }
  return members.status();
}

using Take = std::function<absl::Status(std::string_view name, const json& object)>;

// Hands every extension object of `owner` to `take`, and removes them.
absl::Status take_all(json& owner, const std::string& where, const Source& source, const Take& take) {
  if (!owner.is_object()) return absl::OkStatus();
  const auto member = owner.find("extensions");
  if (member == owner.end()) return absl::OkStatus();
  const json extensions = std::move(*member);
  owner.erase(member);
  if (!extensions.is_object()) return source.malformed("extensions of the wrong type", where, "must be an object");
  for (const auto& [name, object] : extensions.items()) {
    if (!object.is_object()) {
      return source.malformed(fmt::format("{} of the wrong type", name), where, "must be an object");
    }
    if (absl::Status status = take(name, object); !status.ok()) return status;
  }
  return absl::OkStatus();
}

using Visit = std::function<absl::Status(size_t index, json& element)>;

absl::Status for_each_in(json& owner, const char* name, const Visit& visit) {
  const auto list = owner.is_object() ? owner.find(name) : owner.end();
  if (list == owner.end() || !list->is_array()) return absl::OkStatus();
  for (size_t i = 0; i < list->size(); ++i) {
    if (absl::Status status = visit(i, (*list)[i]); !status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<GltfExtensions> take_gltf_extensions(json& root, const Source& source) {
  GltfExtensions taken;
  absl::Status status = for_each_in(root, "bufferViews", [&](size_t view, json& element) {
    const std::string where = fmt::format("bufferViews {}", view);
    return take_all(element, where, source, [&](std::string_view name, const json& object) {
      return name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression"
                 ? read_meshopt(object, where, source, taken.meshopt_of_view[view])
                 : absl::OkStatus();
    });
  });
  if (!status.ok()) return status;
  status = for_each_in(root, "nodes", [&](size_t node, json& element) {
    const std::string where = fmt::format("nodes {}", node);
    return take_all(element, where, source, [&](std::string_view name, const json& object) {
      return name == "EXT_mesh_gpu_instancing" ? read_instancing(object, where, source, taken.instancing_of_node[node])
                                               : absl::OkStatus();
    });
  });
  if (!status.ok()) return status;
  status = for_each_in(root, "meshes", [&](size_t mesh, json& meshes) {
    return for_each_in(meshes, "primitives", [&](size_t primitive, json& element) {
      const std::string where = fmt::format("mesh {} primitive {}", mesh, primitive);
      return take_all(element, where, source, [&](std::string_view name, const json& object) {
        if (name != "KHR_draco_mesh_compression") return absl::OkStatus();
        GltfDraco& draco = taken.draco_of_primitive[{mesh, primitive}];
        if (element.contains("indices")) {
          Members members(element, where, source);
          draco.indices = static_cast<int>(members.integer("indices"));
          if (!members.status().ok()) return members.status();
          element.erase("indices");
        }
        return read_draco(object, where, source, draco);
      });
    });
  });
  if (!status.ok()) return status;
  return taken;
}

}  // namespace diaphane::readers
