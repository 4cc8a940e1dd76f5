#include "gallery/candle.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace diaphane::gallery {
namespace {

constexpr int kAround = 144;
constexpr float kFoot_mm = 1;     // radius of the rounded foot
constexpr float kSunk_mm = 1.6f;  // how much lower the rim is where it is lowest
constexpr float kWickRadius_mm = 0.5f;
constexpr float kWickHeight_mm = 3;

struct OutlinePoint {
  float radius = 0;
  float y = 0;
};

struct Run {
  float angle;      // radians
  float length_mm;  // below the rim
  float bulge_mm;
};
constexpr Run kRuns[] = {{0.5f, 15, 0.9f}, {1.35f, 8, 0.7f}, {2.6f, 12, 0.8f}, {4.4f, 18, 1.0f}, {5.5f, 6, 0.6f}};

// Appends a quarter of an ellipse from `from` to `to`, degrees counted from +r towards +y.
void append_arc(std::vector<OutlinePoint>* outline, const OutlinePoint& centre, float radius_r, float radius_y,
                float from_deg, float to_deg, float spacing) {
  const float turn = (to_deg - from_deg) * std::numbers::pi_v<float> / 180;
  const int steps = std::max(2, static_cast<int>(std::abs(turn) * std::max(radius_r, radius_y) / spacing));
  for (int i = 1; i <= steps; ++i) {
    const float angle =
        from_deg * std::numbers::pi_v<float> / 180 + turn * static_cast<float>(i) / static_cast<float>(steps);
    outline->push_back({centre.radius + radius_r * std::cos(angle), centre.y + radius_y * std::sin(angle)});
  }
}

void append_line(std::vector<OutlinePoint>* outline, const OutlinePoint& to, float spacing) {
  const OutlinePoint from = outline->back();
  const float length = std::hypot(to.radius - from.radius, to.y - from.y);
  const int steps = std::max(1, static_cast<int>(length / spacing));
  for (int i = 1; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    outline->push_back({from.radius + t * (to.radius - from.radius), from.y + t * (to.y - from.y)});
  }
}

// From the middle of the foot, up the wall, over the rim, down into the hollow to its middle.
std::vector<OutlinePoint> outline_of(const CandleShape& s) {
  const float rim = s.wall / 2;
  const float hollow = s.radius - s.wall;
  const float rim_y = s.height - rim;
  std::vector<OutlinePoint> outline = {{0, 0}};
  append_line(&outline, {s.radius - kFoot_mm, 0}, s.spacing);
  append_arc(&outline, {s.radius - kFoot_mm, kFoot_mm}, kFoot_mm, kFoot_mm, -90, 0, s.spacing);
  append_line(&outline, {s.radius, rim_y}, s.spacing);
  append_arc(&outline, {s.radius - rim, rim_y}, rim, rim, 0, 180, s.spacing);
  append_arc(&outline, {0, rim_y}, hollow, s.height - s.hollow_depth - rim_y, 0, 90, s.spacing);
  return outline;
}

// Wax has molten: the rim sinks towards +z, and has run down the wall.
Vec3 molten(const CandleShape& s, const OutlinePoint& point, float angle) {
  float radius = point.radius;
  float y = point.y;
  const float depth = s.height - y;
  const float near_rim = std::exp(-depth * depth / 30);
  y -= kSunk_mm * near_rim * (0.5f + 0.5f * std::sin(angle)) * (0.7f + 0.3f * std::sin(5 * angle));
  if (radius > s.radius - s.wall / 2) {
    for (const Run& run : kRuns) {
      const float off = std::remainder(angle - run.angle, 2 * std::numbers::pi_v<float>) * s.radius;
      const float ends = 1 / (1 + std::exp((depth - run.length_mm) * 1.8f));
      const float drop = 1 + 0.5f * std::exp(-(depth - run.length_mm + 1) * (depth - run.length_mm + 1));
      radius += run.bulge_mm * drop * ends * std::exp(-off * off / 1.6f) * std::min(1.0f, depth);
    }
  }
  return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

// Turns an outline that begins and ends on the axis; counter-clockwise from outside where it runs foot to top.
MeshData turned(const std::vector<OutlinePoint>& outline, int around,
                const std::function<Vec3(const OutlinePoint&, float angle)>& place) {
  MeshData mesh;
  const auto rings = static_cast<uint32_t>(outline.size() - 2);
  const auto n = static_cast<uint32_t>(around);
  mesh.positions.push_back({0, outline.front().y, 0});
  for (uint32_t ring = 0; ring < rings; ++ring) {
    for (uint32_t i = 0; i < n; ++i) {
      mesh.positions.push_back(
          place(outline[ring + 1], 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(n)));
    }
  }
  mesh.positions.push_back({0, outline.back().y, 0});
  const uint32_t last = 1 + rings * n;
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t next = (i + 1) % n;
    mesh.triangles.insert(mesh.triangles.end(), {0, 1 + i, 1 + next});
    for (uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const uint32_t a = 1 + ring * n;
      mesh.triangles.insert(mesh.triangles.end(), {a + i, a + n + i, a + n + next, a + i, a + n + next, a + next});
    }
    mesh.triangles.insert(mesh.triangles.end(), {last - n + i, last, last - n + next});
  }
  return mesh;
}

}  // namespace

MeshData candle(const CandleShape& shape) {
  const auto place = [&](const OutlinePoint& point, float angle) { return molten(shape, point, angle); };
  return turned(outline_of(shape), kAround, place);
}

MeshData wick(const CandleShape& shape) {
  const float foot = shape.height - shape.hollow_depth - 0.5f;
  std::vector<OutlinePoint> outline = {{0, foot}, {kWickRadius_mm, foot}};
  append_line(&outline, {kWickRadius_mm, foot + kWickHeight_mm}, shape.spacing);
  append_arc(&outline, {0, foot + kWickHeight_mm}, kWickRadius_mm, kWickRadius_mm, 0, 90, shape.spacing / 2);
  return turned(outline, 12, [](const OutlinePoint& point, float angle) {
    return Vec3{point.radius * std::cos(angle), point.y, point.radius * std::sin(angle)};
  });
}

Vec3 flame(const CandleShape& shape) { return {0, shape.height - shape.hollow_depth + kWickHeight_mm + 2, 0}; }

}  // namespace diaphane::gallery
