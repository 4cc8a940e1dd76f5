#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>

#include "diffusion/kernel_table.h"
#include "geometry/subdivide.h"
#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "tests/bench/accuracy.h"
#include "tests/support/error_parts.h"
#include "tests/support/views.h"

namespace diaphane::bench {
namespace {

using testing::Mesh;

float smallest(const glm::vec3& v) { return std::min({v.x, v.y, v.z}); }

std::vector<glm::vec3> truth_of(const testing::Cell& cell, const std::vector<glm::vec3>& points_mm,
                                const std::vector<glm::vec3>& normals, const AccuracySettings& settings,
                                const char* kind) {
  const std::string path = settings.cache + "/" + cell.mesh_name + "." + cell.material_name + "." + cell.light_name +
                           "." + kind + std::to_string(points_mm.size());
  std::vector<glm::vec3> truth(points_mm.size());
  const auto bytes = static_cast<std::streamsize>(truth.size() * sizeof(glm::vec3));
  if (!settings.cache.empty()) {
    std::ifstream file(path, std::ios::binary);
    if (file && file.read(reinterpret_cast<char*>(truth.data()), bytes)) return truth;
  }
  truth = testing::true_radiosity(cell.mesh, cell.material, cell.irradiance, points_mm, normals);
  if (!settings.cache.empty())
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(truth.data()), bytes);
  return truth;
}

Mesh subdivided(const Mesh& mesh, float smallest_mm, float largest_mm) {
  const auto fine =
      *geometry::subdivide(*geometry::build_topology(mesh.positions_mm, mesh.triangles), mesh.positions_mm,
                           {.smallest_spacing_mm = smallest_mm, .largest_spacing_mm = largest_mm});
  Mesh result{mesh.positions_mm, mesh.normals, fine.topology->triangles};
  geometry::extend_positions(fine.parents, result.positions_mm);
  geometry::extend_normals(fine.parents, result.normals);
  return result;
}

Spacing spacing_of(const diffusion::SurfaceTopology& topology, const Mesh& mesh, float smooth_mm) {
  std::vector<double> areas(topology.slot_count, 0);
  for (const glm::uvec3& t : topology.triangles) {
    const double area = 0.5 * glm::length(glm::cross(mesh.positions_mm[t.y] - mesh.positions_mm[t.x],
                                                     mesh.positions_mm[t.z] - mesh.positions_mm[t.x]));
    for (int k = 0; k < 3; ++k) areas[topology.slot_of_vertex[t[k]]] += area / 3;
  }
  Spacing spacing{.triangles = mesh.triangles.size()};
  double total = 0;
  for (size_t first = 0; first < areas.size(); first += 16) {
    const size_t count = std::min<size_t>(16, areas.size() - first);
    double sum = 0, largest = 0;
    for (size_t i = first; i < first + count; ++i) {
      sum += areas[i];
      largest = std::max(largest, areas[i]);
    }
    const double s = std::sqrt(0.5 * (sum / static_cast<double>(count) + largest)) / smooth_mm;
    spacing.largest = std::max(spacing.largest, s);
    spacing.mean += s * sum;
    total += sum;
  }
  spacing.mean /= total;
  return spacing;
}

struct Pixel {
  size_t view, index;
};

/// As many pixels as asked for, or all that are inside; the same every time.
std::vector<Pixel> choose_pixels(const std::vector<testing::Sights>& views, size_t count) {
  std::vector<Pixel> pixels;
  for (size_t v = 0; v < views.size(); ++v) {
    for (size_t i = 0; i < views[v].of_pixel.size(); ++i) {
      if (views[v].is_inside(i)) pixels.push_back({v, i});
    }
  }
  std::shuffle(pixels.begin(), pixels.end(), std::mt19937(1));
  pixels.resize(std::min(pixels.size(), count));
  return pixels;
}

}  // namespace

