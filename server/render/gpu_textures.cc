#include "render/gpu_textures.h"

#include <algorithm>
#include <bit>

#include "render/uniforms.h"

namespace diaphane::render {
namespace {

// The mean of linear light goes into the mip maps: those of an sRGB format are decoded first (GL 4.4, 8.14.4).
void fill(const gl::Texture& texture, const scene::TexturePixels& pixels, const scene::TextureSampling& sampling) {
  const auto levels = static_cast<GLsizei>(std::bit_width(std::max(pixels.width_px, pixels.height_px)));
  const auto width = static_cast<GLsizei>(pixels.width_px), height = static_cast<GLsizei>(pixels.height_px);
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexStorage2D(GL_TEXTURE_2D, levels, sampling.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, width, height);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, sampling.clamp_u ? GL_CLAMP_TO_EDGE : GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, sampling.clamp_v ? GL_CLAMP_TO_EDGE : GL_REPEAT);
}

}  // namespace

void GpuTextures::update(const scene::SceneSnapshot& scene, const scene::SurfaceTextures& textures, StageClock& clock) {
  glActiveTexture(GL_TEXTURE0 + UNIT_ALBEDO);
  if (white_ == nullptr) {
    white_ = std::make_unique<gl::Texture>();
    fill(*white_, {1, 1, {255, 255, 255, 255}}, {});
  }
  for (const std::string* name : {&textures.albedo, &textures.normal, &textures.roughness}) {
    const scene::Texture* texture = scene::texture_of(scene, *name);
    if (texture == nullptr || textures_.contains(*name)) continue;
    clock.run("upload", [&] {
      Entry& entry = textures_[*name];
      entry.pixels = texture->pixels;
      fill(entry.texture, *texture->pixels, texture->sampling);
    });
  }
}

void GpuTextures::bind(GLuint unit, const std::string& name) {
  const auto found = textures_.find(name);
  gl::bind_texture(unit, GL_TEXTURE_2D, found == textures_.end() ? *white_ : found->second.texture);
}

void GpuTextures::bind(const scene::SurfaceTextures& textures) {
  bind(UNIT_ALBEDO, textures.albedo);
  bind(UNIT_NORMAL, textures.normal);
  bind(UNIT_ROUGHNESS, textures.roughness);
}

void GpuTextures::forget_orphans() {
  std::erase_if(textures_, [](const auto& entry) { return entry.second.pixels.expired(); });
}

}  // namespace diaphane::render
