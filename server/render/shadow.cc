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
};

ShadowScene::ShadowScene() : embree_(std::make_unique<Embree>()) {}
ShadowScene::~ShadowScene() = default;

void ShadowScene::resize(size_t count) {
  for (size_t i = count; i < embree_->slots.size(); ++i) embree_->drop(embree_->slots[i]);
  embree_->slots.resize(count);
}

void ShadowScene::set_mesh(size_t slot_index, std::span<const glm::uvec3> triangles,
                           std::span<const glm::vec3> positions_mm) {
  if (slot_index >= embree_->slots.size()) embree_->slots.resize(slot_index + 1);
  Embree::Slot& slot = embree_->slots[slot_index];
  const bool refit =
      slot.geometry != nullptr && slot.triangles == triangles.size() && slot.vertices == positions_mm.size();
  if (!refit) {
    embree_->drop(slot);
    slot = {rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE), triangles.size(), positions_mm.size()};
    rtcSetNewGeometryBuffer(slot.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                            triangles.size());
    rtcSetNewGeometryBuffer(slot.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                            positions_mm.size());
    rtcAttachGeometryByID(embree_->scene, slot.geometry, static_cast<unsigned>(slot_index));
  }
  std::memcpy(rtcGetGeometryBufferData(slot.geometry, RTC_BUFFER_TYPE_INDEX, 0), triangles.data(),
              triangles.size_bytes());
  std::memcpy(rtcGetGeometryBufferData(slot.geometry, RTC_BUFFER_TYPE_VERTEX, 0), positions_mm.data(),
              positions_mm.size_bytes());
  rtcSetGeometryBuildQuality(slot.geometry, refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
  rtcUpdateGeometryBuffer(slot.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(slot.geometry);
}

void ShadowScene::commit() {
  rtcCommitScene(embree_->scene);
  RTCBounds bounds;
  rtcGetSceneBounds(embree_->scene, &bounds);
  const float size =
      std::max({bounds.upper_x - bounds.lower_x, bounds.upper_y - bounds.lower_y, bounds.upper_z - bounds.lower_z});
  embree_->offset_mm = kOffset * size;
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

void ShadowScene::visibility(const LightStorage& light, std::span<const glm::vec3> points_mm,
                             std::span<const glm::vec3> facet_normals, std::span<float> share) const {
  const int samples = samples_of(light);
  const size_t packets = (points_mm.size() + kPacket - 1) / kPacket;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, packets, 64), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t packet = range.begin(); packet != range.end(); ++packet) {
      const size_t first = packet * kPacket;
      const size_t count = std::min(kPacket, points_mm.size() - first);
      float seen[kPacket] = {};
      for (int sample = 0; sample < samples; ++sample) {
        alignas(64) RTCRay16 rays{};
        alignas(64) int valid[kPacket] = {};
        for (size_t i = 0; i < kPacket; ++i) {
          // Lanes without a point repeat the first one: Embree checks them all.
          const size_t point = first + (i < count ? i : 0);
          const glm::vec3 start = points_mm[point] + embree_->offset_mm * facet_normals[point];
          const glm::vec3 direction = towards_sample(light, start, sample);
          valid[i] = i < count ? -1 : 0;
          rays.org_x[i] = start.x, rays.org_y[i] = start.y, rays.org_z[i] = start.z;
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
