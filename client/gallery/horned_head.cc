#include "gallery/horned_head.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace diaphane::gallery {
namespace {

constexpr float kHornLength = 1.3f;
constexpr float kHornWidth = 0.14f;  // radians, seen from the middle
constexpr float kHornBend = 0.35f;   // radians, at the tip
constexpr float kReach = 0.6f;       // radians around a horn from which vertices are drawn towards it
constexpr float kHornFrom = 1.45f;   // distance from the middle
constexpr float kSkullTo = 1.1f;

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator*(float s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
float length(const Vec3& a) { return std::sqrt(dot(a, a)); }
Vec3 unit(const Vec3& a) { return (1 / length(a)) * a; }
float angle_between(const Vec3& a, const Vec3& b) { return std::acos(std::clamp(dot(a, b), -1.0f, 1.0f)); }

// The horn of the side where x has that sign: its root's direction.
Vec3 horn_root(float side) { return unit({0.62f * side, 0.8f, 0.1f}); }

// Bumps and hollows of the skull, each around a direction.
struct Feature {
  Vec3 direction;
  float height;
  float width;  // radians
};
constexpr Feature kFeatures[] = {
    {{0.36f, 0.12f, 0.92f}, -0.24f, 0.17f}, {{-0.36f, 0.12f, 0.92f}, -0.24f, 0.17f},  // eyes
    {{0, -0.16f, 1}, 0.36f, 0.13f},                                                   // nose
    {{0.32f, 0.42f, 0.87f}, 0.14f, 0.2f},   {{-0.32f, 0.42f, 0.87f}, 0.14f, 0.2f},    // brows
    {{0.12f, -0.5f, 0.86f}, -0.12f, 0.11f}, {{-0.12f, -0.5f, 0.86f}, -0.12f, 0.11f},  // mouth
    {{0, -0.85f, 0.6f}, 0.18f, 0.24f},                                                // chin
    {{1, 0.12f, 0}, 0.42f, 0.14f},          {{-1, 0.12f, 0}, 0.42f, 0.14f}};          // ears

MeshData sphere_of_triangles(int levels) {
  const float g = std::numbers::phi_v<float>;
  MeshData mesh;
  for (const Vec3& p : {Vec3{-1, g, 0},
                        {1, g, 0},
                        {-1, -g, 0},
                        {1, -g, 0},
                        {0, -1, g},
                        {0, 1, g},
                        {0, -1, -g},
                        {0, 1, -g},
                        {g, 0, -1},
                        {g, 0, 1},
                        {-g, 0, -1},
                        {-g, 0, 1}}) {
    mesh.positions.push_back(unit(p));
  }
  mesh.triangles = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                    3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [entry, made] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.positions.size()));
      if (made) mesh.positions.push_back(unit(mesh.positions[a] + mesh.positions[b]));
      return entry->second;
    };
    std::vector<uint32_t> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
      const uint32_t a = mesh.triangles[i];
      const uint32_t b = mesh.triangles[i + 1];
      const uint32_t c = mesh.triangles[i + 2];
      const uint32_t ab = middle(a, b);
      const uint32_t bc = middle(b, c);
      const uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

// Draws directions near a horn's root towards it, so that the horn has vertices enough.
Vec3 drawn_together(const Vec3& direction, const Vec3& root) {
  const float angle = angle_between(direction, root);
  if (angle >= kReach || angle < 1e-6f) return direction;
  const float nearer = kReach * std::pow(angle / kReach, 1.6f);
  const Vec3 sideways = unit(direction + (-dot(direction, root)) * root);
  return unit(std::cos(nearer) * root + std::sin(nearer) * sideways);
}

Vec3 sculpted(const Vec3& given) {
  const float side = given.x < 0 ? -1.0f : 1.0f;
  const Vec3 root = horn_root(side);
  const Vec3 direction = drawn_together(given, root);
  float distance = 1 / length({direction.x / 0.82f, direction.y / 1.0f, direction.z / 0.9f});
  for (const Feature& feature : kFeatures) {
    const float angle = angle_between(direction, unit(feature.direction)) / feature.width;
    distance += feature.height * std::exp(-angle * angle);
  }
  const float rise = std::exp(-std::pow(angle_between(direction, root) / kHornWidth, 1.3f));
  distance += kHornLength * rise;
  // Bent inward and up, about the axis that the head looks along, more towards the tip.
  const float turn = side * kHornBend * rise * rise;
  const Vec3 p = distance * direction;
  return {p.x * std::cos(turn) - p.y * std::sin(turn), p.x * std::sin(turn) + p.y * std::cos(turn), p.z};
}

}  // namespace

MeshData horned_head(int levels) {
  MeshData mesh = sphere_of_triangles(levels);
  for (Vec3& position : mesh.positions) position = sculpted(position);
  return mesh;
}

bool on_horn(const Vec3& position) { return position.y > 0 && length(position) > kHornFrom; }

bool on_skull(const Vec3& position) { return length(position) < kSkullTo; }

}  // namespace diaphane::gallery
