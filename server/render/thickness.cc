#include "render/thickness.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "tbb/blocked_range.h"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

/// Of the mesh's extent: what a ray skips where it starts, and after a surface that it enters by.
constexpr float kOffset = 1e-5f;
/// Surfaces in a row by which a ray may enter (parts of the body in each other) before it counts as lost.
constexpr int kMostEntered = 8;
constexpr int kTries = 3;
/// Tangent of the angle between the outer rays and the normal: light that crosses d spreads over about that.
constexpr float kSlope = 0.6f;
constexpr float kNone = std::numeric_limits<float>::infinity();

}  // namespace

struct ThicknessField::Embree {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = nullptr;
  std::span<const glm::uvec3> triangles;
  std::vector<glm::vec3> positions_mm;
  float winding = 1;
  float offset_mm = 0;

  Embree() {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
  }
  ~Embree() {
    drop();
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  void drop() {
    if (geometry == nullptr) return;
    rtcDetachGeometry(scene, 0);
    rtcReleaseGeometry(geometry);
    geometry = nullptr;
  }
};

ThicknessField::ThicknessField() : embree_(std::make_unique<Embree>()) {}
ThicknessField::~ThicknessField() = default;

void ThicknessField::update(std::span<const glm::uvec3> triangles, const geometry::PlacedShape& shape) {
  Embree& e = *embree_;
  const bool refit = e.geometry != nullptr && e.triangles.data() == triangles.data() &&
                     e.triangles.size() == triangles.size() && e.positions_mm.size() == shape.positions_mm.size();
  e.triangles = triangles;
  e.positions_mm = shape.positions_mm;
  e.winding = shape.flipped ? -1.0f : 1.0f;
  if (!refit) {
    e.drop();
    e.geometry = rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetNewGeometryBuffer(e.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                            triangles.size());
    rtcSetNewGeometryBuffer(e.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                            e.positions_mm.size());
    std::memcpy(rtcGetGeometryBufferData(e.geometry, RTC_BUFFER_TYPE_INDEX, 0), triangles.data(),
                triangles.size_bytes());
    rtcAttachGeometryByID(e.scene, e.geometry, 0);
  }
  std::memcpy(rtcGetGeometryBufferData(e.geometry, RTC_BUFFER_TYPE_VERTEX, 0), e.positions_mm.data(),
              e.positions_mm.size() * sizeof(glm::vec3));
  rtcSetGeometryBuildQuality(e.geometry, refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
  rtcUpdateGeometryBuffer(e.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(e.geometry);
  rtcCommitScene(e.scene);
  glm::vec3 lowest(std::numeric_limits<float>::max()), highest(-std::numeric_limits<float>::max());
  for (const glm::vec3& p : e.positions_mm) {
    lowest = glm::min(lowest, p);
    highest = glm::max(highest, p);
  }
  const glm::vec3 extent = highest - lowest;
  e.offset_mm = kOffset * std::max({extent.x, extent.y, extent.z});
}

OppositePoint ThicknessField::trace(const glm::vec3& start_mm, const glm::vec3& direction,
                                    const glm::vec3& normal) const {
  const Embree& e = *embree_;
  RTCRayHit ray{};
  ray.ray.org_x = start_mm.x, ray.ray.org_y = start_mm.y, ray.ray.org_z = start_mm.z;
  ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
  ray.ray.mask = ~0u;
  ray.ray.tnear = e.offset_mm;
  for (int entered = 0; entered < kMostEntered; ++entered) {
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(e.scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const glm::uvec3& t = e.triangles[ray.hit.primID];
    const glm::vec3& a = e.positions_mm[t.x];
    const glm::vec3 facet = e.winding * glm::cross(e.positions_mm[t.y] - a, e.positions_mm[t.z] - a);
    if (glm::dot(facet, direction) > 0) {
      return {-ray.ray.tfar * glm::dot(direction, normal), -glm::dot(facet, normal) / glm::length(facet),
              ray.hit.primID, ray.hit.u, ray.hit.v};
    }
    ray.ray.tnear = ray.ray.tfar + e.offset_mm;
  }
  return {};
}

std::vector<OppositePoint> ThicknessField::find(std::span<const glm::vec3> points_mm,
                                                std::span<const glm::vec3> normals) const {
  std::vector<OppositePoint> found(kRays * points_mm.size());
  const auto find_one = [&](size_t i) {
    const glm::vec3& normal = normals[i];
    const glm::vec3 across = std::abs(normal.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 x = glm::normalize(glm::cross(normal, across)), y = glm::cross(normal, x);
    for (size_t ray = 0; ray < kRays; ++ray) {
      const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(ray) / (kRays - 1);
      const float slope = ray == 0 ? 0 : kSlope;
      const glm::vec3 direction = glm::normalize(slope * (std::cos(turn) * x + std::sin(turn) * y) - normal);
      OppositePoint& opposite = found[kRays * i + ray];
      for (int tries = 0; tries < kTries && opposite.thickness_mm == kNone; ++tries) {
        const float beside = 7 * embree_->offset_mm * static_cast<float>(tries);
        opposite = trace(points_mm[i] + beside * x, direction, normal);
      }
    }
  };
  tbb::parallel_for(tbb::blocked_range<size_t>(0, points_mm.size(), 256), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) find_one(i);
  });
  return found;
}

size_t ThicknessField::bytes() const {
  // Embree says of its trees nothing; about 100 bytes a triangle.
  return embree_->positions_mm.size() * 2 * sizeof(glm::vec3) + embree_->triangles.size() * 112;
}

}  // namespace diaphane::render
