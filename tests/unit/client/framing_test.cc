#include "diaphane/framing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace diaphane {
namespace {

// Where `point` is in the image: -1..1 each way inside the frame, and how far in front of the eye. The plain definition
// of a pinhole camera, for cameras that look along z with y up.
struct Projected {
  double x;
  double y;
  double depth;
};

Projected project_along_z(const Camera& camera, const Vec3& point, double aspect) {
  const double towards = camera.target.z < camera.eye.z ? -1 : 1;
  const double depth = towards * (point.z - camera.eye.z);
  const double tangent = std::tan(camera.fov_y_deg * M_PI / 360);
  return {-towards * (point.x - camera.eye.x) / (depth * tangent * aspect),
          (point.y - camera.eye.y) / (depth * tangent), depth};
}

MeshData mesh_of(std::vector<Vec3> positions) { return {.positions = std::move(positions), .triangles = {0, 0, 0}}; }

TEST(Bounds, PlaceEveryMeshByItsTransform) {
  MeshData moved = mesh_of({{1, 1, 1}});
  moved.scene_from_mesh = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1};
  const std::vector<MeshData> meshes{mesh_of({{-1, 0, 0}, {0, 3, 0}}), moved};
  const absl::StatusOr<Bounds> bounds = bounds_of(meshes);
  ASSERT_TRUE(bounds.ok());
  EXPECT_EQ(bounds->lowest, (Vec3{-1, 0, 0}));
  EXPECT_EQ(bounds->highest, (Vec3{12, 22, 32}));
}

TEST(Bounds, RefuseNothingAndNotANumber) {
  EXPECT_EQ(bounds_of({}).status().code(), absl::StatusCode::kInvalidArgument);
  const std::vector<MeshData> meshes{mesh_of({{0, std::numeric_limits<float>::quiet_NaN(), 0}})};
  EXPECT_EQ(bounds_of(meshes).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(Extent, IsMeasuredAlongAnyDirection) {
  const std::vector<MeshData> meshes{mesh_of({{0, 0, 0}, {1, 1, 5}})};
  EXPECT_NEAR(extent_along(meshes, {0, 0, -3}).value(), 5, 1e-9);
  EXPECT_NEAR(extent_along(meshes, {1, 1, 0}).value(), std::sqrt(2), 1e-9);
  EXPECT_EQ(extent_along(meshes, {0, 0, 0}).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(Framing, KeepsEveryCornerInsideTheFrameAndFillsIt) {
  const Bounds bounds{{-3, 0, -1}, {1, 2, 4}};
  for (const float aspect : {0.5f, 1.f, 2.f}) {
    const Camera camera = frame_camera(bounds, {.aspect = aspect, .fill = 0.9f});
    double largest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 point{corner & 1 ? bounds.highest.x : bounds.lowest.x, corner & 2 ? bounds.highest.y : bounds.lowest.y,
                       corner & 4 ? bounds.highest.z : bounds.lowest.z};
      const Projected projected = project_along_z(camera, point, aspect);
      EXPECT_GT(projected.depth, 0);
      largest = std::max({largest, std::abs(projected.x), std::abs(projected.y)});
    }
    EXPECT_NEAR(largest, 0.9, 1e-4) << "aspect " << aspect;
  }
}

TEST(Framing, LooksFromTheFrontWhicheverWayIsUp) {
  const Bounds bounds{{-1, -1, -1}, {1, 1, 1}};
  const Camera y_up = frame_camera(bounds);
  EXPECT_GT(y_up.eye.z, 1);
  EXPECT_NEAR(y_up.eye.x, 0, 1e-6);
  const Camera z_up = frame_camera(bounds, {.up = {0, 0, 1}});
  EXPECT_LT(z_up.eye.y, -1);
  EXPECT_NEAR(z_up.eye.z, 0, 1e-6);
}

TEST(Framing, FramesASinglePoint) {
  const Camera camera = frame_camera({{5, 5, 5}, {5, 5, 5}});
  EXPECT_EQ(camera.target, (Vec3{5, 5, 5}));
  EXPECT_GT(camera.eye.z, 5.5);
}

TEST(KeyLight, StandsUpperLeftInFrontOfTheBody) {
  const Bounds bounds{{-1, -1, -1}, {1, 1, 1}};
  const PointLight light = key_light(bounds, frame_camera(bounds), 1);
  EXPECT_LT(light.position.x, -1);
  EXPECT_GT(light.position.y, 1);
  EXPECT_GT(light.position.z, 1);
}

TEST(KeyLight, LightsAWhiteWallAlikeAtEveryScale) {
  for (const double millimetres_per_unit : {0.001, 1.0, 1000.0}) {
    const Bounds bounds{{-1, -1, -1}, {1, 1, 1}};
    const PointLight light = key_light(bounds, frame_camera(bounds), millimetres_per_unit);
    const double distance_mm = std::hypot(light.position.x, light.position.y, light.position.z) * millimetres_per_unit;
    EXPECT_NEAR(light.intensity_w_sr.g / (distance_mm * distance_mm) / M_PI, kKeyRadiance, 1e-4);
    EXPECT_NEAR(distance_mm / millimetres_per_unit, 2.5 * std::sqrt(12), 1e-3);
  }
}

}  // namespace
}  // namespace diaphane
