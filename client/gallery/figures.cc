#include "gallery/figures.h"

#include <cmath>
#include <numbers>

#include "diaphane/framing.h"
#include "fmt/format.h"

namespace diaphane::gallery {

RenderSettings by_paper(const PaperSettings& paper) {
  RenderSettings settings;
  settings.technique = Technique::kPaper;
  settings.paper = paper;
  return settings;
}

RenderSettings by_integral() {
  RenderSettings settings;
  settings.technique = Technique::kIntegral;
  settings.quality = Quality::kFine;
  return settings;
}

absl::StatusOr<Still> portrait(const MeshData& mesh, const Material& material, double height_mm, uint32_t size_px) {
  const absl::StatusOr<Bounds> bounds = bounds_of({&mesh, 1});
  if (!bounds.ok()) return bounds.status();
  const double height = bounds->highest.y - bounds->lowest.y;
  if (!(height > 0)) return absl::InvalidArgumentError("mesh: must have a height, got none");
  Still still;
  still.bodies = {{mesh, material}};
  still.millimetres_per_unit = height_mm / height;
  still.camera = frame_camera(*bounds, {.aspect = 1});
  still.size = {size_px, size_px};
  return still;
}

absl::Status add_lamp(const Vec3& from, float heights, Still* still) {
  const absl::StatusOr<Bounds> bounds = bounds_of({&still->bodies[0].mesh, 1});
  if (!bounds.ok()) return bounds.status();
  const float distance = heights * (bounds->highest.y - bounds->lowest.y);
  const float step = distance / std::hypot(from.x, from.y, from.z);
  const Vec3& c = still->camera.target;
  const double distance_mm = distance * still->millimetres_per_unit;
  const auto intensity = static_cast<float>(kKeyRadiance * std::numbers::pi * distance_mm * distance_mm);
  still->lights.emplace_back(
      PointLight{{c.x + step * from.x, c.y + step * from.y, c.z + step * from.z}, {intensity, intensity, intensity}});
  return absl::OkStatus();
}

std::string stops(double exposure_ev) { return fmt::format("{:+.1f} EV", exposure_ev); }

}  // namespace diaphane::gallery
