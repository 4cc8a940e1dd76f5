#include "optics/presets.h"

namespace diaphane::optics {
namespace {

constexpr std::string_view kMeasured = "Jensen, Marschner, Levoy, Hanrahan 2001, measured";
constexpr std::string_view kOurs = "Diaphane's own, chosen by eye";

// σa, σ's in mm⁻¹, η.
const MaterialPreset kPresets[] = {
    {"apple", {{.0030f, .0034f, .046f}, {2.29f, 2.39f, 1.97f}, 1.3f}, kMeasured},
    {"chicken1", {{.015f, .077f, .19f}, {.15f, .21f, .38f}, 1.3f}, kMeasured},
    {"chicken2", {{.018f, .088f, .20f}, {.19f, .25f, .32f}, 1.3f}, kMeasured},
    {"cream", {{.0002f, .0028f, .0163f}, {7.38f, 5.47f, 3.15f}, 1.3f}, kMeasured},
    {"ketchup", {{.061f, .97f, 1.45f}, {.18f, .07f, .03f}, 1.3f}, kMeasured},
    {"marble", {{.0021f, .0041f, .0071f}, {2.19f, 2.62f, 3.00f}, 1.5f}, kMeasured},
    {"porcelain", {{.0008f, .0009f, .0012f}, {6.2f, 6.4f, 6.6f}, 1.5f}, kOurs},
    {"potato", {{.0024f, .0090f, .12f}, {.68f, .70f, .55f}, 1.3f}, kMeasured},
    {"skimmilk", {{.0014f, .0025f, .0142f}, {.70f, 1.22f, 1.90f}, 1.3f}, kMeasured},
    {"skin1", {{.032f, .17f, .48f}, {.74f, .88f, 1.01f}, 1.3f}, kMeasured},
    {"skin2", {{.013f, .070f, .145f}, {1.09f, 1.59f, 1.79f}, 1.3f}, kMeasured},
    {"spectralon", {{0, 0, 0}, {11.6f, 20.4f, 14.9f}, 1.3f}, kMeasured},
    {"wax", {{.0015f, .012f, .055f}, {1.30f, 1.15f, 1.05f}, 1.4f}, kOurs},
    {"wholemilk", {{.0011f, .0024f, .014f}, {2.55f, 3.21f, 3.77f}, 1.3f}, kMeasured},
};

}  // namespace

std::span<const MaterialPreset> material_presets() { return kPresets; }

std::optional<MaterialPreset> find_preset(std::string_view name) {
  for (const MaterialPreset& preset : kPresets) {
    if (preset.name == name) return preset;
  }
  return std::nullopt;
}

}  // namespace diaphane::optics
