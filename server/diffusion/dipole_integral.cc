#include "diffusion/dipole_integral.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "diffusion/gather.h"
#include "diffusion/kernel_table.h"
#include "diffusion/node_tree.h"
#include "diffusion/vertex_sums.h"
#include "glm/geometric.hpp"
#include "tbb/blocked_range.h"
#include "tbb/enumerable_thread_specific.h"
#include "tbb/parallel_for.h"
#include "tbb/task_arena.h"

namespace diaphane::diffusion {
namespace {

constexpr uint32_t kChunk = NodeTree::kChunkSlots;

/// Above this σ·zr in any channel the kernel falls off too fast for the wider openings.
constexpr float kAbsorbing = 0.3f;

}  // namespace

Openings openings_of(Quality quality, const optics::Coefficients& material) {
  const optics::ReflectanceProfile profile = optics::make_profile(material);
  bool absorbing = false;
  for (int c = 0; c < 3; ++c) {
    const float extinction = material.absorption_mm[c] + material.reduced_scattering_mm[c];
    absorbing = absorbing || profile[c].terms[0].transport_mm > kAbsorbing * extinction;
  }
  switch (quality) {
    case Quality::kDraft:
      return absorbing ? Openings{0.34f, 0.50f} : Openings{0.42f, 0.60f};
    case Quality::kNormal:
      return absorbing ? Openings{0.28f, 0.45f} : Openings{0.36f, 0.52f};
    case Quality::kFine:
      break;
  }
  return Openings{0.24f, 0.40f};
}

struct DipoleIntegral::State {
  State(std::shared_ptr<const SurfaceTopology> surface, int threads)
      : topology(std::move(surface)),
        tree(topology->slot_count),
        sums(*topology),
        irradiance(topology->slot_count),
        chunk_colours(tree.chunk_count()) {
    if (threads > 0) arena.emplace(threads);
  }

  /// Calls work(i) for i below `count`, on the arena's threads. Without one on the caller's: threads that have just
  /// finished another stage are awake there.
  template <class Work>
  void for_each(uint32_t count, const Work& work) {
    if (!arena) {
      tbb::parallel_for(uint32_t{0}, count, work);
      return;
    }
    arena->execute([&] { tbb::parallel_for(uint32_t{0}, count, work); });
  }

  glm::vec3 weld_irradiance(uint32_t slot, std::span<const glm::vec3> at_vertices) const;

  std::shared_ptr<const SurfaceTopology> topology;
  NodeTree tree;
  VertexSums sums;
  std::vector<glm::vec3> irradiance;  ///< by slot
  std::vector<uint8_t> has_twins;     ///< by slot
  std::vector<Colour> chunk_colours;
  bool coloured = false;
  optics::Coefficients material;
  KernelSet kernels;
  std::vector<GatherJob> jobs;
  tbb::enumerable_thread_specific<GatherScratch> scratch;
  tbb::enumerable_thread_specific<VertexSums::Scratch> sums_scratch;
  std::optional<tbb::task_arena> arena;
};

DipoleIntegral::DipoleIntegral(std::shared_ptr<const SurfaceTopology> topology, int threads)
    : state_(std::make_unique<State>(std::move(topology), threads)) {
  state_->has_twins.resize(state_->topology->slot_count);
  for (const uint32_t v : state_->topology->twins) state_->has_twins[state_->topology->slot_of_vertex[v]] = 1;
  set_material({});
}

DipoleIntegral::~DipoleIntegral() = default;

void DipoleIntegral::update_positions(std::span<const glm::vec3> positions_mm, std::span<glm::vec3> normals) {
  State& s = *state_;
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) {
    s.sums.sum_positions(chunk, positions_mm, normals, s.tree, s.sums_scratch.local());
  });
  if (normals.empty()) return;
  const SurfaceTopology& surface = *s.topology;
  for (const uint32_t v : surface.twins) normals[v] = normals[surface.vertex_of_slot[surface.slot_of_vertex[v]]];
}

