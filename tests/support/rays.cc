#include "tests/support/rays.h"

#include <embree3/rtcore.h>

#include <algorithm>

namespace diaphane::testing {
namespace {

/// Clear of the surface, yet thinner than anything of interest.
constexpr float kOffsetMm = 1e-3f;
/// Farther than any mesh here is wide.
constexpr float kFarMm = 1e4f;

RTCRay ray_from(const glm::vec3& origin, const glm::vec3& way, float near) {
  RTCRay ray{};
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = way.x, ray.dir_y = way.y, ray.dir_z = way.z;
  ray.tnear = near;
  ray.tfar = 1;
  ray.mask = 0xffffffffu;
  return ray;
}

}  // namespace

struct MeshRays::Scene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

MeshRays::MeshRays(const Mesh& mesh) : scene_(std::make_unique<Scene>()) {
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                           mesh.positions_mm.size());
  std::copy(mesh.positions_mm.begin(), mesh.positions_mm.end(), static_cast<glm::vec3*>(vertices));
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                          mesh.triangles.size());
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<glm::uvec3*>(indices));
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

MeshRays::~MeshRays() = default;

bool MeshRays::sees(const glm::vec3& from_mm, const glm::vec3& to_mm) const {
  RTCRay ray = ray_from(from_mm, to_mm - from_mm, 1e-4f);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene, &context, &ray);
  return ray.tfar > 0;
}

std::optional<SurfacePoint> MeshRays::first_hit(const glm::vec3& from_mm, const glm::vec3& way_mm) const {
  RTCRayHit hit{};
  hit.ray = ray_from(from_mm, way_mm, 0);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return SurfacePoint{hit.hit.primID, {1 - hit.hit.u - hit.hit.v, hit.hit.u, hit.hit.v}};
}

std::optional<SurfacePoint> MeshRays::first_along(const glm::vec3& from_mm, const glm::vec3& direction) const {
  return first_hit(from_mm, kFarMm * direction);
}

std::optional<SurfacePoint> MeshRays::locate(const glm::vec3& point_mm, const glm::vec3& normal) const {
  return first_hit(point_mm + kOffsetMm * normal, -2 * kOffsetMm * normal);
}

}  // namespace diaphane::testing
