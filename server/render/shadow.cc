#include "render/shadow.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "tbb/parallel_for.h"

namespace diaphane::render {
namespace {

constexpr size_t kPacket = 16;
constexpr int kDiscSamples = 16;
// Rays start this share of the scene's size off the facet, so that it does not shade itself.
constexpr float kOffset = 1e-5f;

/// A unit vector at right angles to `axis`.
glm::vec3 perpendicular(const glm::vec3& axis) {
  const glm::vec3 other = std::abs(axis.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(glm::cross(axis, other));
}

bool directional(const LightStorage& light) { return light.power.a != 0; }

int samples_of(const LightStorage& light) { return !directional(light) && light.shape.y > 0 ? kDiscSamples : 1; }

/// Where a ray of towards_sample() ends, in lengths of it.
float farthest(const LightStorage& light) { return directional(light) ? std::numeric_limits<float>::infinity() : 1.0f; }

/// To sample `index` of a light: its centre, or one of a spiral's points on the disc that it shows to `point_mm`.
glm::vec3 towards_sample(const LightStorage& light, const glm::vec3& point_mm, int index) {
  if (directional(light)) return glm::vec3(light.position_mm);
  const glm::vec3 to_centre = glm::vec3(light.position_mm) - point_mm;
  if (samples_of(light) == 1) return to_centre;
  constexpr float kGoldenAngle = 2.39996323f;
  const glm::vec3 axis = to_centre / std::max(glm::length(to_centre), 1e-12f);
  const glm::vec3 u = perpendicular(axis);
  const glm::vec3 v = glm::cross(axis, u);
  const float r = light.shape.y * std::sqrt((static_cast<float>(index) + 0.5f) / kDiscSamples);
  const float angle = static_cast<float>(index) * kGoldenAngle;
  return to_centre + r * (std::cos(angle) * u + std::sin(angle) * v);
}

struct Facet {
  glm::vec3 centroid_mm;
  glm::vec3 across;  ///< the outward normal, twice the area long
};

inline Facet facet_of(const geometry::PlacedShape& shape, const glm::uvec3& i) {
  const glm::vec3& a = shape.positions_mm[i.x];
  const glm::vec3& b = shape.positions_mm[i.y];
  const glm::vec3& c = shape.positions_mm[i.z];
  return {(a + b + c) * (1.0f / 3), glm::cross(b - a, c - a) * (shape.flipped ? -1.0f : 1.0f)};
}

}  // namespace

struct ShadowScene::Embree {
  struct Slot {
    RTCGeometry geometry = nullptr;
    size_t triangles = 0;
    size_t vertices = 0;
  };

  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  std::vector<Slot> slots;
  float offset_mm = 0;

