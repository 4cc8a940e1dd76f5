#include "placement.h"

#include <algorithm>

#include "fmt/format.h"
#include "status.h"

namespace diaphane::cli {
namespace {

constexpr double kDefaultHeightMm = 50;

double largest_side(std::span<const MeshData> meshes) {
  const absl::StatusOr<Bounds> bounds = bounds_of(meshes);
  if (!bounds.ok()) return 0;
  return std::max({bounds->highest.x - bounds->lowest.x, bounds->highest.y - bounds->lowest.y,
                   bounds->highest.z - bounds->lowest.z});
}

}  // namespace

void FileUnits::add(const std::optional<double>& unit) {
  ++meshes;
  if (!unit) return;
  agree = agree && (meshes_with_unit == 0 || *unit == millimetres_per_unit);
  ++meshes_with_unit;
  millimetres_per_unit = *unit;
}

std::optional<double> FileUnits::known() const {
  if (stated) return stated;
  if (agree && meshes > 0 && meshes_with_unit == meshes) return millimetres_per_unit;
  return std::nullopt;
}

absl::StatusOr<Unit> choose_unit(const RenderArguments& arguments, const FileUnits& units,
                                 std::span<const MeshData> meshes, const Vec3& up) {
  if (arguments.millimetres_per_unit) return Unit{*arguments.millimetres_per_unit};
  if (!arguments.height_mm) {
    if (const std::optional<double> known = units.known()) return Unit{*known};
  }

  const absl::StatusOr<double> height = extent_along(meshes, up);
  if (!height.ok()) return usage_error("--up", std::string(height.status().message()));
  if (arguments.height_mm) {
    if (*height > 0) return Unit{*arguments.height_mm / *height};
    return usage_error("--height-mm", "the meshes have no height along the up vector; give --mm-per-unit");
  }
  const double size = *height > 0 ? *height : largest_side(meshes);
  return Unit{size > 0 ? kDefaultHeightMm / size : 1,
              fmt::format("no size given, so the height is taken as {} mm; see --height-mm and --mm-per-unit",
                          kDefaultHeightMm)};
}

Camera choose_camera(const RenderArguments& arguments, const std::optional<Camera>& from_file, const Bounds& bounds,
                     const Size& size) {
  FramingOptions framing{.aspect =
                             static_cast<float>(size.width_px) / static_cast<float>(std::max(size.height_px, 1u))};
  if (arguments.up) framing.up = *arguments.up;
  if (arguments.fov_y_deg) framing.fov_y_deg = *arguments.fov_y_deg;
  Camera camera = from_file ? *from_file : frame_camera(bounds, framing);
  if (arguments.target && !arguments.eye && !from_file) {
    const Vec3& target = *arguments.target;
    camera.eye = {camera.eye.x + target.x - camera.target.x, camera.eye.y + target.y - camera.target.y,
                  camera.eye.z + target.z - camera.target.z};
  }
  if (arguments.eye) camera.eye = *arguments.eye;
  if (arguments.target) camera.target = *arguments.target;
  if (arguments.up) camera.up = *arguments.up;
  if (arguments.fov_y_deg) camera.fov_y_deg = *arguments.fov_y_deg;
  return camera;
}

}  // namespace diaphane::cli
