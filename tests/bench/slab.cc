// What thin slabs give back: the integral, the integral with slab correction, and a random walk.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "tests/support/cells.h"
#include "tests/support/lit_slab.h"
#include "tests/support/random_walk.h"

namespace diaphane {
namespace {

struct Settings {
  std::vector<std::string> materials = {"marble", "wholemilk", "skin1"};
  std::vector<float> thicknesses = {0.25f, 0.5f, 1, 2, 4, 8, 16};
  int walks = 200000;
  std::string json_path;
};

nlohmann::json measure(const std::string& name, const optics::Coefficients& material, int channel, float thickness,
                       int walks) {
  const float extinction = material.absorption_mm[channel] + material.reduced_scattering_mm[channel];
  const double albedo = material.reduced_scattering_mm[channel] / extinction;
  const testing::LitSlab slab = testing::light_slab(material, thickness / extinction);
  const testing::WalkedSlab walked = testing::walk_slab(albedo, material.refractive_index, thickness, walks);
  const auto reflected = [&](const testing::FacePair& faces) { return double{faces.reflected[channel]}; };
  const auto transmitted = [&](const testing::FacePair& faces) { return double{faces.transmitted[channel]}; };
  const double right = walked.reflected + walked.transmitted;
  const double said = reflected(slab.integral) + transmitted(slab.integral);
  const double corrected = reflected(slab.corrected) + transmitted(slab.corrected);
  std::printf("%-12s %c %6.4f %6.2f %7.2f | %6.3f %6.3f %6.3f | %6.3f %6.3f %6.3f %+6.1f | %6.3f %6.3f %6.3f %+6.1f\n",
              name.c_str(), "RGB"[channel], albedo, thickness, thickness / extinction, walked.reflected,
              walked.transmitted, right, reflected(slab.integral), transmitted(slab.integral), said,
              100 * (said / right - 1), reflected(slab.corrected), transmitted(slab.corrected), corrected,
              100 * (corrected / right - 1));
  std::fflush(stdout);
  return {{"material", name},
          {"channel", std::string(1, "RGB"[channel])},
          {"reduced_albedo", albedo},
          {"thickness_mean_free_paths", thickness},
          {"walk", {{"reflected", walked.reflected}, {"transmitted", walked.transmitted}}},
          {"integral", {{"reflected", reflected(slab.integral)}, {"transmitted", transmitted(slab.integral)}}},
          {"corrected", {{"reflected", reflected(slab.corrected)}, {"transmitted", transmitted(slab.corrected)}}}};
}

int run(const Settings& settings) {
  std::printf(
      "Of the light that enters a slab evenly through one face, shares that leave after scattering: through that face\n"
      "(R), through the other (T), and both. By a random walk of %d photons that enter along the normal; by the "
      "surface\n"
      "integral at fine; by it with slab correction. d: thickness in mean free paths; off: R + T against the walk, "
      "%%.\n",
      settings.walks);
  std::printf("%-12s   %6s %6s %7s | %6s %6s %6s | %6s %6s %6s %6s | %6s %6s %6s %6s\n", "material", "albedo", "d",
              "mm", "R", "T", "walk", "R", "T", "integ.", "off", "R", "T", "corr.", "off");
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& name : settings.materials) {
    const optics::Coefficients material = testing::cell_material(name);
    for (int channel = 0; channel < 3; channel += 2) {
      for (const float thickness : settings.thicknesses) {
        rows.push_back(measure(name, material, channel, thickness, settings.walks));
      }
    }
  }
  if (!settings.json_path.empty()) {
    std::ofstream(settings.json_path) << nlohmann::json{{"walks", settings.walks}, {"rows", rows}}.dump(1) << "\n";
  }
  return 0;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("What thin slabs give back, by thickness");
  app.add_option("--materials", settings.materials, "presets, or preset+profile")->delimiter(',');
  app.add_option("--thicknesses", settings.thicknesses, "in mean free paths")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("--walks", settings.walks, "photons a slab")->check(CLI::Range(100, 100000000));
  app.add_option("--json", settings.json_path, "file for the figures");
  CLI11_PARSE(app, argc, argv);
  try {
    return diaphane::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_slab: %s\n", error.what());
    return 1;
  }
}
