#include "render/gpu_mesh.h"

#include "render/uniforms.h"

namespace diaphane::render {
namespace {

void attach_attribute(const gl::Buffer& buffer, GLuint location) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  glEnableVertexAttribArray(location);
}

}  // namespace

void GpuMesh::update(const scene::Mesh& mesh, double millimetres_per_unit, StageClock& clock) {
  const bool new_topology = topology_.lock() != mesh.topology;
  const bool moved = new_topology || shape_.lock() != mesh.shape || scene_from_mesh_ != mesh.scene_from_mesh ||
                     millimetres_per_unit_ != millimetres_per_unit;
  if (!moved) {
    clock.sleep("place");
    clock.sleep("upload");
    return;
  }
  const geometry::PlacedShape placed = clock.run("place", [&] {
    return geometry::place(*mesh.topology, *mesh.shape, mesh.scene_from_mesh, millimetres_per_unit);
  });
  clock.run("upload", [&] {
    const size_t bytes = placed.positions_mm.size() * sizeof(glm::vec3);
    glBindVertexArray(vertex_array_.id());
    gl::upload(positions_, GL_ARRAY_BUFFER, placed.positions_mm.data(), bytes, GL_STREAM_DRAW);
    gl::upload(normals_, GL_ARRAY_BUFFER, placed.normals.data(), bytes, GL_STREAM_DRAW);
    if (new_topology) {
      attach_attribute(positions_, ATTRIBUTE_POSITION);
      attach_attribute(normals_, ATTRIBUTE_NORMAL);
      index_count_ = static_cast<GLsizei>(3 * mesh.topology->triangles.size());
      gl::upload(indices_, GL_ELEMENT_ARRAY_BUFFER, mesh.topology->triangles.data(),
                 mesh.topology->triangles.size() * sizeof(glm::uvec3), GL_STATIC_DRAW);
    }
  });
  bounds_mm_ = geometry::bounds_of(placed.positions_mm);
  flipped_ = placed.flipped;
  topology_ = mesh.topology;
  shape_ = mesh.shape;
  scene_from_mesh_ = mesh.scene_from_mesh;
  millimetres_per_unit_ = millimetres_per_unit;
  ++generation_;
}

void GpuMesh::draw() const {
  glBindVertexArray(vertex_array_.id());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace diaphane::render
