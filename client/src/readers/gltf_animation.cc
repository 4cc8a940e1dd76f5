#include "readers/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "readers/mesh_builder.h"

namespace diaphane::readers {
namespace {

using nlohmann::json;
using Property = GltfChannel::Property;
using Interpolation = GltfChannel::Interpolation;

constexpr double kNearlyParallel = 0.9995;  // cosine beyond which the arc is a chord

int integer(const json& object, const char* name) {
  const auto member = object.find(name);
  return member != object.end() && member->is_number_integer() ? member->get<int>() : -1;
}

std::string text(const json& object, const char* name) {
  const auto member = object.find(name);
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

void normalise(std::vector<double>& quaternion) {
  double length = 0;
  for (const double v : quaternion) length = std::hypot(length, v);
  if (length > 0) {
    for (double& v : quaternion) v /= length;
  }
}

std::vector<double> along_great_arc(const std::vector<double>& a, std::vector<double> b, double share) {
  double cosine = 0;
  for (size_t i = 0; i < a.size(); ++i) cosine += a[i] * b[i];
  if (cosine < 0) {
    for (double& v : b) v = -v;
    cosine = -cosine;
  }
  double of_a = 1 - share, of_b = share;
  if (cosine < kNearlyParallel) {
    const double angle = std::acos(cosine);
    of_a = std::sin((1 - share) * angle) / std::sin(angle);
    of_b = std::sin(share * angle) / std::sin(angle);
  }
  for (size_t i = 0; i < a.size(); ++i) b[i] = of_a * a[i] + of_b * b[i];
  normalise(b);
  return b;
}

/// Reads the animations of one model.
class AnimationReader {
 public:
  AnimationReader(const tinygltf::Model& model, GltfAccessors& accessors, const Source& source,
                  std::vector<std::string>& warnings)
      : model_(model), accessors_(accessors), source_(source), warnings_(warnings) {}

  absl::StatusOr<GltfAnimation> read(const json& object, size_t index) {
    where_ = fmt::format("animation {}", index);
    GltfAnimation animation;
    animation.name = tidy_name(text(object, "name"));
    if (animation.name.empty()) animation.name = where_;
    for (const char* list : {"channels", "samplers"}) {
      if (!object.is_object() || !object.contains(list) || !object[list].is_array()) {
        return source_.malformed(fmt::format("{} missing", list), where_, "must be an array");
      }
    }
    for (const json& channel : object["channels"]) {
      absl::StatusOr<std::optional<GltfChannel>> read = read_channel(channel, object["samplers"]);
      if (!read.ok()) return read.status();
      if (!read->has_value()) continue;
      animation.duration_s = std::max(animation.duration_s, static_cast<double>((*read)->times.back()));
      animation.channels.push_back(**std::move(read));
    }
    return animation;
  }

 private:
  absl::StatusOr<std::optional<GltfChannel>> read_channel(const json& object, const json& samplers) {
    if (!object.is_object() || !object.contains("target") || !object["target"].is_object()) {
      return source_.malformed("a channel without a target", where_);
    }
    const json& target = object["target"];
    if (!target.contains("node")) return leave_out("channels that move no node");
    GltfChannel channel;
    const int node = integer(target, "node");
    if (node < 0 || static_cast<size_t>(node) >= model_.nodes.size()) {
      return source_.malformed(fmt::format("node {}", node), where_, fmt::format("there are {}", model_.nodes.size()));
    }
    channel.node = static_cast<size_t>(node);
    const std::string path = text(target, "path");
    if (path == "translation")
      channel.property = Property::kTranslation;
    else if (path == "rotation")
      channel.property = Property::kRotation;
    else if (path == "scale")
      channel.property = Property::kScale;
    else if (path == "weights")
      channel.property = Property::kWeights;
    else
      return leave_out("channels that move something unknown");
    if (channel.property != Property::kWeights && !model_.nodes[channel.node].matrix.empty()) {
      return leave_out("channels of nodes that have a matrix");
    }
    const int sampler = integer(object, "sampler");
    if (sampler < 0 || static_cast<size_t>(sampler) >= samplers.size() ||
        !samplers[static_cast<size_t>(sampler)].is_object()) {
      return source_.malformed(fmt::format("sampler {}", sampler), where_,
                               fmt::format("there are {}", samplers.size()));
    }
    absl::Status status = read_sampler(samplers[static_cast<size_t>(sampler)], channel);
    if (!status.ok()) return status;
    if (channel.width == 0) return leave_out("channels of weights that the mesh has not");
    return std::optional(std::move(channel));
  }

  std::optional<GltfChannel> leave_out(std::string_view what) {
    std::string line = fmt::format("left out: {}, {}", what, where_);
    if (std::find(warnings_.begin(), warnings_.end(), line) == warnings_.end()) warnings_.push_back(std::move(line));
    return std::nullopt;
  }

  absl::Status read_sampler(const json& sampler, GltfChannel& channel) {
    const std::string interpolation = sampler.contains("interpolation") ? text(sampler, "interpolation") : "LINEAR";
    if (interpolation == "STEP")
      channel.interpolation = Interpolation::kStep;
    else if (interpolation == "LINEAR")
      channel.interpolation = Interpolation::kLinear;
    else if (interpolation == "CUBICSPLINE")
      channel.interpolation = Interpolation::kCubicSpline;
    else {
      return source_.malformed(fmt::format("interpolation {}", in_quotes(interpolation)), where_,
                               "must be STEP, LINEAR or CUBICSPLINE");
    }
    const int input = integer(sampler, "input"), output = integer(sampler, "output");
    const absl::StatusOr<uint64_t> keys = accessors_.count(input);
    if (!keys.ok()) return keys.status();
    if (*keys == 0) return source_.malformed("no keys", where_, "must be at least 1");
    absl::StatusOr<std::vector<float>> times = accessors_.read_scalars(input, *keys);
    if (!times.ok()) return times.status();
    for (size_t i = 0; i < times->size(); ++i) {
      const float time = (*times)[i];
      if (!std::isfinite(time) || time < 0 || (i > 0 && time <= (*times)[i - 1])) {
        return source_.malformed(fmt::format("key {} at {} s", i, time), where_,
                                 "must be finite, 0 or more, and after the one before");
      }
    }
    channel.times = *std::move(times);
    const uint64_t values = channel.times.size() * (channel.interpolation == Interpolation::kCubicSpline ? 3 : 1);
    absl::Status status = read_values(output, values, channel);
    if (!status.ok()) return status;
    const auto bad =
        std::find_if(channel.numbers.begin(), channel.numbers.end(), [](float v) { return !std::isfinite(v); });
    if (bad == channel.numbers.end()) return absl::OkStatus();
    return source_.malformed(fmt::format("value {} is {}", bad - channel.numbers.begin(), *bad), where_,
                             "must be finite");
  }

  absl::Status read_values(int output, uint64_t values, GltfChannel& channel) {
    if (channel.property == Property::kWeights) {
      channel.width = targets_of(channel.node);
      if (channel.width == 0) return absl::OkStatus();
      absl::StatusOr<std::vector<float>> read = accessors_.read_scalars(output, values * channel.width);
      if (read.ok()) channel.numbers = *std::move(read);
      return read.status();
    }
    if (channel.property == Property::kRotation) {
      channel.width = 4;
      const absl::StatusOr<std::vector<GltfFloat4>> read = accessors_.read_quaternions(output, values);
      if (!read.ok()) return read.status();
      for (const GltfFloat4& v : *read) channel.numbers.insert(channel.numbers.end(), v.begin(), v.end());
      return absl::OkStatus();
    }
    const absl::StatusOr<std::vector<Vec3>> read = accessors_.read_offsets(output, values);
    if (!read.ok()) return read.status();
    for (const Vec3& v : *read) channel.numbers.insert(channel.numbers.end(), {v.x, v.y, v.z});
    return absl::OkStatus();
  }

  size_t targets_of(size_t node) const {
    const int mesh = model_.nodes[node].mesh;
    if (mesh < 0 || static_cast<size_t>(mesh) >= model_.meshes.size()) return 0;
    size_t most = 0;
    for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<size_t>(mesh)].primitives) {
      most = std::max(most, primitive.targets.size());
    }
    return most;
  }

