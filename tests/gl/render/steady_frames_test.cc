// What a frame in the steady state costs, counted and not timed: allocations, calls of OpenGL, bytes, memory.
#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "render/gl_renderer.h"
#include "tests/gl/render/scenes.h"
#include "tests/gl/render/shared_renderer.h"
#include "tests/support/allocations.h"

namespace diaphane::render {
namespace {

class SteadyFrames : public BothRasters {};
INSTANTIATE_TEST_SUITE_P(, SteadyFrames, kBothRasters, name_of_raster);

/// A body of some thousand triangles under one light, as streams ask for it.
FrameRequest request_of(Technique technique) {
  FrameRequest request;
  auto scene = make_ball_scene(4, 24, "marble");
  add_point_light(*scene, {20, 30, 40}, 4000);
  request.scene = scene;
  request.settings.technique = technique;
  request.camera.eye = {0, 0, 20};
  request.width_px = 160;
  request.height_px = 120;
  return request;
}

/// Poses of the ball that a motion repeats, made beforehand: what clients send is theirs.
std::vector<std::shared_ptr<const scene::SceneSnapshot>> poses_of(const scene::SceneSnapshot& scene) {
  std::vector<std::shared_ptr<const scene::SceneSnapshot>> poses;
  for (int i = 0; i < 8; ++i) {
    auto posed = std::make_shared<scene::SceneSnapshot>(scene);
    auto mesh = std::make_shared<scene::Mesh>(*scene.meshes[0]);
    auto shape = std::make_shared<geometry::MeshShape>(*mesh->shape);
    for (glm::vec3& p : shape->positions) p.x += 0.1f * std::sin(static_cast<float>(i)) * p.y;
    shape->normals.clear();
    mesh->shape = shape;
    posed->meshes[0] = mesh;
    poses.push_back(posed);
  }
  return poses;
}

size_t resident_kib() {
  std::ifstream statm("/proc/self/statm");
  size_t pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE)) / 1024;
}

/// Allocations of our code on the renderer's thread in 300 frames, after some that may.
size_t allocations_of_frames(FrameRenderer& renderer, FrameRequest request, bool deforming) {
  const auto poses = poses_of(*request.scene);
  const std::atomic<bool> not_cancelled = false;
  request.scene = poses[0];
  size_t before_kib = 0;
  std::atomic<size_t> allocations = 0;
  for (int i = -40; i < 300; ++i) {
    if (deforming) request.scene = poses[static_cast<size_t>(i + 40) % poses.size()];
    request.camera.eye.x = std::sin(0.1f * static_cast<float>(i));
    if (i == 0) before_kib = resident_kib();
    count_allocations_of_this_thread(i >= 0 ? &allocations : nullptr);
    absl::StatusOr<Frame> frame = renderer.render(request, not_cancelled);
    count_allocations_of_this_thread(nullptr);
    EXPECT_TRUE(frame.ok()) << frame.status();
    if (frame.ok()) renderer.recycle(*std::move(frame));
  }
#ifndef __SANITIZE_ADDRESS__  // which keeps what is freed
  // A page here or there is the allocator's; 300 pictures would be 22 MiB.
  EXPECT_LT(resident_kib(), before_kib + 2048);
#endif
  return allocations;
}

/// What reaches OpenGL. Counted in the place of the functions themselves, which a first frame has looked up.
struct Work {
  size_t draws = 0, triangles = 0, uploads = 0, uploaded_bytes = 0, read_bytes = 0;
};
Work work;

struct Functions {
  PFNGLDRAWELEMENTSPROC draw_elements = epoxy_glDrawElements;
  PFNGLDRAWARRAYSPROC draw_arrays = epoxy_glDrawArrays;
  PFNGLBUFFERDATAPROC buffer_data = epoxy_glBufferData;
  PFNGLREADPIXELSPROC read_pixels = epoxy_glReadPixels;
};
std::optional<Functions> functions;

