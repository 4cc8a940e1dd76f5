#include "render/map_pyramid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glm/common.hpp"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

/// Both sides halved, down to 1; rows weigh by their solid angle.
optics::LatLongMap halved(const optics::LatLongMap& map) {
  optics::LatLongMap half{std::max(map.width_px / 2, 1u), std::max(map.height_px / 2, 1u), {}};
  half.radiance.resize(size_t{half.width_px} * half.height_px);
  tbb::parallel_for(uint32_t{0}, half.height_px, [&](uint32_t y) {
    const uint32_t rows[] = {std::min(2 * y, map.height_px - 1), std::min(2 * y + 1, map.height_px - 1)};
    const auto upper = static_cast<float>(map.solid_angle(rows[0])),
               lower = static_cast<float>(map.solid_angle(rows[1]));
    for (uint32_t x = 0; x < half.width_px; ++x) {
      const uint32_t columns[] = {std::min(2 * x, map.width_px - 1), std::min(2 * x + 1, map.width_px - 1)};
      const auto pair = [&](uint32_t row) {
        const glm::vec3* of_row = &map.radiance[size_t{row} * map.width_px];
        return 0.5f * (of_row[columns[0]] + of_row[columns[1]]);
      };
      half.radiance[size_t{y} * half.width_px + x] = (upper * pair(rows[0]) + lower * pair(rows[1])) / (upper + lower);
    }
  });
  return half;
}

}  // namespace

MapPyramid::MapPyramid(const optics::LatLongMap& map) {
  for (const optics::LatLongMap* finer = &map; finer->height_px > 1; finer = &coarser_.back()) {
    coarser_.push_back(halved(*finer));
  }
}

glm::vec3 MapPyramid::around(const optics::LatLongMap& map, const glm::vec3& direction, float solid_angle_sr) const {
  const float pixel_sr =
      4 * std::numbers::pi_v<float> / (static_cast<float>(map.width_px) * static_cast<float>(map.height_px));
  const float wanted = 0.5f * std::log2(std::max(solid_angle_sr / pixel_sr, 1.0f));
  const float at = std::min(wanted, static_cast<float>(coarser_.size()));
  const auto finer = static_cast<size_t>(at);
  const glm::vec3 fine = optics::radiance_towards(finer == 0 ? map : coarser_[finer - 1], direction);
  const float share = at - static_cast<float>(finer);
  if (share == 0) return fine;
  return glm::mix(fine, optics::radiance_towards(coarser_[finer], direction), share);
}

}  // namespace diaphane::render