Samples measure_integral(const testing::Cell& cell, const AccuracySettings& settings, Spacing& spacing) {
  const float z = smallest(diffusion::smooth_distance_mm(optics::make_profile(cell.material)));
  const Mesh fine = settings.spacings.size() == 2
                        ? subdivided(cell.mesh, settings.spacings[0] * z, settings.spacings[1] * z)
                        : testing::as_served(cell.mesh, cell.material, settings.quality);
  diffusion::DipoleIntegral integral(
      diffusion::build_surface_topology(*geometry::build_topology(fine.positions_mm, fine.triangles)));
  const diffusion::Openings openings = settings.openings.size() == 2
                                           ? diffusion::Openings{settings.openings[0], settings.openings[1]}
                                           : diffusion::openings_of(settings.quality, cell.material);
  const std::vector<glm::vec3> radiosity = testing::integral_radiosity(integral, fine, cell, openings);
  spacing = spacing_of(integral.topology(), fine, z);

  Samples samples;
  std::vector<glm::vec3> shading_normals;
  const testing::MeshRays rays(fine);
  for (const testing::SurfacePoint& point : testing::random_points(cell.mesh, settings.points, 1)) {
    const glm::uvec3& t = cell.mesh.triangles[point.triangle];
    const std::vector<glm::vec3>& p = cell.mesh.positions_mm;
    samples.at_mm.push_back(testing::interpolate(cell.mesh, p, point));
    samples.normals.push_back(glm::normalize(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x])));
    shading_normals.push_back(glm::normalize(testing::interpolate(cell.mesh, cell.mesh.normals, point)));
    const auto found = rays.locate(samples.at_mm.back(), samples.normals.back());
    if (!found) throw std::runtime_error("a point of the surface was not found on the finer surface");
    samples.values.push_back(testing::interpolate(fine, radiosity, *found));
  }
  samples.truth = truth_of(cell, samples.at_mm, shading_normals, settings, "points");
  return samples;
}

PixelSamples measure_paper(const testing::Cell& cell, const AccuracySettings& settings,
                           render::FrameRenderer& renderer) {
  constexpr glm::vec3 kDirections[] = {{5, 2, 1}, {-5, 1, 2}, {1, 5, 2}, {2, -5, 1}, {2, 1, 5}, {1, 2, -5}};
  constexpr uint32_t kSize_px = 128;
  const float radius_mm = testing::radius_of(cell.mesh);
  const auto scene = testing::make_scene(cell.mesh, cell.material, cell.lights);
  const testing::MeshRays rays(cell.mesh);
  std::vector<testing::Sights> sights;
  std::vector<std::vector<glm::vec3>> paper, integral;
  for (const glm::vec3& direction : kDirections) {
    const testing::View view = testing::view_from(direction, radius_mm, kSize_px);
    sights.push_back(testing::trace(cell.mesh, rays, view));
    paper.push_back(testing::radiance_of(
        renderer, testing::unshadowed_request(scene, view, render::Technique::kPaper, settings.quality)));
    integral.push_back(testing::radiance_of(
        renderer, testing::unshadowed_request(scene, view, render::Technique::kIntegral, settings.quality)));
  }
  PixelSamples samples;
  std::vector<glm::vec3> normals;
  for (const Pixel& pixel : choose_pixels(sights, settings.points)) {
    const testing::Sight& sight = *sights[pixel.view].of_pixel[pixel.index];
    const float leaving =
        std::numbers::pi_v<float> / optics::fresnel_transmittance(cell.material.refractive_index, sight.cosine);
    samples.paper.at_mm.push_back(sight.position_mm);
    normals.push_back(sight.normal);
    samples.paper.values.push_back(leaving * paper[pixel.view][pixel.index]);
    samples.integral.values.push_back(leaving * integral[pixel.view][pixel.index]);
  }
  samples.integral.at_mm = samples.paper.at_mm;
  samples.paper.truth = samples.integral.truth = truth_of(cell, samples.paper.at_mm, normals, settings, "pixels");
  return samples;
}

Errors errors_of(const Samples& samples) {
  constexpr float kDim = 0.01f;
  Errors errors{.relative_rms = testing::relative_rms(samples.values, samples.truth)};
  glm::dvec3 values(0), truth(0), squares(0), products(0);
  for (size_t i = 0; i < samples.truth.size(); ++i) {
    const glm::dvec3 v(samples.values[i]), t(samples.truth[i]);
    values += v, truth += t, squares += v * v, products += v * t;
  }
  errors.brightness = glm::vec3(values / truth);
  std::vector<glm::vec3> fitted = samples.values;
  for (glm::vec3& b : fitted) b *= glm::vec3(products / glm::max(squares, glm::dvec3(1e-300)));
  errors.fitted_rms = testing::relative_rms(fitted, samples.truth);
  errors.mean = glm::vec3(truth / static_cast<double>(samples.truth.size()));
  const glm::vec3& mean = errors.mean;
  for (size_t i = 0; i < samples.truth.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float own = samples.truth[i][c], off = std::abs(samples.values[i][c] - own);
      if (off > errors.worst_over_mean * mean[c]) {
        errors.worst_over_mean = off / mean[c];
        errors.worst_point = i;
        errors.worst_point_channel = c;
      }
      if (own > kDim * mean[c] && off > errors.worst_over_own * own) {
        errors.worst_over_own = off / own;
        errors.worst_own_point = i;
        errors.worst_own_point_channel = c;
        errors.own_over_mean = own / mean[c];
      }
    }
  }
  return errors;
}

}  // namespace diaphane::bench
