// Pictures put together.
#include "media/picture.h"

#include <gmock/gmock.h>

#include "media/sheet.h"

namespace diaphane::media {
namespace {

using testing::ElementsAre;

std::vector<int> pixel(const Picture& picture, int x, int y) {
  const auto* p = &picture.rgba[4 * static_cast<size_t>(y * picture.width_px + x)];
  return {p[0], p[1], p[2], p[3]};
}

TEST(Picture, LiesOverAnotherByItsAlphaAndIsCutAtTheEdge) {
  Picture under = filled(4, 4, {100, 100, 100});
  Picture glass = filled(3, 3, {200, 0, 100});
  for (size_t i = 3; i < glass.rgba.size(); i += 4) glass.rgba[i] = 51;  // a fifth
  draw_over(glass, 2, -1, under);
  EXPECT_THAT(pixel(under, 2, 0), ElementsAre(120, 80, 100, 255));
  EXPECT_THAT(pixel(under, 3, 1), ElementsAre(120, 80, 100, 255));
  EXPECT_THAT(pixel(under, 1, 0), ElementsAre(100, 100, 100, 255));
  EXPECT_THAT(pixel(under, 2, 2), ElementsAre(100, 100, 100, 255));
}

TEST(Picture, StandsBesideOthersAsHighAsTheHighest) {
  const Picture both = beside(std::vector{filled(2, 3, {1, 2, 3}), filled(4, 1, {4, 5, 6})});
  EXPECT_EQ(both.width_px, 6);
  EXPECT_EQ(both.height_px, 3);
  EXPECT_THAT(pixel(both, 1, 2), ElementsAre(1, 2, 3, 255));
  EXPECT_THAT(pixel(both, 2, 0), ElementsAre(4, 5, 6, 255));
  EXPECT_THAT(pixel(both, 5, 1), ElementsAre(kBackground.r, kBackground.g, kBackground.b, 255));
}

TEST(Picture, KeepsItsColourAndProportionsWhenShrunk) {
  // Covered on the left alone, by white; what is not covered is black, and must not darken the white.
  Picture picture = filled(40, 20, {255, 255, 255});
  for (int y = 0; y < 20; ++y) {
    for (int x = 20; x < 40; ++x) {
      std::fill_n(picture.rgba.begin() + 4 * (y * 40 + x), 4, uint8_t{0});
    }
  }
  const Picture small = shrunk(picture, 10);
  EXPECT_EQ(small.width_px, 10);
  EXPECT_EQ(small.height_px, 5);
  EXPECT_THAT(pixel(small, 1, 2), ElementsAre(255, 255, 255, 255));
  EXPECT_EQ(pixel(small, 8, 2)[3], 0);
  for (int x = 0; x < 10; ++x) {
    if (pixel(small, x, 2)[3] > 25) {
      EXPECT_GT(pixel(small, x, 2)[0], 245) << x;
    }
  }
  EXPECT_EQ(shrunk(picture, 40).rgba, picture.rgba);
}

TEST(Picture, RefusesWhatIsNone) { EXPECT_TRUE(absl::IsInvalidArgument(decode_picture("no picture").status())); }

TEST(ContactSheet, GivesEverySeriesRowsOfItsOwn) {
  const Cell red{filled(8, 8, {255, 0, 0}), ""};
  const Cell green{filled(8, 8, {0, 255, 0}), ""};
  const std::vector<std::vector<Cell>> series = {{red, red, red}, {green}};
  const auto sheet = contact_sheet(series, {.cell_px = 8, .columns = 2});
  ASSERT_TRUE(sheet.ok()) << sheet.status();
  EXPECT_EQ(sheet->width_px, 4 + 2 * 12);
  EXPECT_EQ(sheet->height_px, 4 + 3 * 12);
  EXPECT_THAT(pixel(*sheet, 20, 8), ElementsAre(255, 0, 0, 255));
  EXPECT_THAT(pixel(*sheet, 8, 20), ElementsAre(255, 0, 0, 255));
  EXPECT_THAT(pixel(*sheet, 20, 20), ElementsAre(kBackground.r, kBackground.g, kBackground.b, 255));
  EXPECT_THAT(pixel(*sheet, 8, 32), ElementsAre(0, 255, 0, 255));
}

TEST(ContactSheet, RefusesToBeEmpty) { EXPECT_TRUE(absl::IsInvalidArgument(contact_sheet({}, {}).status())); }

}  // namespace
}  // namespace diaphane::media
