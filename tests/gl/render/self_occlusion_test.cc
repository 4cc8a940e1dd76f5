// The paper's self-occlusion test (its §4.3.1), judged by depth.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gl/context.h"
#include "glm/geometric.hpp"
#include "render/cube_atlas.h"
#include "render/gpu_mesh.h"
#include "render/placed_mesh.h"
#include "render/shading.h"
#include "tests/gl/render/scenes.h"
#include "tests/support/meshes.h"

namespace diaphane::render {
namespace {

// Points come in pixel by pixel; what each of the three faces that N looks at answers goes out.
constexpr char kAskEveryFace[] = R"(#version 430 core
#include "shared/atlas_lookup.glsl"
layout(std430, binding = 1) readonly buffer Points { vec4 points[]; };
layout(location = 0) out vec4 answer;
void main() {
  int index = int(gl_FragCoord.y) * 256 + int(gl_FragCoord.x);
  vec3 from_centre_mm = points[2 * index].xyz;
  vec4 n = points[2 * index + 1];
  answer = vec4(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    int face = 2 * axis + (n[axis] < 0.0 ? 1 : 0);
    if (abs(n[axis]) > 0.05) answer[axis] = agrees(face, from_centre_mm, n.xyz, n.w) ? 1.0 : 0.0;
  }
}
)";

struct SurfacePoint {
  glm::vec4 from_centre_mm;
  glm::vec4 normal;  // a: sine of the angle to the facet
};

std::vector<SurfacePoint> area_uniform_points(const geometry::MeshTopology& topology,
                                              const geometry::PlacedShape& shape, const glm::vec3& centre,
                                              size_t count) {
  std::mt19937 random(7);
  std::vector<double> areas;
  for (const glm::uvec3& t : topology.triangles) {
    const glm::vec3& a = shape.positions_mm[t.x];
    areas.push_back(glm::length(glm::cross(shape.positions_mm[t.y] - a, shape.positions_mm[t.z] - a)));
  }
  std::discrete_distribution<size_t> pick(areas.begin(), areas.end());
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<SurfacePoint> points(count);
  for (SurfacePoint& point : points) {
    const glm::uvec3& t = topology.triangles[pick(random)];
    const float root = std::sqrt(unit(random));
    const float v = unit(random);
    const glm::vec3 weights(1 - root, root * (1 - v), root * v);
    glm::vec3 position(0);
    glm::vec3 normal(0);
    for (int k = 0; k < 3; ++k) {
      position += weights[k] * shape.positions_mm[t[k]];
      normal += weights[k] * shape.normals[t[k]];
    }
    normal = glm::normalize(normal);
    const glm::vec3& corner = shape.positions_mm[t.x];
    const glm::vec3 facet =
        glm::normalize(glm::cross(shape.positions_mm[t.y] - corner, shape.positions_mm[t.z] - corner));
    point = {glm::vec4(position - centre, 0), glm::vec4(normal, glm::length(glm::cross(normal, facet)))};
  }
  return points;
}

std::vector<float> read_layers(const gl::Texture& texture, uint32_t size_px) {
  std::vector<float> texels(size_t{6} * 4 * size_px * size_px);
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
  glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_FLOAT, texels.data());
  return texels;
}