  const tinygltf::Model& model_;
  GltfAccessors& accessors_;
  const Source& source_;
  std::vector<std::string>& warnings_;
  std::string where_;
};

}  // namespace

std::vector<double> GltfChannel::at(double seconds) const {
  const bool spline = interpolation == Interpolation::kCubicSpline;
  // Of a spline: 0 the in-tangent, 1 the value, 2 the out-tangent.
  const auto key = [&](size_t i, size_t part) {
    const size_t first = width * (spline ? 3 * i + part : i);
    return std::vector<double>(numbers.begin() + static_cast<ptrdiff_t>(first),
                               numbers.begin() + static_cast<ptrdiff_t>(first + width));
  };
  const auto after = std::upper_bound(times.begin(), times.end(), seconds);
  const auto next = static_cast<size_t>(after - times.begin());
  if (next == 0) return key(0, 1);
  if (next == times.size() || interpolation == Interpolation::kStep) return key(next - 1, 1);
  const double step = static_cast<double>(times[next]) - times[next - 1];
  const double t = (seconds - times[next - 1]) / step;
  if (!spline && property == Property::kRotation) return along_great_arc(key(next - 1, 1), key(next, 1), t);
  std::vector<double> value = key(next - 1, 1);
  const std::vector<double> to = key(next, 1);
  if (!spline) {
    for (size_t i = 0; i < width; ++i) value[i] += t * (to[i] - value[i]);
    return value;
  }
  const std::vector<double> leaving = key(next - 1, 2), arriving = key(next, 0);
  const double t2 = t * t, t3 = t2 * t;
  for (size_t i = 0; i < width; ++i) {
    value[i] = (2 * t3 - 3 * t2 + 1) * value[i] + step * (t3 - 2 * t2 + t) * leaving[i] + (3 * t2 - 2 * t3) * to[i] +
               step * (t3 - t2) * arriving[i];
  }
  if (property == Property::kRotation) normalise(value);
  return value;
}

