// How far the integral and the paper's technique are from brute force: mesh × material × light.
#include "tests/bench/accuracy.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "CLI/CLI.hpp"
#include "diffusion/simd_level.h"
#include "glm/exponential.hpp"
#include "render/gl_renderer.h"
#include "tests/support/error_parts.h"

namespace diaphane::bench {
namespace {

using nlohmann::json;

struct Table {
  std::vector<std::string> meshes = testing::kCellMeshes;
  std::vector<std::string> materials = testing::kCellMaterials;
  std::vector<std::string> lights = testing::kCellLights;
  std::string technique;  ///< empty: both
  bool explain = false;
  AccuracySettings settings;
  std::string json_path;
};

json to_json(const Errors& errors, const Samples& samples) {
  const auto list = [](const glm::vec3& v) { return json{v.x, v.y, v.z}; };
  return {{"relative_rms", list(errors.relative_rms)},
          {"worst_point_over_mean", errors.worst_over_mean},
          {"worst_point_mm", list(samples.at_mm[errors.worst_point])},
          {"worst_point_over_own", errors.worst_over_own},
          {"worst_own_point_mm", list(samples.at_mm[errors.worst_own_point])},
          {"worst_own_point_over_mean", errors.own_over_mean},
          {"brightness", list(errors.brightness)},
          {"fitted_relative_rms", list(errors.fitted_rms)}};
}

json named(const testing::Cell& cell, json row) {
  row["mesh"] = cell.mesh_name;
  row["material"] = cell.material_name;
  row["light"] = cell.light_name;
  return row;
}

void print_name(const testing::Cell& cell) {
  std::printf("%-10s %-10s %-6s", cell.mesh_name.c_str(), cell.material_name.c_str(), cell.light_name.c_str());
}

void print_errors(const Errors& errors) {
  std::printf(" | %6.2f %6.2f %6.2f | %6.1f %6.1f %8.3f", 100 * errors.relative_rms.x, 100 * errors.relative_rms.y,
              100 * errors.relative_rms.z, 100 * errors.worst_over_mean, 100 * errors.worst_over_own,
              errors.own_over_mean);
}

void print_parts(const char* of, int channel, float scale, const testing::ErrorParts& parts) {
  std::printf("    %s: %c: interpolation %.2f, near %.2f, far %.2f\n", of, "RGB"[channel],
              100 * parts.interpolation[channel] / scale, 100 * parts.near_field[channel] / scale,
              100 * parts.far_field[channel] / scale);
}

/// What errors are made of: the worst points', and the RMS of some.
void explain(const testing::Cell& cell, const AccuracySettings& settings, const Samples& samples,
             const Errors& errors) {
  std::vector<size_t> points = {errors.worst_point, errors.worst_own_point};
  for (size_t i = 0; i < std::min<size_t>(200, samples.at_mm.size()); ++i) points.push_back(i);
  std::vector<glm::vec3> at_mm, normals;
  for (const size_t i : points) {
    at_mm.push_back(samples.at_mm[i]);
    normals.push_back(samples.normals[i]);
  }
  const auto parts = testing::error_parts(cell, settings.quality, at_mm, normals);
  const int c = errors.worst_point_channel, own = errors.worst_own_point_channel;
  print_parts("worst over mean", c, errors.mean[c], parts[0]);
  print_parts("worst over own", own, samples.truth[points[1]][own], parts[1]);
  testing::ErrorParts squares;
  for (size_t i = 2; i < parts.size(); ++i) {
    squares.interpolation += parts[i].interpolation * parts[i].interpolation;
    squares.near_field += parts[i].near_field * parts[i].near_field;
    squares.far_field += parts[i].far_field * parts[i].far_field;
  }
  const auto count = static_cast<float>(parts.size() - 2);
  const testing::ErrorParts rms{glm::sqrt(squares.interpolation / count), glm::sqrt(squares.near_field / count),
                                glm::sqrt(squares.far_field / count)};
  for (int k = 0; k < 3; ++k) print_parts("RMS over mean", k, errors.mean[k], rms);
}

/// Prints and gives the median and the worst of the cells' worst channels.
json summary(const char* what, std::vector<float> errors, json cells) {
  std::sort(errors.begin(), errors.end());
  const float median = errors[errors.size() / 2], worst = errors.back();
  std::printf("%s: worst channel of %zu cells: median %.2f %%, worst %.2f %% (%s)\n\n", what, errors.size(),
              100 * median, 100 * worst, diffusion::simd_level().c_str());
  return {{"median", median}, {"worst", worst}, {"cells", std::move(cells)}};
}

template <class Measure>
void for_cells(const Table& table, const Measure& measure) {
  for (const std::string& mesh : table.meshes) {
    for (const std::string& material : table.materials) {
      for (const std::string& light : table.lights) {
        measure(testing::make_cell(mesh, material, light, table.settings.extent_mm));
        std::fflush(stdout);
      }
    }
  }
}

json integral_table(const Table& table) {
  std::printf(
      "integral: radiosity B at %zu random points of the surface, interpolated between vertices of the mesh as the\n"
      "server splits it, against brute force at those points; unshadowed. In per cent: RMS difference over mean by\n"
      "channel; largest difference of any point and channel over the channel's mean, and over the point's own B where\n"
      "that is above 0.01 of the mean (and what it is). s/z: vertex spacing over smooth distance, mean and largest.\n",
      table.settings.points);
  std::printf("%-10s %-10s %-6s %9s %5s %5s | %6s %6s %6s | %6s %6s %8s\n", "mesh", "material", "light", "triangles",
              "s/z", "worst", "R", "G", "B", "max", "own", "own/mean");
  std::vector<float> errors;
  json rows = json::array();
  for_cells(table, [&](const testing::Cell& cell) {
    Spacing spacing;
    const Samples samples = measure_integral(cell, table.settings, spacing);
    const Errors cell_errors = errors_of(samples);
    print_name(cell);
    std::printf(" %9zu %5.2f %5.2f", spacing.triangles, spacing.mean, spacing.largest);
    print_errors(cell_errors);
    std::printf("\n");
    if (table.explain) explain(cell, table.settings, samples, cell_errors);
    errors.push_back(cell_errors.worst_channel());
    json row = named(cell, to_json(cell_errors, samples));
    row["triangles"] = spacing.triangles;
    row["spacing_over_smooth_distance"] = {{"mean", spacing.mean}, {"largest", spacing.largest}};
    rows.push_back(std::move(row));
  });
  return summary("integral", std::move(errors), std::move(rows));
}

json paper_table(const Table& table) {
  auto renderer = render::make_gl_renderer({.warm_all = false});
  if (!renderer.ok()) throw std::runtime_error(std::string(renderer.status().message()));
  std::printf(
      "paper: pixels of six views at 128×128, %zu off silhouettes, as radiosity B = πL/Ft, against brute force at the\n"
      "points that they see; unshadowed, five taps a side, faces of 256, gain 1. In per cent, as above; then its mean\n"
      "over the true one (smallest channel), the RMS left when each channel is scaled to fit best (worst), and the "
      "RMS\n"
      "of the integral's pixels at the same places (worst).\n",
      table.settings.points);
  std::printf("%-10s %-10s %-6s | %6s %6s %6s | %6s %6s %8s | %6s %6s | %8s\n", "mesh", "material", "light", "R", "G",
              "B", "max", "own", "own/mean", "mean", "fitted", "integral");
  std::vector<float> errors, integral_errors;
  json rows = json::array();
  for_cells(table, [&](const testing::Cell& cell) {
    const PixelSamples samples = measure_paper(cell, table.settings, **renderer);
    const Errors paper = errors_of(samples.paper), integral = errors_of(samples.integral);
    print_name(cell);
    print_errors(paper);
    const glm::vec3& mean = paper.brightness;
    std::printf(" | %6.2f %6.2f | %8.2f\n", 100 * std::min({mean.x, mean.y, mean.z}),
                100 * Errors::worst_of(paper.fitted_rms), 100 * integral.worst_channel());
    errors.push_back(paper.worst_channel());
    integral_errors.push_back(integral.worst_channel());
    json row = named(cell, to_json(paper, samples.paper));
    row["integral"] = to_json(integral, samples.integral);
    rows.push_back(std::move(row));
  });
  json result = summary("paper", std::move(errors), std::move(rows));
  result["integral"] = summary("integral at the same pixels", std::move(integral_errors), json::array());
  return result;
}

int run(const Table& table) {
  json result = {{"simd_level", diffusion::simd_level()}, {"points", table.settings.points}};
  if (table.technique != "paper") result["integral"] = integral_table(table);
  if (table.technique != "integral") result["paper"] = paper_table(table);
  if (!table.json_path.empty()) std::ofstream(table.json_path) << result.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace diaphane::bench

int main(int argc, char** argv) {
  using diaphane::diffusion::Quality;
  diaphane::bench::Table table;
  auto& settings = table.settings;
  const std::map<std::string, Quality> qualities = {
      {"draft", Quality::kDraft}, {"normal", Quality::kNormal}, {"fine", Quality::kFine}};
  CLI::App app("Errors against brute force: RMS difference over mean, by channel");
  app.add_option("--technique", table.technique, "one of the two alone")->check(CLI::IsMember({"integral", "paper"}));
  app.add_option("--meshes", table.meshes, "bunny hand goathead fertility torus cup plate cube")->delimiter(',');
  app.add_option("--materials", table.materials, "presets")->delimiter(',');
  app.add_option("--lights", table.lights, "front back two, or environments (see bench environment)")->delimiter(',');
  app.add_option("--quality", settings.quality, "of the integral")->transform(CLI::CheckedTransformer(qualities));
  app.add_option("--openings", settings.openings, "GROUPS,VERTICES in place of a quality, at points")
      ->delimiter(',')
      ->expected(2);
  app.add_option("--spacings", settings.spacings, "SMALLEST,LARGEST of the splitting in smooth distances, at points")
      ->delimiter(',')
      ->expected(2);
  app.add_option("--points", settings.points, "points or pixels a cell")->check(CLI::Range(1, 1000000));
  app.add_option("--extent-mm", settings.extent_mm, "longest side of each mesh")->check(CLI::PositiveNumber);
  app.add_flag("--explain", table.explain, "what errors are made of: linear interpolation, near field, far field");
  app.add_option("--cache", settings.cache, "folder that keeps brute force's answers from run to run");
  app.add_option("--json", table.json_path, "file for the tables");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::bench::run(table);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
    return 1;
  }
}
