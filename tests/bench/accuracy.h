// What the accuracy bench measures of one cell of mesh × material × light.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "diffusion/dipole_integral.h"
#include "render/frame.h"
#include "tests/support/cells.h"

namespace diaphane::bench {

struct AccuracySettings {
  diffusion::Quality quality = diffusion::Quality::kFine;
  std::vector<float> openings;  ///< groups, vertices: in place of the quality's; or empty
  std::vector<float> spacings;  ///< smallest, largest, in smooth distances: in place of the server's; or empty
  size_t points = 3000;
  float extent_mm = 20;
  std::string cache;  ///< folder that keeps truths from run to run, or empty
};

/// Radiosity of a technique next to the truth.
struct Samples {
  std::vector<glm::vec3> at_mm;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec3> values;
  std::vector<glm::vec3> truth;
};

/// How fine the mesh is that the integral ran on. s = √(½(mean + max area)) of a leaf's vertices; z the smooth
/// distance.
struct Spacing {
  size_t triangles = 0;
  double mean = 0;     ///< s/z, weighted by area
  double largest = 0;  ///< of any leaf
};

/// The integral at random points of the surface. The mesh is split as the server splits it.
Samples measure_integral(const testing::Cell& cell, const AccuracySettings& settings, Spacing& spacing);

/// The paper's technique and the integral, at the same pixels off silhouettes, chosen evenly from six views. B = πL/Ft.
struct PixelSamples {
  Samples paper;
  Samples integral;
};
PixelSamples measure_paper(const testing::Cell& cell, const AccuracySettings& settings,
                           render::FrameRenderer& renderer);

struct Errors {
  glm::vec3 relative_rms{0};  ///< over the mean, by channel
  float worst_over_mean = 0;  ///< largest |difference| of any point and channel, over the channel's mean
  size_t worst_point = 0;
  int worst_point_channel = 0;
  float worst_over_own = 0;  ///< over the point's own B, where that is above a hundredth of the mean
  size_t worst_own_point = 0;
  int worst_own_point_channel = 0;
  float own_over_mean = 0;  ///< its own B, over the mean

  glm::vec3 mean{0};        ///< of the truth
  glm::vec3 brightness{0};  ///< mean over the true mean
  glm::vec3 fitted_rms{0};  ///< relative_rms that is left when the values are scaled to fit best

  float worst_channel() const { return worst_of(relative_rms); }
  static float worst_of(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }
};
Errors errors_of(const Samples& samples);

}  // namespace diaphane::bench