TEST(SelfOcclusion, AgreesWithDepthOnTheBunny) {
  auto bunny = diaphane::testing::read_mesh(diaphane::testing::shared_path("data/meshes/bunny_closed_72k.ply"));
  if (!bunny.has_value()) GTEST_SKIP() << "../shared/data/meshes is not there: no bunny to ask";
  diaphane::testing::scale_to(*bunny, 20);
  const auto context = gl::Context::create({});
  ASSERT_TRUE(context.ok()) << context.status();
  const gl::ShaderLibrary library;
  const auto shading = Shading::load(library);
  ASSERT_TRUE(shading.ok()) << shading.status();
  const auto ask = gl::Program::link("ask", *library.source("fullscreen.vert"), *library.expand(kAskEveryFace));
  ASSERT_TRUE(ask.ok()) << ask.status();

  const auto scene = make_scene({bunny->positions_mm, bunny->triangles}, "marble");
  add_point_light(*scene, {10, 30, 40}, 1000);
  StageClock clock;
  PlacedMesh placed;
  placed.update(*scene->meshes[0], 1, clock);
  placed.complete_normals(clock);
  GpuMesh mesh;
  mesh.update(scene->meshes[0]->topology, placed.shape(), placed.generation(), clock);
  shading->bind(material_uniforms(scene->materials[0].coefficients));
  const LightStorage light{.position_mm = {10, 30, 40, 0}, .power = {1000, 1000, 1000, 0}};
  shading->bind(std::span(&light, 1));

  constexpr uint32_t kFine_px = 2048;
  const BoxUniforms fine_box = fit_box(placed.bounds_mm(), kFine_px);
  CubeAtlas fine({0, {}, 1.5f, kFine_px}, fine_box);
  shading->bind(fine_box);
  fine.render(shading->atlas(), [&](bool) { mesh.draw(); });
  const std::vector<float> fine_surface = read_layers(fine.surface(), kFine_px);

  const BoxUniforms box = fit_box(placed.bounds_mm(), 256);
  CubeAtlas atlas({0, {}, 1.5f, 256}, box);
  shading->bind(box);
  atlas.render(shading->atlas(), [&](bool) { mesh.draw(); });

  constexpr uint32_t kSide = 256;
  const auto points =
      area_uniform_points(*scene->meshes[0]->topology, placed.shape(), glm::vec3(box.centre_mm), size_t{kSide} * kSide);
  gl::Buffer points_buffer;
  gl::upload(points_buffer, GL_SHADER_STORAGE_BUFFER, points.data(), points.size() * sizeof(SurfacePoint),
             GL_STATIC_DRAW);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, points_buffer.id());
  gl::Texture answers;
  gl::storage_2d(answers, GL_RGBA32F, kSide, kSide);
  gl::Framebuffer framebuffer;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, answers.id(), 0);
  glViewport(0, 0, kSide, kSide);
  glDisable(GL_DEPTH_TEST);
  gl::bind_texture(UNIT_ATLAS_IRRADIANCE, GL_TEXTURE_2D_ARRAY, atlas.irradiance());
  gl::bind_texture(UNIT_ATLAS_SURFACE, GL_TEXTURE_2D_ARRAY, atlas.surface());
  gl::VertexArray none;
  glBindVertexArray(none.id());
  glUseProgram(ask->id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<glm::vec4> said(points.size());
  glReadPixels(0, 0, kSide, kSide, GL_RGBA, GL_FLOAT, said.data());
  ASSERT_TRUE((*context)->take_errors().ok());

  size_t visible = 0, occluded = 0, rejected = 0, accepted = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const glm::vec3 p(points[i].from_centre_mm);
    const glm::vec3 n(points[i].normal);
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(n[axis]) <= 0.05f) continue;
      const int face = 2 * axis + (n[axis] < 0 ? 1 : 0);
      const float sign = n[axis] < 0 ? -1.0f : 1.0f;
      const glm::vec3 unit = p / glm::vec3(fine_box.extent_mm) + 0.5f;
      const auto column = static_cast<size_t>(unit[(axis + 1) % 3] * kFine_px);
      const auto row = static_cast<size_t>(unit[(axis + 2) % 3] * kFine_px);
      const float depth = fine_surface[4 * ((static_cast<size_t>(face) * kFine_px + row) * kFine_px + column) + 2];
      // Nothing lies over the point but its own surface, which may rise within a fine texel.
      const float texel_mm =
          std::max(fine_box.extent_mm[(axis + 1) % 3], fine_box.extent_mm[(axis + 2) % 3]) / kFine_px;
      const bool seen = sign * (depth - p[axis]) < 2 * texel_mm / std::abs(n[axis]);
      const bool agreed = said[i][axis] > 0.5f;
      visible += seen;
      occluded += !seen;
      rejected += seen && !agreed;
      accepted += !seen && agreed;
    }
  }
  const double rejected_percent = 100.0 * static_cast<double>(rejected) / static_cast<double>(visible);
  const double accepted_percent = 100.0 * static_cast<double>(accepted) / static_cast<double>(occluded);
  std::printf("wrongly rejected %.3f %% of %zu visible, wrongly accepted %.3f %% of %zu occluded\n", rejected_percent,
              visible, accepted_percent, occluded);
  ASSERT_GT(visible, 10000u);
  ASSERT_GT(occluded, 1000u);
  EXPECT_LT(rejected_percent, 1);
  EXPECT_LT(accepted_percent, 5);
}

}  // namespace
}  // namespace diaphane::render
