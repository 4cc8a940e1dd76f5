#include "diffusion/dipole_integral.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "diffusion/four.h"
#include "diffusion/gather.h"
#include "diffusion/kernel_table.h"
#include "diffusion/node_tree.h"
#include "glm/geometric.hpp"
#include "tbb/blocked_range.h"
#include "tbb/enumerable_thread_specific.h"
#include "tbb/parallel_for.h"
#include "tbb/task_arena.h"

namespace diaphane::diffusion {
namespace {

constexpr uint32_t kChunk = NodeTree::kChunkSlots;

/// What the vertices of a triangle sum up; eight floats.
struct Face {
  glm::vec3 area_vector_mm2{0};
  float area_mm2 = 0;
  glm::vec3 weighted{0};  ///< centroid times area; once the light is known, flux to each corner
  float unused = 0;
};

Face make_face(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  Face face;
  face.area_vector_mm2 = 0.5f * glm::cross(b - a, c - a);
  face.area_mm2 = std::sqrt(glm::dot(face.area_vector_mm2, face.area_vector_mm2));
  face.weighted = face.area_mm2 * (1.0f / 3) * (a + b + c);
  return face;
}

/// Above this σ·zr in any channel the kernel falls off too fast for the wider openings.
constexpr float kAbsorbing = 0.3f;

/// Whether two fluxes have one colour, to rounding.
bool same_colour(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 turned = glm::cross(a, b);
  return glm::dot(turned, turned) <= 1e-9f * glm::dot(a, a) * glm::dot(b, b);
}

}  // namespace

Openings openings_of(Quality quality, const optics::Coefficients& material) {
  const optics::Dipole dipole = optics::make_dipole(material);
  const glm::vec3 absorption = dipole.effective_transport_mm * dipole.mean_free_path_mm;
  const bool absorbing = std::max({absorption.x, absorption.y, absorption.z}) > kAbsorbing;
  switch (quality) {
    case Quality::kDraft:
      return absorbing ? Openings{0.34f, 0.50f} : Openings{0.42f, 0.60f};
    case Quality::kNormal:
      return absorbing ? Openings{0.28f, 0.45f} : Openings{0.36f, 0.52f};
    case Quality::kFine:
      break;
  }
  return absorbing ? Openings{0.24f, 0.40f} : Openings{0.28f, 0.45f};
}

struct DipoleIntegral::State {
  State(std::shared_ptr<const SurfaceTopology> surface, int threads)
      : topology(std::move(surface)),
        tree(topology->slot_count),
        faces(topology->triangles.size()),
        irradiance(topology->slot_count),
        arena(threads > 0 ? threads : tbb::task_arena::automatic) {}

  /// Calls work(i) for i below `count`, on the arena's threads.
  template <class Work>
  void for_each(uint32_t count, const Work& work) {
    arena.execute([&] { tbb::parallel_for(uint32_t{0}, count, work); });
  }

  glm::vec3 weld_irradiance(uint32_t slot, std::span<const glm::vec3> at_vertices) const;

  std::shared_ptr<const SurfaceTopology> topology;
  NodeTree tree;
  std::vector<Face> faces;
  std::vector<glm::vec3> irradiance;  ///< by slot
  std::vector<uint8_t> has_twins;     ///< by slot
  bool coloured = false;
  optics::Coefficients material;
  KernelSet kernels;
  std::vector<GatherJob> jobs;
  tbb::enumerable_thread_specific<GatherScratch> scratch;
  tbb::task_arena arena;
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
  const SurfaceTopology& surface = *s.topology;
  const auto triangles = static_cast<uint32_t>(surface.triangles.size());
  s.for_each((triangles + kChunk - 1) / kChunk, [&](uint32_t chunk) {
    const uint32_t end = std::min((chunk + 1) * kChunk, triangles);
    for (uint32_t t = chunk * kChunk; t < end; ++t) {
      const glm::uvec3& v = surface.triangles[t];
      s.faces[t] = make_face(positions_mm[v.x], positions_mm[v.y], positions_mm[v.z]);
    }
  });
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) {
    const uint32_t end = std::min((chunk + 1) * kChunk, surface.slot_count);
    for (uint32_t slot = chunk * kChunk; slot < end; ++slot) {
      Four low{}, high{};
      for (uint32_t k = surface.first_corner[slot]; k < surface.first_corner[slot + 1]; ++k) {
        const auto* face = reinterpret_cast<const float*>(&s.faces[surface.triangle_of_corner[k]]);
        low += load4(face);
        high += load4(face + 4);
      }
      const Face sum{{low[0], low[1], low[2]}, low[3], {high[0], high[1], high[2]}, 0};
      const uint32_t vertex = surface.vertex_of_slot[slot];
      const glm::vec3& position = positions_mm[vertex];
      s.tree.places[slot] = {position, sum.area_mm2 / 3, sum.area_vector_mm2 / 3.0f};
      s.tree.sources[slot].position_mm = sum.area_mm2 > 0 ? 0.5f * (position + sum.weighted / sum.area_mm2) : position;
      if (normals.empty()) continue;
      const float length = glm::length(sum.area_vector_mm2);
      normals[vertex] = length > 0 ? sum.area_vector_mm2 / length : glm::vec3(0, 0, 1);
    }
    if (end == surface.slot_count) {
      for (uint32_t slot = end; slot < s.tree.places.size(); ++slot) {
        s.tree.places[slot] = {s.tree.places[end - 1].position_mm};
        s.tree.sources[slot].position_mm = s.tree.sources[end - 1].position_mm;
      }
    }
  });
  if (normals.empty()) return;
  for (const uint32_t v : surface.twins) normals[v] = normals[surface.vertex_of_slot[surface.slot_of_vertex[v]]];
}

