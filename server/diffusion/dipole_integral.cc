#include "diffusion/dipole_integral.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "diffusion/faces.h"
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

constexpr Four kFirstThree{1, 1, 1, 0};

/// Whether fluxes ≥ 0 (fourth lanes 0) have one colour, to rounding.
class Colour {
 public:
  void add(Four flux) {
    const Four sum =
        flux + __builtin_shufflevector(flux, flux, 1, 2, 0, 3) + __builtin_shufflevector(flux, flux, 2, 0, 1, 3);
    if (share_[3] == 0) {
      if (sum[0] > 0) share_ = flux / sum[0] + Four{0, 0, 0, 1};
      return;
    }
    const Four expected = share_ * sum, slack = kRounding * sum;
    mixed_ |= bits_of((flux > expected + slack) | (flux < expected - slack)) != 0;
  }
  void add(const Colour& other) {
    mixed_ |= other.mixed_;
    add(other.share_ * kFirstThree);
  }
  bool mixed() const { return mixed_; }

 private:
  static constexpr float kRounding = 3e-5f;
  Four share_{};  ///< of each channel in the first flux that is not black; then the fourth lane is 1
  bool mixed_ = false;
};

/// Above this σ·zr in any channel the kernel falls off too fast for the wider openings.
constexpr float kAbsorbing = 0.3f;

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
  std::vector<Face> faces;
  std::vector<glm::vec3> irradiance;  ///< by slot
  std::vector<uint8_t> has_twins;     ///< by slot
  std::vector<Colour> chunk_colours;
  bool coloured = false;
  optics::Coefficients material;
  KernelSet kernels;
  std::vector<GatherJob> jobs;
  tbb::enumerable_thread_specific<GatherScratch> scratch;
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
  const SurfaceTopology& surface = *s.topology;
  const auto triangles = static_cast<uint32_t>(surface.triangles.size());
  s.for_each((triangles + kChunk - 1) / kChunk, [&](uint32_t chunk) {
    const uint32_t begin = chunk * kChunk, count = std::min(kChunk, triangles - begin);
    measure_faces(std::span(surface.triangles).subspan(begin, count), positions_mm,
                  std::span(s.faces).subspan(begin, count));
  });
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) {
    const uint32_t end = std::min((chunk + 1) * kChunk, surface.slot_count);
    for (uint32_t slot = chunk * kChunk; slot < end; ++slot) {
      Four vector_area{}, weighted{};
      for (uint32_t k = surface.first_corner[slot]; k < surface.first_corner[slot + 1]; ++k) {
        const auto* face = reinterpret_cast<const float*>(&s.faces[surface.triangle_of_corner[k]]);
        vector_area += load4(face);
        weighted += load4(face + 4);
      }
      const uint32_t vertex = surface.vertex_of_slot[slot];
      const Four position = load3(&positions_mm[vertex].x);
      const Four third = vector_area * (1.0f / 3);
      auto* place = reinterpret_cast<float*>(&s.tree.places[slot]);
      store4(place, __builtin_shufflevector(position, third, 0, 1, 2, 7));
      store4(place + 4, third * kFirstThree);
      const float area = vector_area[3];
      store3(&s.tree.sources[slot].position_mm.x, area > 0 ? 0.5f * (position + weighted * (1 / area)) : position);
      if (normals.empty()) continue;
      const Four squares = vector_area * vector_area;
      const float length2 = squares[0] + squares[1] + squares[2];
      store3(&normals[vertex].x, length2 > 0 ? vector_area * (1 / std::sqrt(length2)) : Four{0, 0, 1, 0});
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
  s.for_each(s.tree.chunk_count(), [&](uint32_t chunk) {
    const uint32_t end = std::min((chunk + 1) * kChunk, surface.slot_count);
    Colour colour;
    for (uint32_t slot = chunk * kChunk; slot < end; ++slot) {
      Four flux{};
      for (uint32_t k = surface.first_corner[slot]; k < surface.first_corner[slot + 1]; ++k) {
        const uint32_t t = surface.triangle_of_corner[k];
        flux += s.faces[t].area_mm2 * load3(&at_triangles[t].x);
      }
      flux *= 1.0f / 3;
      store3(&s.tree.sources[slot].flux_w.x, flux);
      colour.add(flux);
      s.irradiance[slot] = s.weld_irradiance(slot, at_vertices);
    }
    s.chunk_colours[chunk] = colour;
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
  return s.tree.bytes() + s.faces.size() * sizeof(Face) + s.irradiance.size() * sizeof(glm::vec3) + s.has_twins.size() +
         sizeof(uint32_t) * (surface.vertex_of_slot.size() + surface.slot_of_vertex.size() + surface.twins.size() +
                             surface.first_corner.size() + surface.triangle_of_corner.size()) +
         surface.triangles.size() * sizeof(glm::uvec3);
}

}  // namespace diaphane::diffusion
