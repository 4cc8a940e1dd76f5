#include "readers/gltf_json.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "fmt/format.h"
#include "readers/gltf_extensions.h"

namespace diaphane::readers {
namespace {

constexpr std::string_view kRootMembers[] = {
    "accessors", "asset", "bufferViews", "buffers",   "scenes",   "scene",  "extensionsUsed", "extensionsRequired",
    "meshes",    "nodes", "skins",       "materials", "textures", "images", "samplers",       "animations"};
constexpr std::string_view kLeftOut[] = {"extras", "max", "min"};
constexpr int kNumberOutOfRange = 406;  // nlohmann::json::out_of_range

template <size_t size>
bool contains(const std::string_view (&names)[size], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

}  // namespace

GltfJsonBuilder::GltfJsonBuilder(const Source& source)
    : source_(source), most_objects_(kMostObjectsPerNode * uint64_t{source.limits.max_nodes} + 1000) {}

// tinygltf would cut an integer to 32 bits; check_gltf_types() refuses it where it is no plain number.
bool GltfJsonBuilder::number_integer(int64_t value) {
  return value < std::numeric_limits<int32_t>::min() ? add(static_cast<double>(value)) : add(value);
}

bool GltfJsonBuilder::number_unsigned(uint64_t value) {
  return value > std::numeric_limits<int32_t>::max() ? add(static_cast<double>(value)) : add(value);
}

bool GltfJsonBuilder::start_object(size_t) {
  if (!skipping_ && ++objects_ > most_objects_) {
    return stop(source_.over_limit("JSON objects or more", most_objects_ + 1, most_objects_));
  }
  return start(json::object());
}

bool GltfJsonBuilder::start_array(size_t) { return start(json::array()); }

bool GltfJsonBuilder::key(std::string& name) {
  if (skipping_) return true;
  if (open_.size() == 1) {
    skipping_ = !contains(kRootMembers, name);
  } else if (open_.back().is_extensions) {
    skipping_ = !contains(kReadExtensions, name);
  } else {
    skipping_ = contains(kLeftOut, name);
  }
  if (!skipping_) member_ = &(*open_.back().container)[name];
  member_is_extensions_ = name == "extensions";
  return true;
}

bool GltfJsonBuilder::add(json value) {
  if (skipping_) {
    skipping_ = skipped_levels_ > 0;
    return true;
  }
  place(std::move(value));
  return ++values_ <= kMostValues || stop(source_.over_limit("JSON values or more", values_, kMostValues));
}

bool GltfJsonBuilder::start(json container) {
  if (open_.size() + skipped_levels_ == kDeepest) {
    return stop(source_.over_limit("levels of JSON or more", kDeepest + 1, kDeepest));
  }
  if (skipping_) {
    ++skipped_levels_;
    return true;
  }
  const bool is_extensions = member_is_extensions_ && container.is_object();
  member_is_extensions_ = false;
  open_.push_back({place(std::move(container)), is_extensions});
  return ++values_ <= kMostValues || stop(source_.over_limit("JSON values or more", values_, kMostValues));
}

bool GltfJsonBuilder::end() {
  if (skipping_) {
    skipping_ = --skipped_levels_ > 0;
  } else {
    open_.pop_back();
  }
  return true;
}

// Puts a value where the parse stands: the root, the element after an array's last, or the member named last. What is
// open stays where it is, because only the innermost container grows.
nlohmann::json* GltfJsonBuilder::place(json value) {
  if (open_.empty()) {
    root_ = std::move(value);
    return &root_;
  }
  if (json& innermost = *open_.back().container; innermost.is_array()) {
    innermost.push_back(std::move(value));
    return &innermost.back();
  }
  *member_ = std::move(value);
  return member_;
}

bool GltfJsonBuilder::parse_error(size_t position, const std::string&, const json::exception& error) {
  const Place place{"byte", position};
  if (error.id == kNumberOutOfRange) return stop(source_.malformed("a JSON number that is out of range", place));
  return stop(source_.malformed("is not well-formed JSON", place));
}

bool GltfJsonBuilder::stop(absl::Status error) {
  error_ = std::move(error);
  return false;
}

}  // namespace diaphane::readers