void GLAPIENTRY draw_elements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
  ++work.draws;
  work.triangles += static_cast<size_t>(count) / 3;
  functions->draw_elements(mode, count, type, indices);
}
void GLAPIENTRY draw_arrays(GLenum mode, GLint first, GLsizei count) {
  ++work.draws;
  work.triangles += static_cast<size_t>(count) / 3;
  functions->draw_arrays(mode, first, count);
}
void GLAPIENTRY buffer_data(GLenum target, GLsizeiptr bytes, const void* data, GLenum usage) {
  ++work.uploads;
  work.uploaded_bytes += static_cast<size_t>(bytes);
  functions->buffer_data(target, bytes, data, usage);
}
void GLAPIENTRY read_pixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* to) {
  work.read_bytes += static_cast<size_t>(width) * static_cast<size_t>(height) * (type == GL_FLOAT ? 16 : 4);
  functions->read_pixels(x, y, width, height, format, type, to);
}

/// What one frame asks of OpenGL.
Work work_of(FrameRenderer& renderer, const FrameRequest& request) {
  functions.emplace();
  epoxy_glDrawElements = draw_elements;
  epoxy_glDrawArrays = draw_arrays;
  epoxy_glBufferData = buffer_data;
  epoxy_glReadPixels = read_pixels;
  work = {};
  EXPECT_TRUE(renderer.render(request, std::atomic<bool>(false)).ok());
  epoxy_glDrawElements = functions->draw_elements;
  epoxy_glDrawArrays = functions->draw_arrays;
  epoxy_glBufferData = functions->buffer_data;
  epoxy_glReadPixels = functions->read_pixels;
  return work;
}

class FrameWork : public BothRasters {};
INSTANTIATE_TEST_SUITE_P(, FrameWork, kBothRasters, name_of_raster);

struct WorkLimits {
  size_t draws, vertex_floats;
};

/// `camera`: it alone moves. `deforming`: the body too.
void expect_work(FrameRenderer& renderer, Technique technique, const WorkLimits& camera, const WorkLimits& deforming,
                 bool native) {
  FrameRequest request = request_of(technique);
  request.settings.shadows = false;
  const auto poses = poses_of(*request.scene);
  request.scene = poses[0];
  EXPECT_TRUE(renderer.render(request, std::atomic<bool>(false)).ok());
  const size_t pixel_bytes = size_t{4} * request.width_px * request.height_px;
  for (const bool moves : {false, true}) {
    request.camera.eye.x += 1;
    if (moves) request.scene = poses[1];
    const Work done = work_of(renderer, request);
    const WorkLimits& limits = moves ? deforming : camera;
    // Views, materials, lights and boxes: small.
    constexpr size_t kUniformBytes = 2048;
    const size_t vertices = request.scene->meshes[0]->topology->vertex_count;
    EXPECT_LE(done.draws, limits.draws) << moves;
    EXPECT_LE(done.uploaded_bytes, (native ? 0 : kUniformBytes) + limits.vertex_floats * sizeof(float) * vertices)
        << moves;
    EXPECT_LE(done.uploads, native ? 0u : 16u) << moves;
    EXPECT_EQ(done.read_bytes, native ? 0 : pixel_bytes) << moves;
  }
}

TEST_P(FrameWork, OfTheIntegralIsOneDrawAndWhatChanged) {
  if (native()) {
    expect_work(*renderer_, Technique::kIntegral, {0, 0}, {0, 0}, true);
  } else {
    // Positions, normals and radiosities.
    expect_work(*renderer_, Technique::kIntegral, {1, 0}, {1, 9}, false);
  }
}

TEST_P(FrameWork, OfThePaperIsSixFacesAndAViewAndWhatChanged) {
  if (native()) {
    expect_work(*renderer_, Technique::kPaper, {0, 0}, {0, 0}, true);
  } else {
    expect_work(*renderer_, Technique::kPaper, {2, 0}, {8, 6}, false);
  }
}

TEST_P(SteadyFrames, AllocateNothing) {
  for (const Technique technique : {Technique::kIntegral, Technique::kPaper}) {
    for (const bool deforming : {false, true}) {
      for (const bool shadows : {false, true}) {
        FrameRequest request = request_of(technique);
        request.settings.shadows = shadows;
        // Embree makes one string when it refits its tree, for the paper's rays.
        const size_t of_embree = technique == Technique::kPaper && deforming && shadows ? 300 : 0;
        EXPECT_LE(allocations_of_frames(*renderer_, request, deforming), of_embree)
            << (technique == Technique::kPaper ? "paper" : "integral") << (deforming ? ", deforming" : ", still")
            << (shadows ? ", shadows" : "");
      }
    }
  }
}

}  // namespace
}  // namespace diaphane::render
