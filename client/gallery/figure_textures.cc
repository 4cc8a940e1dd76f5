#include <algorithm>
#include <cmath>
#include <numbers>

#include "diaphane/framing.h"
#include "fmt/format.h"
#include "gallery/figures.h"

namespace diaphane::gallery {
namespace {

constexpr double kHeight_mm = 40;
constexpr uint32_t kSide_px = 512;
constexpr float kTiles = 7;  // over the body's largest side
constexpr float kPi = std::numbers::pi_v<float>;

/// A picture of kSide_px, code(u, v) at each pixel.
template <typename Code>
TextureData picture(const Code& code, bool srgb) {
  TextureData texture{.width_px = kSide_px, .height_px = kSide_px, .srgb = srgb};
  texture.rgba.reserve(size_t{4} * kSide_px * kSide_px);
  for (uint32_t row = 0; row < kSide_px; ++row) {
    for (uint32_t column = 0; column < kSide_px; ++column) {
      const Rgb value =
          code((static_cast<float>(column) + 0.5f) / kSide_px, (static_cast<float>(row) + 0.5f) / kSide_px);
      for (const float channel : {value.r, value.g, value.b, 1.0f}) {
        texture.rgba.push_back(static_cast<uint8_t>(std::lround(255 * std::clamp(channel, 0.0f, 1.0f))));
      }
    }
  }
  return texture;
}

/// 0 off a line, 1 on it.
float on_line(float distance, float half_width) {
  return std::clamp((half_width - distance) / 0.015f + 0.5f, 0.0f, 1.0f);
}

/// A tile of painted porcelain: rings that meet, a dot in each and one between.
TextureData cobalt() {
  const auto paint = [](float u, float v) {
    float ink = 0;
    for (const float x : {0.0f, 1.0f}) {
      for (const float y : {0.0f, 1.0f}) ink = std::max(ink, on_line(std::abs(std::hypot(u - x, v - y) - 0.5f), 0.03f));
    }
    const float r = std::hypot(u - 0.5f, v - 0.5f), angle = std::atan2(v - 0.5f, u - 0.5f);
    ink = std::max(ink, on_line(r - 0.16f - 0.05f * std::cos(4 * angle), 0.0f));
    for (const float x : {0.0f, 1.0f}) {
      for (const float y : {0.0f, 1.0f}) ink = std::max(ink, on_line(std::hypot(u - x, v - y), 0.08f));
    }
    return Rgb{1 - 0.9f * ink, 1 - 0.75f * ink, 1 - 0.35f * ink};
  };
  return picture(paint, true);
}

/// Waves of a few degrees in both directions.
TextureData hammered() {
  const auto normal = [](float u, float v) {
    const float x = 0.22f * std::sin(2 * kPi * u) * std::cos(2 * kPi * v);
    const float y = -0.22f * std::cos(2 * kPi * u) * std::sin(2 * kPi * v);
    const float z = 1 / std::sqrt(1 + x * x + y * y);
    return Rgb{(127 * x * z + 128) / 255, (127 * y * z + 128) / 255, (127 * z + 128) / 255};
  };
  return picture(normal, false);
}

/// Matt bands on a polished body.
TextureData bands() {
  const auto root = [](float, float v) { return Rgb{0, v < 0.5f ? 0.3f : 1.0f, 0}; };
  return picture(root, false);
}

/// Pictures lie on the body as if thrown on it from its front.
std::vector<TextureCoordinate> thrown_from_the_front(const MeshData& mesh) {
  Vec3 lowest = mesh.positions.front(), highest = lowest;
  for (const Vec3& p : mesh.positions) {
    lowest = {std::min(lowest.x, p.x), std::min(lowest.y, p.y), 0};
    highest = {std::max(highest.x, p.x), std::max(highest.y, p.y), 0};
  }
  const float scale = kTiles / std::max(highest.x - lowest.x, highest.y - lowest.y);
  std::vector<TextureCoordinate> coordinates;
  coordinates.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) coordinates.push_back({scale * (p.x - lowest.x), scale * (highest.y - p.y)});
  return coordinates;
}

}  // namespace

absl::StatusOr<Section> figure_textures(const Studio& studio, const FigureOptions& options) {
  Section section{.id = "textures", .title = "Painted porcelain"};
  section.paragraphs = {
      fmt::format("Porcelain, {} mm high, with pictures that this program makes. The albedo multiplies what leaves the "
                  "body, once: light spreads below the paint. The normal map turns the coat alone, and the roughness "
                  "map makes half of each tile matt. By the integral, one lamp and its shadows.",
                  kHeight_mm)};
  struct Entry {
    const char* name;
    const char* caption;
    bool painted, coated, hammered, banded;
  };
  const Entry entries[] = {{"none", "without pictures", false, false, false, false},
                           {"albedo", "albedo", true, false, false, false},
                           {"normal", "albedo, coat with a normal map", true, true, true, false},
                           {"roughness", "albedo, coat with a roughness map", true, true, false, true}};
  std::optional<double> ev;
  section.rows.emplace_back();
  for (const Entry& entry : entries) {
    const std::optional<Coat> coat = entry.coated ? std::optional(Coat{entry.banded ? 0.5f : 0.08f}) : std::nullopt;
    absl::StatusOr<Still> still =
        portrait(options.mesh, {"porcelain", Profile::kDipole, coat, {}}, kHeight_mm, options.size_px);
    if (!still.ok()) return still.status();
    if (absl::Status lit = add_lamp({-0.6f, 0.8f, 1}, 3, &*still); !lit.ok()) return lit;
    Body& body = still->bodies.front();
    body.mesh.texture_coordinates = thrown_from_the_front(body.mesh);
    if (entry.painted) body.pictures.albedo = cobalt();
    if (entry.hammered) body.pictures.normal = hammered();
    if (entry.banded) body.pictures.roughness = bands();
    RenderSettings settings = by_integral();
    settings.samples = 4;
    const absl::StatusOr<std::vector<LinearFrame>> frames = studio.shoot(*still, {&settings, 1});
    if (!frames.ok()) return frames.status();
    const LinearFrame* plain = &frames->front();
    if (!ev) ev = exposure_for({&plain, 1});
    section.rows.back().push_back({fmt::format("texture_{}", entry.name), developed(*plain, *ev), entry.caption});
    section.facts["mean_luminance"][entry.name] = mean_luminance(*plain);
  }
  return section;
}

}  // namespace diaphane::gallery
