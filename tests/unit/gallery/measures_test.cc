// What the gallery measures, on frames that are known.
#include <gmock/gmock.h>

#include <cmath>

#include "gallery/errors.h"
#include "gallery/histogram.h"
#include "gallery/page.h"

namespace diaphane::gallery {
namespace {

using testing::HasSubstr;

// Grey pixels in a row; below 0: no surface.
LinearFrame frame_of(const std::vector<float>& greys) {
  LinearFrame frame{static_cast<int>(greys.size()), 1, {}, {}, {}};
  for (const float grey : greys) {
    const float shown = std::max(grey, 0.0f);
    frame.radiance.push_back({shown, shown, shown});
    frame.covered.push_back(grey >= 0 ? 1 : 0);
    frame.position.push_back({static_cast<float>(frame.position.size()), 0, 0});
  }
  return frame;
}

TEST(MeanLuminance, CountsTheBodyAndTheRegionAlone) {
  const LinearFrame frame = frame_of({-1, 1, 2, 6});
  EXPECT_NEAR(mean_luminance(frame), 3, 1e-6);
  EXPECT_NEAR(mean_luminance(frame, [](const Vec3& p) { return p.x < 2.5f; }), 1.5, 1e-6);
  EXPECT_EQ(mean_luminance(frame, [](const Vec3&) { return false; }), 0);
}

TEST(Developed, DoublesWithEveryStopAndEncodesSrgb) {
  const LinearFrame frame = frame_of({0.25f, -1});
  EXPECT_EQ(developed(frame, 2).rgba[0], 255);
  EXPECT_EQ(developed(frame, 0).rgba[0], 137);  // sRGB of 0.25
  EXPECT_EQ(developed(frame, 0).rgba[4], media::kBackground.r);
}

TEST(Exposure, MakesTheBrightestLightGrey) {
  const LinearFrame dim = frame_of(std::vector<float>(100, 0.01f));
  const LinearFrame* frames[] = {&dim};
  const uint8_t shown = developed(dim, exposure_for(frames)).rgba[0];
  EXPECT_GT(shown, 200);
  EXPECT_LT(shown, 240);
}

TEST(Histogram, MeasuresHowFarLumaIsShifted) {
  const LinearFrame frame = frame_of({0.1f, 0.2f, 0.4f, -1});
  const Histogram histogram = luma_histogram(frame, 0);
  double sum = 0;
  for (const double share : histogram) sum += share;
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_EQ(levels_apart(histogram, histogram), 0);
  // All from one bin to the tenth after it.
  Histogram a{};
  Histogram b{};
  a[5] = 1;
  b[15] = 1;
  EXPECT_NEAR(levels_apart(a, b), 40, 1e-9);
  EXPECT_NEAR(levels_apart(b, a), 40, 1e-9);
}

TEST(Errors, AreSharesOfTheMean) {
  const LinearFrame right = frame_of({1, 3, -1});
  const LinearFrame frame = frame_of({1, 4, 9});
  const Errors errors = errors_of(frame, right);
  EXPECT_NEAR(errors.rms_percent.g, 100 * std::sqrt(0.5 * 0.25), 1e-3);
  EXPECT_NEAR(errors.largest, 50, 1e-3);
  EXPECT_EQ(errors_of(right, right).largest, 0);
  // The brightest colour of the scale and the darkest.
  const media::Picture picture = error_picture(frame, right, 50);
  const media::Picture scale = media::Picture(colour_scale(16, 1));
  EXPECT_TRUE(std::equal(&picture.rgba[0], &picture.rgba[3], &scale.rgba[0]));
  EXPECT_TRUE(std::equal(&picture.rgba[4], &picture.rgba[7], &scale.rgba[size_t{4} * 15]));
}

TEST(Page, EscapesWhatItIsGiven) { EXPECT_EQ(escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;"); }

}  // namespace
}  // namespace diaphane::gallery
