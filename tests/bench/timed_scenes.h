// What the benches of frame times share: the five sizes of the paper's Table 2, a pose for each frame, a camera that
// moves.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "diffusion/dipole_integral.h"
#include "glm/vec3.hpp"
#include "scene/camera.h"
#include "scene/snapshot.h"
#include "tests/support/meshes.h"

namespace diaphane::bench {

/// Files of data/meshes; bodies are scaled to 20 mm.
const std::vector<std::string>& five_meshes();

inline constexpr glm::vec3 kLight{25, 30, 40};  ///< mm

/// One white light at kLight, or two of different colours.
std::vector<scene::Light> lights(bool coloured);

std::shared_ptr<scene::SceneSnapshot> make_scene(const testing::Mesh& mesh, const std::string& preset,
                                                 std::vector<scene::Light> lights);

/// The mesh leaning to and fro.
std::vector<glm::vec3> leaning(const testing::Mesh& mesh, int frame);

/// The scene with other positions; a new pose to every stage, also where they are the same.
std::shared_ptr<const scene::SceneSnapshot> posed(const scene::SceneSnapshot& scene, std::vector<glm::vec3> positions);

scene::Camera orbit(int frame);

/// draft | normal | fine
diffusion::Quality quality_of(const std::string& name);

/// 0 of nothing.
double median(std::vector<double> values);

template <class Work>
double milliseconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace diaphane::bench
