// A frame's tiles, and the passes over each: a sample of every pixel, and its centre for the extra channels.
#include <algorithm>
#include <cstring>
#include <utility>

#include "glm/gtc/matrix_transform.hpp"
#include "render/channels.h"
#include "render/pixels.h"
#include "render/sample_pattern.h"
#include "render/scene_painter.h"

namespace diaphane::render {

/// Moves the picture so that `place` in a pixel comes to be its centre.
void ScenePainter::shift_view(Job& job, const glm::vec2& place) const {
  const glm::vec2 size_px(job.request.width_px, job.request.height_px);
  const glm::vec2 offset = 2.0f * (glm::vec2(0.5f) - place) / size_px;
  job.view.clip_from_world = glm::translate(glm::mat4(1), glm::vec3(offset, 0)) * job.view.clip_from_world;
}

absl::Status ScenePainter::draw_sampled_tile(Job& job, const Tile& tile, uint8_t* pixels) {
  const size_t pixel_count = size_t{tile.width_px} * tile.height_px;
  const uint32_t samples = job.request.settings.samples;
  if (samples == 1) {
    absl::Status drawn = draw_tile(job, tile, pixels);
    job.pixels_done += pixel_count;
    return drawn;
  }
  const glm::mat4 centred = job.view.clip_from_world;
  const ChannelNeeds needs = std::exchange(job.needs, {});
  std::vector<glm::vec4> sum(pixel_count, glm::vec4(0)), sample(pixel_count);
  for (uint32_t i = 0; i < samples; ++i) {
    shift_view(job, sample_place(i, samples));
    if (absl::Status drawn = draw_tile(job, tile, reinterpret_cast<uint8_t*>(sample.data())); !drawn.ok()) return drawn;
    job.view.clip_from_world = centred;
    for (size_t p = 0; p < pixel_count; ++p) sum[p] += sample[p];
    job.pixels_done += pixel_count;
  }
  job.needs = needs;
  if (!job.request.channels.empty()) {
    if (absl::Status drawn = draw_tile(job, tile, pixels); !drawn.ok()) return drawn;
    job.pixels_done += pixel_count;
  }
  for (glm::vec4& pixel : sum) pixel /= static_cast<float>(samples);
  std::memcpy(pixels, sum.data(), sum.size() * sizeof(glm::vec4));
  return absl::OkStatus();
}

absl::Status ScenePainter::draw_tiles(Job& job, Frame& frame) {
  const FrameRequest& request = job.request;
  const uint32_t target_width = std::min(request.width_px, kTile_px);
  const uint32_t target_height = std::min(request.height_px, kTile_px);
  if (!targets_.has_value() || !targets_->fits(target_width, target_height, job.format)) {
    targets_.reset();
    targets_.emplace(target_width, target_height, job.format);
  }
  if (request.settings.samples > 1) job.passes = request.settings.samples + (request.channels.empty() ? 0 : 1);
  const Canvas canvas = make_canvas(frame, request, job.format);
  const bool linear = job.format == PixelFormat::kLinearFloat;
  const size_t pixel_bytes = linear ? sizeof(glm::vec4) : 4;
  std::vector<uint8_t>& pixels = tile_pixels_;
  pixels.resize(size_t{target_width} * target_height * pixel_bytes);
  return for_each_tile(request.width_px, request.height_px, [&](const Tile& tile) {
    absl::Status status = draw_sampled_tile(job, tile, pixels.data());
    if (!status.ok()) return status;
    place_tile(canvas, tile, pixels.data(), pixel_bytes);
    if (linear) store_channels(request, job.channels, tile, std::get<base::ImageF>(frame.image));
    return absl::OkStatus();
  });
}

}  // namespace diaphane::render