  Embree() {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
  }
  ~Embree() {
    for (Slot& slot : slots) drop(slot);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  void drop(Slot& slot) {
    if (slot.geometry != nullptr) {
      rtcDetachGeometry(scene, static_cast<unsigned>(&slot - slots.data()));
      rtcReleaseGeometry(slot.geometry);
    }
    slot = {};
  }

  void resize(size_t count) {
    for (size_t i = count; i < slots.size(); ++i) drop(slots[i]);
    slots.resize(count);
  }

  /// A slot that had as many triangles and vertices is refitted.
  void set_mesh(size_t index, const ShadowCaster& caster) {
    Slot& slot = slots[index];
    const bool refit = slot.geometry != nullptr && slot.triangles == caster.triangles.size() &&
                       slot.vertices == caster.positions_mm.size();
    if (!refit) {
      drop(slot);
      slot = {rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE), caster.triangles.size(), caster.positions_mm.size()};
      rtcSetNewGeometryBuffer(slot.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                              slot.triangles);
      rtcSetNewGeometryBuffer(slot.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                              slot.vertices);
      rtcAttachGeometryByID(scene, slot.geometry, static_cast<unsigned>(index));
    }
    std::memcpy(rtcGetGeometryBufferData(slot.geometry, RTC_BUFFER_TYPE_INDEX, 0), caster.triangles.data(),
                caster.triangles.size_bytes());
    std::memcpy(rtcGetGeometryBufferData(slot.geometry, RTC_BUFFER_TYPE_VERTEX, 0), caster.positions_mm.data(),
                caster.positions_mm.size_bytes());
    rtcSetGeometryBuildQuality(slot.geometry, refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
    rtcUpdateGeometryBuffer(slot.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(slot.geometry);
  }
};

ShadowScene::ShadowScene() : embree_(std::make_unique<Embree>()) {}
ShadowScene::~ShadowScene() = default;

void ShadowScene::set_casters(std::span<const ShadowCaster> casters, const geometry::Bounds& bounds_mm) {
  casters_.assign(casters.begin(), casters.end());
  bounds_mm_ = bounds_mm;
  rays_ready_ = false;
}

void ShadowScene::prepare_rays() {
  if (rays_ready_) return;
  rays_ready_ = true;
  embree_->resize(casters_.size());
  for (size_t i = 0; i < casters_.size(); ++i) embree_->set_mesh(i, casters_[i]);
  rtcCommitScene(embree_->scene);
  const glm::vec3 extent = bounds_mm_.highest - bounds_mm_.lowest;
  embree_->offset_mm = kOffset * std::max({extent.x, extent.y, extent.z});
}

float ShadowScene::visibility_at(const LightStorage& light, const glm::vec3& point_mm, const glm::vec3& normal) const {
  const int samples = samples_of(light);
  float seen = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const glm::vec3 start = point_mm + embree_->offset_mm * normal;
    const glm::vec3 direction = towards_sample(light, start, sample);
    RTCRay ray{};
    ray.org_x = start.x, ray.org_y = start.y, ray.org_z = start.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tfar = farthest(light);
    ray.mask = ~0u;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_->scene, &context, &ray);
    seen += ray.tfar >= 0 ? 1.0f : 0.0f;
  }
  return seen / static_cast<float>(samples);
}

void ShadowScene::visibility(const LightStorage& light, std::span<const glm::uvec3> triangles,
                             const geometry::PlacedShape& shape, std::span<float> share) {
  if (!ShadowMap::serves(light, bounds_mm_)) {
    prepare_rays();
    trace(light, triangles, shape, share);
    return;
  }
  map_.draw(light, bounds_mm_, casters_);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, triangles.size(), 1024),
                    [&](const tbb::blocked_range<size_t>& range) {
                      for (size_t t = range.begin(); t != range.end(); ++t) {
                        const Facet facet = facet_of(shape, triangles[t]);
                        share[t] = map_.visibility_at(facet.centroid_mm, facet.across);
                      }
                    });
}

void ShadowScene::trace(const LightStorage& light, std::span<const glm::uvec3> triangles,
                        const geometry::PlacedShape& shape, std::span<float> share) const {
  const int samples = samples_of(light);
  const size_t packets = (triangles.size() + kPacket - 1) / kPacket;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, packets, 64), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t packet = range.begin(); packet != range.end(); ++packet) {
      const size_t first = packet * kPacket;
      const size_t count = std::min(kPacket, triangles.size() - first);
      glm::vec3 starts[kPacket];
      for (size_t i = 0; i < kPacket; ++i) {
        // Lanes without a triangle repeat the first one: Embree checks them all.
        const Facet facet = facet_of(shape, triangles[first + (i < count ? i : 0)]);
        const float length = glm::length(facet.across);
        starts[i] = facet.centroid_mm + (length > 0 ? embree_->offset_mm / length : 0.0f) * facet.across;
      }
      float seen[kPacket] = {};
      for (int sample = 0; sample < samples; ++sample) {
        alignas(64) RTCRay16 rays{};
        alignas(64) int valid[kPacket] = {};
        for (size_t i = 0; i < kPacket; ++i) {
          const glm::vec3 direction = towards_sample(light, starts[i], sample);
          valid[i] = i < count ? -1 : 0;
          rays.org_x[i] = starts[i].x, rays.org_y[i] = starts[i].y, rays.org_z[i] = starts[i].z;
          rays.dir_x[i] = direction.x, rays.dir_y[i] = direction.y, rays.dir_z[i] = direction.z;
          rays.tfar[i] = farthest(light);
          rays.mask[i] = ~0u;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded16(valid, embree_->scene, &context, &rays);
        for (size_t i = 0; i < count; ++i) seen[i] += rays.tfar[i] >= 0 ? 1.0f : 0.0f;
      }
      for (size_t i = 0; i < count; ++i) share[first + i] = seen[i] / static_cast<float>(samples);
    }
  });
}

}  // namespace diaphane::render
