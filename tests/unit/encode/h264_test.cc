#include "encode/h264.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/h264_decoder.h"

namespace diaphane::encode {
namespace {

using testing_support::DecodedFrame;
using testing_support::H264Decoder;

class H264 : public ::testing::Test {
 protected:
  void SetUp() override {
    if (h264_encoder().empty()) GTEST_SKIP() << "no encoder of H.264 here";
  }
};

/// A bright disc on its way over a noisy ground, half transparent beside it.
base::Image8 picture(int frame, uint32_t width_px = 96, uint32_t height_px = 64) {
  base::Image8 image{width_px, height_px, {}};
  uint32_t noise = 12345 + static_cast<uint32_t>(frame);
  const double cx = width_px * (0.5 + 0.4 * std::sin(0.1 * frame)),
               cy = height_px * (0.5 + 0.4 * std::cos(0.13 * frame));
  for (uint32_t y = 0; y < height_px; ++y) {
    for (uint32_t x = 0; x < width_px; ++x) {
      noise = 1664525 * noise + 1013904223;
      const bool inside = std::hypot(x - cx, y - cy) < 0.2 * height_px;
      const auto grey = static_cast<uint8_t>(inside ? 220 : 40 + (noise >> 27));
      for (const uint8_t value : {grey, grey, static_cast<uint8_t>(grey / 2), static_cast<uint8_t>(255)}) {
        image.rgba.push_back(value);
      }
    }
  }
  return image;
}

/// BT.709, limited range, over black.
double mean_luma(const base::Image8& image) {
  double sum = 0;
  for (size_t i = 0; i < image.rgba.size(); i += 4) {
    const double alpha = image.rgba[i + 3] / 255.0;
    sum += alpha * (0.2126 * image.rgba[i] + 0.7152 * image.rgba[i + 1] + 0.0722 * image.rgba[i + 2]);
  }
  return 16 + 219.0 / 255 * sum / (image.rgba.size() / 4.0);
}

TEST_F(H264, EveryFrameComesOutAsItGoesInAndDecodes) {
  H264Encoder encoder;
  H264Decoder decoder;
  for (int i = 0; i < 300; ++i) {
    const base::Image8 image = picture(i);
    const auto frame = encoder.encode(image, {});
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->bytes.substr(0, 3), std::string("\0\0\0", 3)) << "no start code";
    EXPECT_EQ(frame->key_frame, i % 300 == 0) << i;
    const auto decoded = decoder.decode(frame->bytes);
    ASSERT_TRUE(decoded.has_value()) << "frame " << i;
    EXPECT_EQ(decoded->width_px, 96);
    EXPECT_EQ(decoded->height_px, 64);
    EXPECT_NEAR(decoded->mean_luma, mean_luma(image), 2) << "frame " << i;
  }
}

TEST_F(H264, AKeyFrameThatIsAskedForDecodesByItself) {
  H264Encoder encoder;
  for (int i = 0; i < 20; ++i) {
    const bool wanted = i == 7 || i == 15;
    const auto frame = encoder.encode(picture(i), {.key_frame = wanted});
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->key_frame, i == 0 || wanted) << i;
    const auto alone = H264Decoder().decode(frame->bytes);
    EXPECT_EQ(alone.has_value() && alone->key_frame, i == 0 || wanted) << i;
  }
}

TEST_F(H264, KeepsToItsBitrateAndToAnotherOneFromThenOn) {
  H264Encoder encoder;
  int shown = 0;
  const auto bits_of = [&](uint32_t bits_per_second) {
    size_t bytes = 0;
    constexpr int kFrames = 4 * kVideoRate, kSettling = kVideoRate;
    for (int i = 0; i < kFrames; ++i) {
      const auto frame = encoder.encode(picture(shown++, 320, 240), {bits_per_second});
      EXPECT_TRUE(frame.ok()) << frame.status();
      EXPECT_EQ(frame->key_frame, shown == 1 || (shown - 1) % (10 * kVideoRate) == 0);
      if (i >= kSettling) bytes += frame->bytes.size();
    }
    return 8.0 * static_cast<double>(bytes) * kVideoRate / (kFrames - kSettling);
  };
  const double high = bits_of(2'000'000), low = bits_of(400'000), again = bits_of(2'000'000);
  EXPECT_NEAR(high / 2'000'000, 1, 0.25);
  EXPECT_NEAR(low / 400'000, 1, 0.25);
  EXPECT_NEAR(again / 2'000'000, 1, 0.25);
}

TEST_F(H264, AnotherSizeBeginsWithAKeyFrame) {
  H264Encoder encoder;
  H264Decoder decoder;
  EXPECT_TRUE(decoder.decode(encoder.encode(picture(0), {})->bytes).has_value());
  const auto frame = encoder.encode(picture(1, 128, 32), {});
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_TRUE(frame->key_frame);
  const auto decoded = decoder.decode(frame->bytes);
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->width_px, 128);
  EXPECT_EQ(decoded->height_px, 32);
}

TEST_F(H264, LaysWhatIsTransparentOverBlack) {
  base::Image8 image = picture(0);
  for (size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 0;
  H264Encoder encoder;
  EXPECT_NEAR(H264Decoder().decode(encoder.encode(image, {})->bytes)->mean_luma, 16, 0.5);
}

}  // namespace
}  // namespace diaphane::encode