void DipoleIntegral::refit_geometry() {
  State& s = *state_;
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) { s.tree.refit_geometry_chunk(chunk); });
  s.tree.refit_geometry_top();
}

/// The mean over the triangles at a place where several vertices meet, each with its own normal, weighted by area.
glm::vec3 DipoleIntegral::State::weld_irradiance(uint32_t slot, std::span<const glm::vec3> at_vertices) const {
  const uint32_t first_vertex = topology->vertex_of_slot[slot];
  if (!has_twins[slot]) return at_vertices[first_vertex];
  glm::vec3 sum(0);
  float area = 0;
  for (uint32_t k = topology->first_corner[slot]; k < topology->first_corner[slot + 1]; ++k) {
    const uint32_t t = topology->triangle_of_corner[k];
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = topology->triangles[t][corner];
      if (topology->slot_of_vertex[vertex] != slot) continue;
      sum += faces[t].area_mm2 * at_vertices[vertex];
      area += faces[t].area_mm2;
    }
  }
  return area > 0 ? sum / area : at_vertices[first_vertex];
}

void DipoleIntegral::set_irradiance(std::span<const glm::vec3> at_triangles, std::span<const glm::vec3> at_vertices) {
  State& s = *state_;
  const SurfaceTopology& surface = *s.topology;
  const auto slots = surface.slot_count, triangles = static_cast<uint32_t>(surface.triangles.size());
  s.for_each((triangles + kChunk - 1) / kChunk, [&](uint32_t chunk) {
    const uint32_t end = std::min((chunk + 1) * kChunk, triangles);
    for (uint32_t t = chunk * kChunk; t < end; ++t) s.faces[t].weighted = s.faces[t].area_mm2 / 3 * at_triangles[t];
  });
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) {
    const uint32_t end = std::min((chunk + 1) * kChunk, slots);
    for (uint32_t slot = chunk * kChunk; slot < end; ++slot) {
      Four flux{};
      for (uint32_t k = surface.first_corner[slot]; k < surface.first_corner[slot + 1]; ++k) {
        flux += load4(reinterpret_cast<const float*>(&s.faces[surface.triangle_of_corner[k]]) + 4);
      }
      s.tree.sources[slot].flux_w = {flux[0], flux[1], flux[2]};
      s.irradiance[slot] = s.weld_irradiance(slot, at_vertices);
    }
  });
  const auto is_lit = [](const Source& source) { return source.flux_w.x + source.flux_w.y + source.flux_w.z > 0; };
  const auto first = std::find_if(s.tree.sources.begin(), s.tree.sources.end(), is_lit);
  std::atomic<bool> coloured = false;
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) {
    const uint32_t end = std::min((chunk + 1) * kChunk, slots);
    for (uint32_t slot = chunk * kChunk; slot < end && !coloured.load(std::memory_order_relaxed); ++slot) {
      if (!same_colour(first->flux_w, s.tree.sources[slot].flux_w)) coloured = true;
    }
  });
  s.coloured = coloured;
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
  return s.tree.bytes() + s.faces.size() * sizeof(Face) + s.irradiance.size() * sizeof(glm::vec3) + s.has_twins.size() +
         sizeof(uint32_t) * (surface.vertex_of_slot.size() + surface.slot_of_vertex.size() + surface.twins.size() +
                             surface.first_corner.size() + surface.triangle_of_corner.size()) +
         surface.triangles.size() * sizeof(glm::uvec3);
}

}  // namespace diaphane::diffusion
