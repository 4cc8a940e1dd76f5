// Six cells as pictures: the integral, the reference, where they differ, and what lies behind the largest differences.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "CLI/CLI.hpp"
#include "diffusion/kernel_table.h"
#include "encode/encode.h"
#include "geometry/creases.h"
#include "glm/geometric.hpp"
#include "render/gl_renderer.h"
#include "tests/support/cells.h"
#include "tests/support/error_parts.h"
#include "tests/support/views.h"

namespace diaphane {
namespace {

using nlohmann::json;

struct Shot {
  const char* mesh;
  const char* material;
  const char* light;
  glm::vec3 direction;  ///< of the camera
};
constexpr Shot kShots[] = {{"bunny", "marble", "front", {1, 1, 3}}, {"hand", "skin1", "back", {1, 1, 4}},
                           {"cup", "wholemilk", "two", {1, 2, 3}},  {"plate", "marble", "back", {1, 1, 3}},
                           {"cube", "ketchup", "front", {3, 2, 4}}, {"fertility", "skin1", "two", {1, 1, 3}}};

constexpr float kExtentMm = 20;
constexpr float kScaleEnd = 0.1f;  ///< the error at which the colour scale ends

/// Where a pixel lies, the first that applies.
enum Place { kSilhouette, kCrease, kTerminator, kElsewhere, kPlaces };
constexpr const char* kPlaceNames[] = {"silhouette", "crease", "terminator", "elsewhere"};

/// The largest part of a pixel's error; of what lies at a silhouette nothing can be said.
enum Part { kInterpolation, kNearField, kFarField, kParts };
constexpr const char* kPartNames[] = {"interpolation", "near field", "far field"};

struct Pictures {
  uint32_t size_px;
  std::vector<glm::vec3> integral, reference;
  testing::Sights sights;
  std::vector<float> error;  ///< worst channel's |difference| over its mean; 0 outside the body
  std::vector<size_t> body;  ///< pixels
  glm::vec3 mean{0};
};

base::Image8 blank(uint32_t width_px, uint32_t height_px) {
  return {width_px, height_px, std::vector<uint8_t>(size_t{4} * width_px * height_px, 255)};
}

void put(base::Image8& image, size_t pixel, const glm::vec3& colour) {
  for (int c = 0; c < 3; ++c) {
    image.rgba[4 * pixel + static_cast<size_t>(c)] =
        static_cast<uint8_t>(std::lround(255 * std::clamp(colour[c], 0.0f, 1.0f)));
  }
}

/// sRGB after scaling.
base::Image8 photograph(const std::vector<glm::vec3>& radiance, uint32_t size_px, float scale) {
  base::Image8 image = blank(size_px, size_px);
  for (size_t i = 0; i < radiance.size(); ++i) {
    glm::vec3 v = scale * radiance[i];
    for (int c = 0; c < 3; ++c) v[c] = v[c] <= 0.0031308f ? 12.92f * v[c] : 1.055f * std::pow(v[c], 1 / 2.4f) - 0.055f;
    put(image, i, v);
  }
  return image;
}

/// Black, red, yellow, white in equal steps of 0..kScaleEnd.
glm::vec3 error_colour(float error) {
  const float t = 3 * error / kScaleEnd;
  return {t, t - 1, t - 2};
}

/// Errors on grey, above a bar of the scale.
base::Image8 error_picture(const Pictures& pictures) {
  constexpr uint32_t kBar_px = 8;
  const uint32_t n = pictures.size_px;
  base::Image8 image = blank(n, n + kBar_px);
  for (size_t i = 0; i < size_t{n} * n; ++i) put(image, i, glm::vec3(0.3f));
  for (const size_t i : pictures.body) put(image, i, error_colour(pictures.error[i]));
  for (size_t i = size_t{n} * n; i < size_t{n} * (n + kBar_px); ++i) {
    put(image, i, error_colour(kScaleEnd * static_cast<float>(i % n) / static_cast<float>(n)));
  }
  return image;
}

void write(const base::Image8& image, const std::filesystem::path& path) {
  const absl::StatusOr<std::string> bytes = encode::encode_png(image);
  if (!bytes.ok()) throw std::runtime_error(std::string(bytes.status().message()));
  std::ofstream(path, std::ios::binary) << *bytes;
}

Pictures take(const testing::Cell& cell, const Shot& shot, uint32_t size_px, render::FrameRenderer& renderer) {
  const float radius_mm = testing::radius_of(cell.mesh);
  const testing::View view = testing::view_from(shot.direction, radius_mm, size_px);
  const auto scene = testing::make_scene(cell.mesh, cell.material, cell.lights);
  const auto render = [&](render::Technique technique) {
    return testing::radiance_of(renderer, testing::unshadowed_request(scene, view, technique));
  };
  const testing::MeshRays rays(cell.mesh);
  Pictures pictures{size_px, render(render::Technique::kIntegral), render(render::Technique::kReference),
                    testing::trace(cell.mesh, rays, view)};
  pictures.error.assign(pictures.reference.size(), 0);
  const glm::vec3 nothing(0);
  for (size_t i = 0; i < pictures.reference.size(); ++i) {
    if (pictures.reference[i] == nothing && pictures.integral[i] == nothing) continue;
    pictures.body.push_back(i);
    pictures.mean += pictures.reference[i];
  }
  pictures.mean /= static_cast<float>(pictures.body.size());
  for (const size_t i : pictures.body) {
    const glm::vec3 off = glm::abs(pictures.integral[i] - pictures.reference[i]) / pictures.mean;
    pictures.error[i] = std::max({off.x, off.y, off.z});
  }
  return pictures;
}

/// Creases are what lies within a pixel or a smooth distance of one, terminators where light comes within 6° of
/// grazing.
class Places {
 public:
  Places(const testing::Cell& cell, float pixel_mm)
      : lights_(cell.lights),
        reach_mm_(std::max(pixel_mm, smooth_mm(cell.material))),
        creases_(**geometry::build_topology(cell.mesh.positions_mm, cell.mesh.triangles), cell.mesh.positions_mm,
                 2 * reach_mm_) {}

