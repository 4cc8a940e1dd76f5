#include "media/picture.h"

#include <algorithm>

namespace diaphane::media {
namespace {

size_t offset_of(const Picture& picture, int x, int y) {
  return 4 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width_px) + static_cast<size_t>(x));
}

}  // namespace

Picture filled(int width_px, int height_px, const Colour& colour) {
  Picture picture{width_px, height_px, {}};
  picture.rgba.resize(4 * static_cast<size_t>(width_px) * static_cast<size_t>(height_px));
  for (size_t i = 0; i < picture.rgba.size(); i += 4) {
    picture.rgba[i] = colour.r;
    picture.rgba[i + 1] = colour.g;
    picture.rgba[i + 2] = colour.b;
    picture.rgba[i + 3] = 255;
  }
  return picture;
}

void draw_over(const Picture& picture, int x, int y, Picture& under) {
  const int first_column = std::max(0, -x);
  const int last_column = std::min(picture.width_px, under.width_px - x);
  for (int row = std::max(0, -y); row < std::min(picture.height_px, under.height_px - y); ++row) {
    for (int column = first_column; column < last_column; ++column) {
      const uint8_t* from = &picture.rgba[offset_of(picture, column, row)];
      uint8_t* to = &under.rgba[offset_of(under, x + column, y + row)];
      const unsigned alpha = from[3];
      for (int c = 0; c < 3; ++c) to[c] = static_cast<uint8_t>((from[c] * alpha + to[c] * (255 - alpha) + 127) / 255);
      to[3] = static_cast<uint8_t>(alpha + (to[3] * (255 - alpha) + 127) / 255);
    }
  }
}

Picture over(const Picture& picture, const Colour& background) {
  Picture under = filled(picture.width_px, picture.height_px, background);
  draw_over(picture, 0, 0, under);
  return under;
}

Picture beside(std::span<const Picture> pictures) {
  int width = 0;
  int height = 0;
  for (const Picture& picture : pictures) {
    width += picture.width_px;
    height = std::max(height, picture.height_px);
  }
  Picture all = filled(width, height, kBackground);
  int x = 0;
  for (const Picture& picture : pictures) {
    draw_over(picture, x, 0, all);
    x += picture.width_px;
  }
  return all;
}

}  // namespace diaphane::media
