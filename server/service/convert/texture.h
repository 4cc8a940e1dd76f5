// Textures to and from the contract.
#pragma once

#include <span>

#include "absl/status/statusor.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"
#include "service/convert/upload.h"

namespace diaphane::service {

/// What a header says of a texture.
struct TextureSpec {
  uint32_t width_px = 0;
  uint32_t height_px = 0;
  scene::TextureSampling sampling;
  PayloadSpec payload;
};

absl::StatusOr<TextureSpec> from_proto(const v1::TextureHeader& message);

/// `bytes` are what the spec says.
scene::Texture read_texture(const TextureSpec& spec, std::span<const char> bytes);

void to_proto(const scene::Texture& texture, v1::Texture& message);
void to_proto(const scene::Changed<scene::Texture>& changed, v1::TextureResponse& message);

}  // namespace diaphane::service
