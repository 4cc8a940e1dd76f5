#include "render/gpu_mesh.h"

#include "render/uniforms.h"

namespace diaphane::render {
namespace {

template <typename Vector>
void fill_attribute(const gl::Buffer& buffer, GLuint location, std::span<const Vector> values) {
  gl::upload(buffer, GL_ARRAY_BUFFER, values.data(), values.size_bytes(), GL_STREAM_DRAW);
  glVertexAttribPointer(location, Vector::length(), GL_FLOAT, GL_FALSE, sizeof(Vector), nullptr);
  glEnableVertexAttribArray(location);
}

}  // namespace

void GpuMesh::update(const std::shared_ptr<const geometry::MeshTopology>& topology, const geometry::PlacedShape& shape,
                     uint64_t generation, StageClock& clock) {
  const bool new_topology = topology_.lock() != topology;
  if (!shape_memo_.renew({&shape, generation}) && !new_topology) {
    clock.sleep("upload");
    return;
  }
  clock.run("upload", [&] {
    glBindVertexArray(vertex_array_.id());
    fill_attribute<glm::vec3>(positions_, ATTRIBUTE_POSITION, shape.positions_mm);
    fill_attribute<glm::vec3>(normals_, ATTRIBUTE_NORMAL, shape.normals);
    if (new_topology) {
      glDisableVertexAttribArray(ATTRIBUTE_RADIOSITY);
      radiosity_memo_.forget();
      glDisableVertexAttribArray(ATTRIBUTE_IRRADIANCE);
      irradiance_memo_.forget();
      glDisableVertexAttribArray(ATTRIBUTE_TEXTURE_COORDINATE);
      glDisableVertexAttribArray(ATTRIBUTE_COLOR);
      attributes_.reset();
      index_count_ = static_cast<GLsizei>(3 * topology->triangles.size());
      gl::upload(indices_, GL_ELEMENT_ARRAY_BUFFER, topology->triangles.data(),
                 topology->triangles.size() * sizeof(glm::uvec3), GL_STATIC_DRAW);
    }
  });
  topology_ = topology;
  flipped_ = shape.flipped;
}

void GpuMesh::update_radiosity(std::span<const glm::vec3> radiosity, uint64_t generation, StageClock& clock) {
  if (!radiosity_memo_.renew(generation)) {
    clock.sleep("upload");
    return;
  }
  clock.run("upload", [&] {
    glBindVertexArray(vertex_array_.id());
    fill_attribute(radiosity_, ATTRIBUTE_RADIOSITY, radiosity);
  });
}

void GpuMesh::update_irradiance(std::span<const glm::vec3> irradiance, const void* source, uint64_t generation,
                                StageClock& clock) {
  if (!irradiance_memo_.renew({source, generation})) {
    clock.sleep("upload");
    return;
  }
  clock.run("upload", [&] {
    glBindVertexArray(vertex_array_.id());
    fill_attribute(irradiance_, ATTRIBUTE_IRRADIANCE, irradiance);
  });
}

void GpuMesh::fill_attributes(const geometry::SurfaceAttributes& attributes) {
  glBindVertexArray(vertex_array_.id());
  if (!attributes.texture_coordinates.empty()) {
    fill_attribute<glm::vec2>(texture_coordinates_, ATTRIBUTE_TEXTURE_COORDINATE, attributes.texture_coordinates);
  }
  if (!attributes.colors.empty()) fill_attribute<glm::vec3>(colors_, ATTRIBUTE_COLOR, attributes.colors);
}

void GpuMesh::draw(bool facing_only, bool mirrored) const {
  if (facing_only) glEnable(GL_CULL_FACE);
  glFrontFace(flipped_ != mirrored ? GL_CW : GL_CCW);
  glBindVertexArray(vertex_array_.id());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_CULL_FACE);
}

}  // namespace diaphane::render