  Place of(const testing::Sights& sights, size_t pixel) const {
    if (!sights.is_inside(pixel)) return kSilhouette;
    const testing::Sight& sight = *sights.of_pixel[pixel];
    if (creases_.distance_mm(sight.position_mm) <= reach_mm_) return kCrease;
    for (const testing::PointLight& light : lights_) {
      const float cosine = glm::dot(sight.normal, glm::normalize(light.position_mm - sight.position_mm));
      if (std::abs(cosine) < 0.1f) return kTerminator;
    }
    return kElsewhere;
  }

 private:
  static float smooth_mm(const optics::Coefficients& material) {
    const glm::vec3 z = diffusion::smooth_distance_mm(optics::make_profile(material));
    return std::min({z.x, z.y, z.z});
  }

  std::vector<testing::PointLight> lights_;
  float reach_mm_;
  geometry::CreaseField creases_;
};

/// How many pixels owe most of their error to each part.
std::array<size_t, kParts> count_parts(const testing::Cell& cell, const testing::Sights& sights,
                                       const std::vector<size_t>& pixels) {
  std::vector<glm::vec3> points_mm, normals;
  for (const size_t i : pixels) {
    points_mm.push_back(sights.of_pixel[i]->position_mm);
    normals.push_back(sights.of_pixel[i]->normal);
  }
  std::array<size_t, kParts> counts{};
  for (const testing::ErrorParts& parts : testing::error_parts(cell, diffusion::Quality::kFine, points_mm, normals)) {
    const std::array<float, kParts> sizes = {glm::length(parts.interpolation), glm::length(parts.near_field),
                                             glm::length(parts.far_field)};
    ++counts[static_cast<size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin())];
  }
  return counts;
}

json measure(const Shot& shot, uint32_t size_px, const std::filesystem::path& folder, render::FrameRenderer& renderer) {
  const testing::Cell cell = testing::make_cell(shot.mesh, shot.material, shot.light, kExtentMm);
  const Pictures pictures = take(cell, shot, size_px, renderer);
  const std::string name = std::string(shot.mesh) + "_" + shot.material + "_" + shot.light;
  const float scale = 0.45f / std::max({pictures.mean.x, pictures.mean.y, pictures.mean.z});
  write(photograph(pictures.integral, size_px, scale), folder / (name + "_integral.png"));
  write(photograph(pictures.reference, size_px, scale), folder / (name + "_reference.png"));
  write(error_picture(pictures), folder / (name + "_error.png"));

  std::vector<glm::vec3> values, truth;
  std::vector<size_t> worst_first = pictures.body;
  for (const size_t i : pictures.body) {
    values.push_back(pictures.integral[i]);
    truth.push_back(pictures.reference[i]);
  }
  std::sort(worst_first.begin(), worst_first.end(),
            [&](size_t a, size_t b) { return pictures.error[a] > pictures.error[b]; });
  const size_t past = (worst_first.size() + 999) / 1000;
  const Places places(cell, pictures.sights.pixel_mm);
  std::array<size_t, kPlaces> past_of_place{}, all_of_place{};
  std::vector<size_t> past_inside;
  float worst_inside = 0;
  for (size_t k = 0; k < worst_first.size(); ++k) {
    const Place place = places.of(pictures.sights, worst_first[k]);
    ++all_of_place[place];
    if (place != kSilhouette) worst_inside = std::max(worst_inside, pictures.error[worst_first[k]]);
    if (k >= past) continue;
    ++past_of_place[place];
    if (place != kSilhouette) past_inside.push_back(worst_first[k]);
  }
  const auto past_of_part = count_parts(cell, pictures.sights, past_inside);
  const glm::vec3 rms = testing::relative_rms(values, truth);
  const float percentile = pictures.error[worst_first[past]], worst = pictures.error[worst_first[0]];
  std::printf("%-22s %6zu | %5.2f %5.2f %5.2f | %6.2f %6.2f %6.2f | %3zu:", name.c_str(), worst_first.size(),
              100 * rms.x, 100 * rms.y, 100 * rms.z, 100 * percentile, 100 * worst_inside, 100 * worst, past);
  json row = {{"cell", name},
              {"pixels", worst_first.size()},
              {"relative_rms", {rms.x, rms.y, rms.z}},
              {"percentile_99_9", percentile},
              {"largest_off_silhouettes", worst_inside},
              {"largest", worst},
              {"past_percentile", past}};
  for (int k = 0; k < kPlaces; ++k) {
    std::printf(" %3zu (%4.1f %%)", past_of_place[k],
                100 * static_cast<double>(all_of_place[k]) / static_cast<double>(worst_first.size()));
    row["places"][kPlaceNames[k]] = {{"past_percentile", past_of_place[k]}, {"pixels", all_of_place[k]}};
  }
  std::printf(" |");
  for (int k = 0; k < kParts; ++k) {
    std::printf(" %3zu", past_of_part[k]);
    row["parts"][kPartNames[k]] = past_of_part[k];
  }
  std::printf("\n");
  std::fflush(stdout);
  return row;
}

int run(uint32_t size_px, const std::string& folder, const std::string& json_path) {
  auto renderer = render::make_gl_renderer({.warm_all = false});
  if (!renderer.ok()) throw std::runtime_error(std::string(renderer.status().message()));
  std::filesystem::create_directories(folder);
  std::printf(
      "integral (fine) against reference, outgoing radiance of all pixels of the body, unshadowed; pictures in %s.\n"
      "In per cent of the mean: RMS by channel; 99.9th percentile, largest off silhouettes and largest of the worst\n"
      "channel's difference. Then the pixels past that percentile by where they lie, next to the share of all pixels\n"
      "there: at a silhouette or jump (a neighbour is elsewhere), at a crease (within a pixel or a smooth distance), "
      "at\n"
      "a light's terminator (|cos| < 0.1), elsewhere; and, silhouettes left out, by the largest part of their error:\n"
      "linear interpolation of B, near field, far field. Error pictures: black, red, yellow, white at 0, %.1f, %.1f "
      "and\n"
      "%.0f %% of the mean.\n",
      folder.c_str(), 100 * kScaleEnd / 3, 200 * kScaleEnd / 3, 100 * kScaleEnd);
  std::printf("%-22s %6s | %5s %5s %5s | %6s %6s %6s | past: %s, %s, %s, %s | interpolation, near, far\n", "cell",
              "pixels", "R", "G", "B", "99.9th", "inside", "all", kPlaceNames[0], kPlaceNames[1], kPlaceNames[2],
              kPlaceNames[3]);
  json rows = json::array();
  for (const Shot& shot : kShots) rows.push_back(measure(shot, size_px, folder, **renderer));
  if (!json_path.empty()) std::ofstream(json_path) << json{{"size_px", size_px}, {"cells", rows}}.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  uint32_t size_px = 256;
  std::string folder = "build/bench/pictures", json_path;
  CLI::App app("Six cells as pictures: the integral, the reference, and where they differ");
  app.add_option("--size", size_px, "pixels a side")->check(CLI::Range(16, 2048));
  app.add_option("--folder", folder, "for the pictures");
  app.add_option("--json", json_path, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(size_px, folder, json_path);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_pictures: %s\n", error.what());
    return 1;
  }
}
