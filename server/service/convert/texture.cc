#include "service/convert/texture.h"

#include <memory>
#include <utility>

#include "base/status.h"
#include "fmt/format.h"
#include "service/convert/check.h"
#include "service/sha256.h"

namespace diaphane::service {
namespace {

constexpr uint32_t kLargestSize_px = 8192;

}  // namespace

absl::StatusOr<TextureSpec> from_proto(const v1::TextureHeader& message) {
  const v1::Texture& texture = message.texture();
  absl::Status size = check_range("texture.width_px", texture.width_px(), 1, kLargestSize_px);
  if (size.ok()) size = check_range("texture.height_px", texture.height_px(), 1, kLargestSize_px);
  if (!size.ok()) return size;
  const uint64_t needed = uint64_t{4} * texture.width_px() * texture.height_px();
  if (message.total_bytes() != needed) {
    return base::invalid_field("total_bytes", fmt::format("{}, as the size says", needed),
                               fmt::format("{}", message.total_bytes()));
  }
  if (message.sha256().size() != Sha256::kBytes) {
    return base::invalid_field("sha256", "32 bytes", fmt::format("{} bytes", message.sha256().size()));
  }
  return TextureSpec{texture.width_px(),
                     texture.height_px(),
                     {texture.srgb(), texture.clamp_u(), texture.clamp_v()},
                     PayloadSpec{{}, needed, message.sha256()}};
}

scene::Texture read_texture(const TextureSpec& spec, std::span<const char> bytes) {
  scene::TexturePixels pixels{spec.width_px, spec.height_px, {bytes.begin(), bytes.end()}};
  return {{}, std::make_shared<const scene::TexturePixels>(std::move(pixels)), spec.sampling};
}

void to_proto(const scene::Texture& texture, v1::Texture& message) {
  message.set_name(texture.name);
  message.set_width_px(texture.pixels->width_px);
  message.set_height_px(texture.pixels->height_px);
  message.set_srgb(texture.sampling.srgb);
  message.set_clamp_u(texture.sampling.clamp_u);
  message.set_clamp_v(texture.sampling.clamp_v);
}

void to_proto(const scene::Changed<scene::Texture>& changed, v1::TextureResponse& message) {
  to_proto(changed.value, *message.mutable_texture());
  message.set_scene_revision(changed.scene_revision);
}

}  // namespace diaphane::service
