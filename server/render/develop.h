// From linear radiance to what a screen shows: exposure, tone mapping, the background, sRGB.
#pragma once

#include <optional>

#include "base/image.h"
#include "glm/vec3.hpp"
#include "render/frame.h"

namespace diaphane::render {

/// Stops that bring the 98th percentile of the luminance (BT.709) of what `picture` shows to 0.8; 0 where it shows
/// nothing, or black alone. `picture`: R G B A, colour multiplied by alpha.
float find_exposure_ev(const base::ImageF& picture);

/// Lays `picture` (R G B A first, colour multiplied by alpha) over one colour; alpha becomes 1.
void lay_over(const glm::vec3& background, base::ImageF& picture);

/// Colours up to 0.8 stay as they are; brighter ones approach 1 and lose their colour: the shoulder of Khronos PBR
/// Neutral (2024). Its toe is left out: it takes back 4 % of reflection that a body without a coat has not. At or above
/// 0, finite.
glm::vec3 tone_map_neutral(const glm::vec3& colour);

/// `picture` (R G B A, colour multiplied by alpha) times 2^exposure_ev, tone-mapped, sRGB-encoded; alpha unassociated.
base::Image8 develop(const base::ImageF& picture, float exposure_ev, ToneMapping tone_mapping);

/// IEC 61966-2-1, of linear values clamped to 0..1.
float encode_srgb(float linear);

/// 0..1 to 0..255, rounded.
uint8_t to_byte(float value);

}  // namespace diaphane::render
