// The page's sections, one function each: what is shown, how it was made, and what was measured.
#pragma once

#include "absl/status/statusor.h"
#include "diaphane/mesh_data.h"
#include "gallery/page.h"
#include "gallery/studio.h"

namespace diaphane::gallery {

struct FigureOptions {
  MeshData mesh;                ///< in its own units; the body of every figure that needs no other
  uint32_t size_px = 320;       ///< of most pictures, square
  uint32_t reference_px = 256;  ///< of those by the reference technique
  int head_levels = 6;          ///< fineness of the horned head
};

/// Fig. 6: kernels of 3×3 to 6×6 taps, each with its histogram.
absl::StatusOr<Section> figure_kernels(const Studio& studio, const FigureOptions& options);
/// Fig. 7: a red candle lit by its flame.
absl::StatusOr<Section> figure_candle(const Studio& studio, const FigureOptions& options);
/// Fig. 8: translucent and opaque.
absl::StatusOr<Section> figure_opaque(const Studio& studio, const FigureOptions& options);
/// Fig. 9: the local term, the global term, and both.
absl::StatusOr<Section> figure_terms(const Studio& studio, const FigureOptions& options);
/// Fig. 10: a morph to the bounding sphere, lit from behind.
absl::StatusOr<Section> figure_morph(const Studio& studio, const FigureOptions& options);
/// Fig. 11: porcelain in an environment, a morph; coats; every preset there.
absl::StatusOr<Section> figure_environment(const Studio& studio, const FigureOptions& options);
/// A body with an albedo, a normal map and a roughness map.
absl::StatusOr<Section> figure_textures(const Studio& studio, const FigureOptions& options);
/// Every preset on one mesh.
absl::StatusOr<Section> figure_materials(const Studio& studio, const FigureOptions& options);
/// Materials given by colour and mean free path, and the coefficients that they come to.
absl::StatusOr<Section> figure_colors(const Studio& studio, const FigureOptions& options);
/// paper, integral and reference, with their errors.
absl::StatusOr<Section> figure_techniques(const Studio& studio, const FigureOptions& options);

/// Both techniques at their best, as the figures show them.
RenderSettings by_paper(const PaperSettings& paper = {});
RenderSettings by_integral();

/// A body of that height in millimetres, framed by a camera that looks at its front.
absl::StatusOr<Still> portrait(const MeshData& mesh, const Material& material, double height_mm, uint32_t size_px);

/// A point light in the direction `from` the still's middle, `heights` heights of the first body away, as bright as
/// makes a white wall there kKeyRadiance.
absl::Status add_lamp(const Vec3& from, float heights, Still* still);

/// "+3.2 EV"
std::string stops(double exposure_ev);

}  // namespace diaphane::gallery
