// Materials that have names.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "optics/dipole.h"

namespace diaphane::optics {

struct MaterialPreset {
  std::string_view name;
  Coefficients coefficients;
  std::string_view source;  ///< where the figures come from
};

/// All presets, by name. The twelve measured ones are JMLH01's table (the paper's Fig. 8 caption swaps its columns);
/// wax and porcelain, which the paper shows without figures, are ours.
std::span<const MaterialPreset> material_presets();

/// The preset called `name`, exactly.
std::optional<MaterialPreset> find_preset(std::string_view name);

}  // namespace diaphane::optics
