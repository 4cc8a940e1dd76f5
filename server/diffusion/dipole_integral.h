// The dipole integral over a whole deforming surface, in milliseconds: B(x) = ∫ E(y)·Rd(|x − y|) dA(y).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "diffusion/surface_topology.h"
#include "glm/vec3.hpp"
#include "optics/dipole.h"

namespace diaphane::diffusion {

/// Accuracy against time; docs/integral.md has both, measured.
enum class Quality { kDraft, kNormal, kFine };

/// How wide a group of vertices may look, radius over distance, and still be taken as one: between groups, and from a
/// group to single vertices. Smaller is slower and more accurate.
struct Openings {
  float groups;
  float vertices;
};

/// What a quality means for a material.
Openings openings_of(Quality quality, const optics::Coefficients& material);

/// One body. Its stages, in the order in which they feed each other; a caller leaves out those whose inputs did not
/// change:
///
///     update_positions → refit_geometry ─┐
///     update_positions → set_irradiance → refit_flux ─┼→ gather
///     set_material ──────────────────────┘
///
/// Every stage runs on `threads` threads and returns when done; the same inputs give the same bytes on any number of
/// threads at one SIMD level. After the first few calls nothing allocates. One caller at a time.
class DipoleIntegral {
 public:
  /// `threads` 0: all cores.
  explicit DipoleIntegral(std::shared_ptr<const SurfaceTopology> topology, int threads = 0);
  ~DipoleIntegral();

  /// Areas and places of the vertices. `positions_mm` [vertex_count], within ±1e7 mm (fourth powers of distances must
  /// stay finite). Where `normals` is not empty,
  /// [vertex_count], it gets area-weighted unit normals, equal at all vertices of a weld; +z where a weld has no area.
  void update_positions(std::span<const glm::vec3> positions_mm, std::span<glm::vec3> normals = {});

  /// Fits the tree to the places.
  void refit_geometry();

  /// Irradiance E ≥ 0 that enters the body, RGB, W·mm⁻²: at the centroids of topology().triangles (in that order, with
  /// the renormalised mean of the corners' normals), and at the vertices for the local term.
  void set_irradiance(std::span<const glm::vec3> at_triangles, std::span<const glm::vec3> at_vertices);

  /// Fits the tree to the flux.
  void refit_flux();

  void set_material(const optics::Coefficients& material);

  /// Builds kernel tables that the next gather needs and does not have yet; gather() does it too.
  void prepare_tables();

  /// Radiosity B, RGB, W·mm⁻², into `radiosity` [vertex_count].
  void gather(Quality quality, std::span<glm::vec3> radiosity);
  void gather(const Openings& openings, std::span<glm::vec3> radiosity);

  const SurfaceTopology& topology() const;
  /// Memory that the integral holds, its share of the topology included, bytes.
  size_t bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace diaphane::diffusion
