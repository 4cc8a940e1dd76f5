// Values as JSON, for --json.
#pragma once

#include <string>

#include "diaphane/client.h"
#include "diaphane/render_options.h"
#include "diaphane/scene.h"
#include "diaphane/values.h"
#include "nlohmann/json.hpp"

namespace diaphane::cli {

using Json = nlohmann::ordered_json;

/// The shortest decimal number that reads back as `value`.
Json to_json(float value);
Json to_json(const Vec3& value);
Json to_json(const Rgb& value);
Json to_json(const PointLight& light);
Json to_json(const Light& light);
Json to_json(const Coefficients& coefficients);
Json to_json(const MaterialPreset& preset);
Json to_json(const ServerInfo& info);
Json to_json(const SceneInfo& scene);
Json to_json(const SceneDescription& description);
Json to_json(const Camera& camera);
Json to_json(const StageTime& stage);

/// Prints `json` on stdout, indented. Text that is not UTF-8 (a path, say) has U+FFFD in its place.
void print_json(const Json& json);

}  // namespace diaphane::cli
