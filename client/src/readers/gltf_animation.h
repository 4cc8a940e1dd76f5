// Animations of glTF: what they move, and where it is at a moment.
#pragma once

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "nlohmann/json.hpp"
#include "readers/gltf_accessor.h"
#include "readers/source.h"
#include "tiny_gltf.h"

namespace diaphane::readers {

/// One property of one node over time, glTF 2.0 sections 3.11 and C.
struct GltfChannel {
  enum class Property { kTranslation, kRotation, kScale, kWeights };
  enum class Interpolation { kStep, kLinear, kCubicSpline };

  size_t node = 0;
  Property property = Property::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  size_t width = 3;            ///< numbers of a value; at least 1
  std::vector<float> times;    ///< seconds, ascending; at least one
  std::vector<float> numbers;  ///< of a value a key, or in-tangent, value and out-tangent of a spline

  /// The value at `seconds`.
  std::vector<double> at(double seconds) const;
};

struct GltfAnimation {
  std::string name;
  double duration_s = 0;
  std::vector<GltfChannel> channels;

  /// Puts every property where it is at `seconds`.
  void apply(double seconds, tinygltf::Model& model) const;
};

/// Takes "animations" out of a root object.
nlohmann::json take_gltf_animations(nlohmann::json& root);

/// Checks and reads them; what they move that is not known is left out, and told to `warnings`. kInvalidArgument as
/// AnimatedFile::read() has it; kResourceExhausted past the accessors' bound.
absl::StatusOr<std::vector<GltfAnimation>> read_gltf_animations(const nlohmann::json& animations,
                                                                const tinygltf::Model& model, GltfAccessors& accessors,
                                                                const Source& source,
                                                                std::vector<std::string>& warnings);

}  // namespace diaphane::readers
