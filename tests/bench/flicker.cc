// Whether the integral's error moves: a morph of the bunny to its bounding sphere under a static camera.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "CLI/CLI.hpp"
#include "fmt/format.h"
#include "glm/geometric.hpp"
#include "render/gl_renderer.h"
#include "tests/support/cells.h"
#include "tests/support/views.h"

namespace diaphane {
namespace {

using nlohmann::json;

struct Settings {
  std::string mesh = "bunny", material = "marble", light = "front";
  diffusion::Quality quality = diffusion::Quality::kFine;
  int frames = 60;
  int every = 1;  ///< of the pairs of frames, the ones looked at
  uint32_t size_px = 160;
  size_t pixels = 1500;
  std::string cache, json_path;
};

constexpr float kExtentMm = 20;
constexpr int kQuarters = 4;
constexpr float kBar = 0.01f;  ///< of the mean: more is seen as flicker

/// Both pictures at the chosen pixels; a pixel that is outside or at a silhouette in this frame is not `inside`.
struct Frame {
  std::vector<glm::vec3> integral, reference;
  std::vector<bool> inside;
  glm::vec3 mean{0};
};

/// mix(p, R p/|p|, t): what the demo's morph does.
testing::Mesh morphed(const testing::Mesh& mesh, float radius_mm, float t) {
  testing::Mesh pose = mesh;
  for (glm::vec3& p : pose.positions_mm) p *= 1 + t * (radius_mm / std::max(glm::length(p), 1e-6f) - 1);
  testing::compute_normals(pose);
  return pose;
}

/// Pixels that some frame sees the body in, chosen evenly, the same for all frames.
std::vector<size_t> choose_pixels(const testing::Sights& largest, size_t count) {
  std::vector<size_t> pixels;
  for (size_t i = 0; i < largest.of_pixel.size(); ++i) {
    if (largest.of_pixel[i]) pixels.push_back(i);
  }
  std::shuffle(pixels.begin(), pixels.end(), std::mt19937(1));
  pixels.resize(std::min(pixels.size(), count));
  return pixels;
}

/// B of brute force; kept in `path` from run to run where that is not empty.
std::vector<glm::vec3> truth_of(const testing::Cell& cell, const testing::Mesh& pose,
                                const std::vector<glm::vec3>& points_mm, const std::vector<glm::vec3>& normals,
                                const std::string& path) {
  std::vector<glm::vec3> truth(points_mm.size());
  const auto bytes = static_cast<std::streamsize>(truth.size() * sizeof(glm::vec3));
  if (!path.empty()) {
    std::ifstream file(path, std::ios::binary);
    if (file && file.read(reinterpret_cast<char*>(truth.data()), bytes)) return truth;
  }
  truth = testing::true_radiosity(pose, cell.material, cell.irradiance, points_mm, normals);
  if (!path.empty()) std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(truth.data()), bytes);
  return truth;
}

Frame measure(const testing::Cell& cell, const testing::Mesh& pose, const testing::Sights& sights,
              const std::vector<glm::vec3>& picture, const std::vector<size_t>& pixels, const std::string& path) {
  Frame frame;
  std::vector<size_t> slots;
  std::vector<glm::vec3> points_mm, normals;
  frame.integral.resize(pixels.size());
  frame.reference.resize(pixels.size());
  for (size_t k = 0; k < pixels.size(); ++k) {
    frame.inside.push_back(sights.is_inside(pixels[k]));
    if (!frame.inside.back()) continue;
    slots.push_back(k);
    points_mm.push_back(sights.of_pixel[pixels[k]]->position_mm);
    normals.push_back(sights.of_pixel[pixels[k]]->normal);
    frame.integral[k] = picture[pixels[k]];
  }
  const std::vector<glm::vec3> truth = truth_of(cell, pose, points_mm, normals, path);
  for (size_t i = 0; i < slots.size(); ++i) {
    const float cosine = sights.of_pixel[pixels[slots[i]]]->cosine;
    frame.reference[slots[i]] =
        optics::fresnel_transmittance(cell.material.refractive_index, cosine) / std::numbers::pi_v<float> * truth[i];
    frame.mean += frame.reference[slots[i]] / static_cast<float>(slots.size());
  }
  return frame;
}

/// |Δ integral − Δ reference| over the mean, worst channel, of every pixel that is inside in both frames.
void compare(const Frame& before, const Frame& after, std::vector<float>& flicker) {
  for (size_t k = 0; k < after.inside.size(); ++k) {
    if (!before.inside[k] || !after.inside[k]) continue;
    const glm::vec3 off =
        glm::abs((after.integral[k] - before.integral[k]) - (after.reference[k] - before.reference[k])) / after.mean;
    flicker.push_back(std::max({off.x, off.y, off.z}));
  }
}

/// Of sorted values, at least one, the share below kBar.
double share_below(const std::vector<float>& sorted) {
  const auto below = std::lower_bound(sorted.begin(), sorted.end(), kBar) - sorted.begin();
  return static_cast<double>(below) / static_cast<double>(sorted.size());
}

int run(const Settings& settings) {
  auto renderer = render::make_gl_renderer({.warm_all = false});
  if (!renderer.ok()) throw std::runtime_error(std::string(renderer.status().message()));
  const testing::Cell cell = testing::make_cell(settings.mesh, settings.material, settings.light, kExtentMm);
  const float radius_mm = testing::radius_of(cell.mesh);
  const testing::View view = testing::view_from({1, 1, 3}, radius_mm, settings.size_px);
  const auto rest = testing::make_scene(cell.mesh, cell.material, cell.lights);

  std::vector<size_t> pixels;
  std::vector<float> flicker;
  std::array<std::vector<float>, kQuarters> of_quarter;
  Frame before;
  // Backwards, so that the first frame is the sphere, which covers every pixel that will be looked at.
  for (int i = settings.frames - 1; i >= 0; --i) {
    const bool starts_pair = i < settings.frames - 1 && i % settings.every == 0;
    const bool ends_pair = i > 0 && (i - 1) % settings.every == 0;
    if (!starts_pair && !ends_pair && !pixels.empty()) continue;
    const float t = static_cast<float>(i) / static_cast<float>(std::max(settings.frames - 1, 1));
    const testing::Mesh pose = morphed(cell.mesh, radius_mm, t);
    const testing::Sights sights = testing::trace(pose, testing::MeshRays(pose), view);
    if (pixels.empty()) pixels = choose_pixels(sights, settings.pixels);
    const auto picture =
        testing::radiance_of(**renderer, testing::unshadowed_request(testing::with_pose(*rest, pose), view,
                                                                     render::Technique::kIntegral, settings.quality));
    const std::string path = settings.cache.empty() ? ""
                                                    : fmt::format("{}/{}.{}.{}.{}of{}.{}px.{}", settings.cache,
                                                                  settings.mesh, settings.material, settings.light, i,
                                                                  settings.frames, settings.size_px, pixels.size());
    Frame after = measure(cell, pose, sights, picture, pixels, path);
    if (starts_pair) {
      const size_t first = flicker.size();
      compare(before, after, flicker);
      auto& quarter = of_quarter[static_cast<size_t>(kQuarters * i / (settings.frames - 1))];
      quarter.insert(quarter.end(), flicker.begin() + static_cast<ptrdiff_t>(first), flicker.end());
    }
    before = std::move(after);
  }
  std::sort(flicker.begin(), flicker.end());
  const auto count = static_cast<double>(flicker.size());
  const double below = share_below(flicker);
  const auto quantile = [&](double q) { return flicker[static_cast<size_t>(q * (count - 1))]; };
  std::printf(
      "%s in %s, light %s, morphs to its bounding sphere in %d frames, %u² pixels, static camera, unshadowed:\n"
      "|Δ integral − Δ reference| from frame to frame, outgoing radiance, worst channel, over the frame's mean, at "
      "the\n"
      "same %zu pixels in every frame where they are off silhouettes in both (%zu pairs):\n"
      "below %.0f %%: %.3f %%; median %.3f %%, 99th percentile %.3f %%, 99.9th %.3f %%, largest %.3f %%\n",
      settings.mesh.c_str(), settings.material.c_str(), settings.light.c_str(), settings.frames, settings.size_px,
      pixels.size(), flicker.size(), 100 * kBar, 100 * below, 100 * quantile(0.5), 100 * quantile(0.99),
      100 * quantile(0.999), 100 * flicker.back());
  json quarters = json::array();
  for (std::vector<float>& quarter : of_quarter) {
    if (quarter.empty()) continue;
    std::sort(quarter.begin(), quarter.end());
    quarters.push_back(share_below(quarter));
    std::printf("quarter %d of the morph: below %.0f %%: %.3f %%\n", static_cast<int>(&quarter - of_quarter.data()) + 1,
                100 * kBar, 100 * share_below(quarter));
  }
  if (!settings.json_path.empty()) {
    std::ofstream(settings.json_path) << json{{"frames", settings.frames},       {"size_px", settings.size_px},
                                              {"pairs", flicker.size()},         {"share_below_one_per_cent", below},
                                              {"share_of_quarters", quarters},   {"median", quantile(0.5)},
                                              {"percentile_99", quantile(0.99)}, {"percentile_99_9", quantile(0.999)},
                                              {"largest", flicker.back()}}
                                             .dump(1)
                                      << "\n";
  }
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  using diaphane::diffusion::Quality;
  diaphane::Settings settings;
  const std::map<std::string, Quality> qualities = {
      {"draft", Quality::kDraft}, {"normal", Quality::kNormal}, {"fine", Quality::kFine}};
  CLI::App app("Whether the integral's error moves from frame to frame of a deforming body");
  app.add_option("--mesh", settings.mesh, "bunny hand goathead fertility torus cup plate cube");
  app.add_option("--material", settings.material, "a preset");
  app.add_option("--light", settings.light, "front back two");
  app.add_option("--quality", settings.quality)->transform(CLI::CheckedTransformer(qualities));
  app.add_option("--frames", settings.frames)->check(CLI::Range(2, 10000));
  app.add_option("--every", settings.every, "of the pairs of frames, one in so many")->check(CLI::Range(1, 10000));
  app.add_option("--size", settings.size_px, "pixels a side")->check(CLI::Range(16, 2048));
  app.add_option("--pixels", settings.pixels, "that the reference is computed for")->check(CLI::Range(1, 1000000));
  app.add_option("--cache", settings.cache, "folder that keeps brute force's answers from run to run");
  app.add_option("--json", settings.json_path, "file for the figures");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_flicker: %s\n", error.what());
    return 1;
  }
}
