// The paper's figures, all materials and all techniques as one page.
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "CLI/CLI.hpp"
#include "diaphane/readers.h"
#include "fmt/format.h"
#include "gallery/figures.h"
#include "gallery/morph.h"

namespace {

using namespace diaphane::gallery;
namespace fs = std::filesystem;

constexpr char kIntroduction[] =
    "What Benmounah, Jolivet and Ghazanfarpour show in \"Real-time rendering of deformable translucent objects\", "
    "made again by their technique (paper) and by the integral over the whole surface (integral), with what was "
    "measured. Radiance is measured on linear frames; exposures only turn them into pictures. `./dev gallery` makes "
    "this page.";

absl::Status run(const fs::path& folder, const fs::path& mesh, const std::string& address, FigureOptions options) {
  const absl::StatusOr<diaphane::LoadedFile> file = diaphane::read_mesh_file(mesh);
  if (!file.ok()) return file.status();
  options.mesh = merged(file->meshes);
  const absl::StatusOr<Studio> studio = Studio::open(address);
  if (!studio.ok()) return studio.status();
  std::vector<Section> sections;
  for (const auto figure : {figure_kernels, figure_candle, figure_opaque, figure_terms, figure_morph,
                            figure_environment, figure_textures, figure_materials, figure_colors, figure_techniques}) {
    absl::StatusOr<Section> section = figure(*studio, options);
    if (!section.ok()) return section.status();
    if (isatty(STDERR_FILENO) != 0) std::cerr << section->title << "\n";
    sections.push_back(*std::move(section));
  }
  return write_page(folder, "Diaphane: gallery", kIntroduction, sections);
}

}  // namespace

int main(int argc, char** argv) {
  fs::path folder;
  fs::path mesh;
  std::string address;
  FigureOptions options;
  CLI::App app{"The paper's figures, all materials and all techniques as one page."};
  app.add_option("MESH", mesh, "A body with thick and thin parts, such as the bunny")->required();
  app.add_option("OUTDIR", folder, "Takes index.html, its pictures, and figures.json with what was measured")
      ->required();
  app.add_option("--server", address, "HOST:PORT or unix:PATH (default: a private server)");
  app.add_option("--size", options.size_px, "Of most pictures, in pixels")->check(CLI::Range(32u, 1024u));
  app.add_option("--reference-size", options.reference_px, "Of those that the reference makes")
      ->check(CLI::Range(16u, 512u));
  app.add_option("--head-levels", options.head_levels, "How finely the horned head is made")->check(CLI::Range(3, 7));
  CLI11_PARSE(app, argc, argv);
  std::error_code code;
  fs::create_directories(folder, code);
  const absl::Status status = code ? absl::InternalError(fmt::format("{}: {}", folder.string(), code.message()))
                                   : run(folder, mesh, address, options);
  if (!status.ok()) std::cerr << "diaphane-gallery: " << std::string(status.message()) << "\n";
  if (status.ok()) std::cout << (folder / "index.html").string() << "\n";
  return status.ok() ? 0 : 1;
}
