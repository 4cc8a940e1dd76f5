#include "diffusion/faces.h"

#include <algorithm>

#include "diffusion/four.h"

namespace diaphane::diffusion {
namespace {

/// Four points side by side.
struct Points {
  Four x, y, z;
};

}  // namespace

void measure_faces(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions_mm,
                   std::span<Face> faces) {
  static_assert(sizeof(Face) == 8 * sizeof(float));
  for (size_t first = 0; first < triangles.size(); first += 4) {
    const size_t count = std::min<size_t>(4, triangles.size() - first);
    Points corner[3];
    for (int c = 0; c < 3; ++c) {
      // Lanes behind the last triangle repeat it.
      const auto load = [&](size_t lane) {
        return load3(&positions_mm[triangles[first + std::min(lane, count - 1)][c]].x);
      };
      Four rows[4] = {load(0), load(1), load(2), load(3)};
      transpose4(rows[0], rows[1], rows[2], rows[3]);
      corner[c] = {rows[0], rows[1], rows[2]};
    }
    const auto& [a, b, c] = corner;
    const Points u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
    Four vector_x = 0.5f * (u.y * v.z - u.z * v.y);
    Four vector_y = 0.5f * (u.z * v.x - u.x * v.z);
    Four vector_z = 0.5f * (u.x * v.y - u.y * v.x);
    Four area = sqrt4(vector_x * vector_x + vector_y * vector_y + vector_z * vector_z);
    const Four third = area * (1.0f / 3);
    Four weighted_x = third * (a.x + b.x + c.x);
    Four weighted_y = third * (a.y + b.y + c.y);
    Four weighted_z = third * (a.z + b.z + c.z);
    Four zero{};
    transpose4(vector_x, vector_y, vector_z, area);
    transpose4(weighted_x, weighted_y, weighted_z, zero);
    const Four low[4] = {vector_x, vector_y, vector_z, area};
    const Four high[4] = {weighted_x, weighted_y, weighted_z, zero};
    for (size_t lane = 0; lane < count; ++lane) {
      auto* face = reinterpret_cast<float*>(&faces[first + lane]);
      store4(face, low[lane]);
      store4(face + 4, high[lane]);
    }
  }
}

}  // namespace diaphane::diffusion
