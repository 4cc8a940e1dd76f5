#include "render/develop.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "glm/common.hpp"
#include "render/sample_pattern.h"

namespace diaphane::render {
namespace {

using ::testing::ElementsAre;

base::ImageF picture_of(std::vector<float> values) {
  const auto width = static_cast<uint32_t>(values.size() / 4);
  return {width, 1, {"R", "G", "B", "A"}, std::move(values)};
}

TEST(ToneMapNeutral, KeepsColoursUpToItsShoulder) {
  for (const glm::vec3& colour : {glm::vec3(0), glm::vec3(0.8f, 0.1f, 0.3f), glm::vec3(0.05f)}) {
    EXPECT_EQ(tone_map_neutral(colour), colour);
  }
}

TEST(ToneMapNeutral, RisesWithoutAStepAndStaysBelowOne) {
  float last = 0;
  for (float x = 0; x < 4; x += 0.001f) {
    const float y = tone_map_neutral(glm::vec3(x, 0.5f * x, 0)).r;
    ASSERT_GE(y, last) << x;
    ASSERT_LT(y - last, 0.0011f) << x;
    ASSERT_LT(y, 1) << x;
    last = y;
  }
}

TEST(ToneMapNeutral, TakesTheColourOutOfWhatIsBright) {
  const auto saturation = [](float peak) {
    const glm::vec3 shown = tone_map_neutral(peak * glm::vec3(1, 0.2f, 0.2f));
    return 1 - shown.g / shown.r;
  };
  EXPECT_NEAR(saturation(0.8f), 0.8f, 1e-6f);
  EXPECT_LT(saturation(4), 0.7f);
  EXPECT_LT(saturation(100), 0.1f);
}

TEST(FindExposure, BringsTheBrightPartOfTheBodyToFourFifths) {
  std::vector<float> values;
  for (int i = 1; i <= 1000; ++i) {
    const float grey = 1e-5f * static_cast<float>(i);
    values.insert(values.end(), {grey, grey, grey, 1, 0, 0, 0, 0});  // and as many pixels of nothing
  }
  EXPECT_NEAR(std::exp2(find_exposure_ev(picture_of(values))) * 0.00980f, 0.8f, 0.002f);
}

TEST(FindExposure, TakesAPartlyCoveredPixelForWhatCoversIt) {
  EXPECT_NEAR(find_exposure_ev(picture_of({0.05f, 0.05f, 0.05f, 0.25f})), 2, 1e-5f);
}

TEST(FindExposure, LeavesNothingAndBlackAlone) {
  EXPECT_EQ(find_exposure_ev(picture_of({0, 0, 0, 0})), 0);
  EXPECT_EQ(find_exposure_ev(picture_of({0, 0, 0, 1})), 0);
}

TEST(LayOver, MixesByAlphaInLinearLight) {
  base::ImageF picture = picture_of({0.25f, 0, 0, 0.25f, 0, 0, 0, 0, 3, 3, 3, 1});
  lay_over({0.4f, 0.8f, 0}, picture);
  const std::vector<float> expected = {0.25f + 0.75f * 0.4f, 0.75f * 0.8f, 0, 1, 0.4f, 0.8f, 0, 1, 3, 3, 3, 1};
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_FLOAT_EQ(picture.values[i], expected[i]) << i;
}

TEST(Develop, GivesColourApartFromAlpha) {
  const base::Image8 image =
      develop(picture_of({0.5f, 0, 0, 0.5f, 0.2140f, 0.2140f, 0.2140f, 1}), 0, ToneMapping::kNone);
  EXPECT_THAT(image.rgba, ElementsAre(255, 0, 0, 128, 127, 127, 127, 255));
}

TEST(Develop, MultipliesByStopsAndShowsOverflowAsWhite) {
  const auto first = [](float value, float ev, ToneMapping tone_mapping) {
    return static_cast<int>(develop(picture_of({value, value, value, 1}), ev, tone_mapping).rgba[0]);
  };
  EXPECT_EQ(first(0.05f, 2, ToneMapping::kNone), first(0.2f, 0, ToneMapping::kNone));
  EXPECT_EQ(first(1e30f, 32, ToneMapping::kNone), 255);
  EXPECT_EQ(first(1e30f, 32, ToneMapping::kNeutral), 255);
}

TEST(SamplePlace, IsTheCentreForOne) { EXPECT_EQ(sample_place(0, 1), glm::vec2(0.5f)); }

TEST(SamplePlace, SharesRowsAndColumnsOutEvenly) {
  for (const uint32_t count : {2u, 3u, 4u, 7u, 16u, 64u}) {
    std::set<uint32_t> columns;
    glm::vec2 sum(0);
    uint32_t lower = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const glm::vec2 place = sample_place(i, count);
      ASSERT_EQ(glm::clamp(place, 0.0f, 1.0f), place);
      columns.insert(static_cast<uint32_t>(place.x * static_cast<float>(count)));
      lower += place.y < 0.5f ? 1 : 0;
      sum += place;
    }
    EXPECT_EQ(columns.size(), count);
    EXPECT_LE(std::abs(2 * static_cast<int>(lower) - static_cast<int>(count)), 1) << count;
    EXPECT_NEAR(sum.x / static_cast<float>(count), 0.5f, 1e-6f);
  }
}

}  // namespace
}  // namespace diaphane::render