void GltfAnimation::apply(double seconds, tinygltf::Model& model) const {
  for (const GltfChannel& channel : channels) {
    tinygltf::Node& node = model.nodes[channel.node];
    std::vector<double> value = channel.at(seconds);
    switch (channel.property) {
      case Property::kTranslation:
        node.translation = std::move(value);
        break;
      case Property::kRotation:
        node.rotation = std::move(value);
        break;
      case Property::kScale:
        node.scale = std::move(value);
        break;
      case Property::kWeights:
        node.weights = std::move(value);
        break;
    }
  }
}

json take_gltf_animations(json& root) {
  const auto found = root.find("animations");
  if (found == root.end()) return json::array();
  json animations = std::move(*found);
  root.erase(found);
  return animations;
}

absl::StatusOr<std::vector<GltfAnimation>> read_gltf_animations(const json& animations, const tinygltf::Model& model,
                                                                GltfAccessors& accessors, const Source& source,
                                                                std::vector<std::string>& warnings) {
  if (!animations.is_array()) return source.malformed("animations is not an array", "in the JSON");
  std::vector<GltfAnimation> all;
  AnimationReader reader(model, accessors, source, warnings);
  for (const json& object : animations) {
    absl::StatusOr<GltfAnimation> animation = reader.read(object, all.size());
    if (!animation.ok()) return animation.status();
    all.push_back(*std::move(animation));
  }
  return all;
}

}  // namespace diaphane::readers