void DipoleIntegral::refit_geometry() {
  State& s = *state_;
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) { s.tree.refit_geometry_chunk(chunk); });
  s.tree.refit_geometry_top();
}

/// The mean over the triangles at a place where several vertices meet, each with its own normal, weighted by area.
glm::vec3 DipoleIntegral::State::weld_irradiance(uint32_t slot, std::span<const glm::vec3> at_vertices) const {
  glm::vec3 sum(0);
  float area = 0;
  for (uint32_t k = topology->first_corner[slot]; k < topology->first_corner[slot + 1]; ++k) {
    const uint32_t t = topology->triangle_of_corner[k];
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = topology->triangles[t][corner];
      if (topology->slot_of_vertex[vertex] != slot) continue;
      sum += sums.triangle_area_mm2(t) * at_vertices[vertex];
      area += sums.triangle_area_mm2(t);
    }
  }
  return area > 0 ? sum / area : at_vertices[topology->vertex_of_slot[slot]];
}

void DipoleIntegral::set_irradiance(std::span<const glm::vec3> at_triangles, std::span<const glm::vec3> at_vertices) {
  State& s = *state_;
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) {
    s.chunk_colours[chunk] = s.sums.sum_flux(chunk, at_triangles, s.tree, s.sums_scratch.local());
    const uint32_t end = std::min((chunk + 1) * kChunk, s.topology->slot_count);
    for (uint32_t slot = chunk * kChunk; slot < end; ++slot) {
      s.irradiance[slot] =
          s.has_twins[slot] ? s.weld_irradiance(slot, at_vertices) : at_vertices[s.topology->vertex_of_slot[slot]];
    }
  });
  Colour colour;
  for (const Colour& of_chunk : s.chunk_colours) colour.add(of_chunk);
  s.coloured = colour.mixed();
}

void DipoleIntegral::refit_flux() {
  State& s = *state_;
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) { s.tree.refit_flux_chunk(chunk, s.coloured); });
  s.tree.refit_flux_top(s.coloured);
}

void DipoleIntegral::set_material(const optics::Coefficients& material) {
  state_->material = material;
  state_->kernels.set_material(material);
}

void DipoleIntegral::prepare_tables() {
  State& s = *state_;
  const float radius = s.tree.block(s.tree.top_level(), 0)[4 * kRadius];
  s.kernels.prepare(2 * radius, s.tree.spacing2_mm2);
}

void DipoleIntegral::gather(Quality quality, std::span<glm::vec3> radiosity) {
  gather(openings_of(quality, state_->material), radiosity);
}

void DipoleIntegral::gather(const Openings& openings, std::span<glm::vec3> radiosity) {
  prepare_tables();
  State& s = *state_;
  const GatherInput input{&s.tree,
                          &s.kernels,
                          s.irradiance.data(),
                          s.topology->vertex_of_slot.data(),
                          radiosity.data(),
                          {openings.groups, openings.vertices, s.coloured}};
  const size_t jobs = collect_jobs(input, s.scratch.local(), s.jobs);
  s.for_each(static_cast<uint32_t>(jobs), [&](uint32_t job) { run_job(input, s.scratch.local(), s.jobs[job]); });
  for (const uint32_t v : s.topology->twins) {
    radiosity[v] = radiosity[s.topology->vertex_of_slot[s.topology->slot_of_vertex[v]]];
  }
}

const SurfaceTopology& DipoleIntegral::topology() const { return *state_->topology; }

size_t DipoleIntegral::bytes() const {
  const State& s = *state_;
  const SurfaceTopology& surface = *s.topology;
  return s.tree.bytes() + s.sums.bytes() + s.irradiance.size() * sizeof(glm::vec3) + s.has_twins.size() +
         sizeof(uint32_t) * (surface.vertex_of_slot.size() + surface.slot_of_vertex.size() + surface.twins.size() +
                             surface.first_corner.size() + surface.triangle_of_corner.size()) +
         surface.triangles.size() * sizeof(glm::uvec3);
}

}  // namespace diaphane::diffusion
