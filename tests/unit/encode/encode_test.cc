#include "encode/encode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "encode/srgb_profile.h"
#include "webp/decode.h"

namespace diaphane::encode {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

struct Decoded {
  OIIO::ImageSpec spec;
  std::vector<float> values;  // as stored: 0..1 for 8-bit formats
};

Decoded decode(const std::string& bytes, const char* name) {
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  void* proxy = &memory;
  OIIO::ImageSpec config;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(name, &config);
  if (input == nullptr) {
    ADD_FAILURE() << OIIO::geterror();
    return {};
  }
  Decoded decoded{input->spec(), {}};
  decoded.values.resize(decoded.spec.image_pixels() * decoded.spec.nchannels);
  EXPECT_TRUE(input->read_image(0, 0, 0, decoded.spec.nchannels, OIIO::TypeFloat, decoded.values.data()))
      << input->geterror();
  return decoded;
}

base::Image8 half_transparent(uint32_t width_px, uint32_t height_px) {
  base::Image8 image{width_px, height_px, {}};
  for (uint32_t i = 0; i < width_px * height_px; ++i) {
    for (const uint32_t value : {200u, i % 256, 40u, 128u}) image.rgba.push_back(static_cast<uint8_t>(value));
  }
  return image;
}

TEST(EncodePng, KeepsEveryByteUnderPartialAlpha) {
  const base::Image8 image = half_transparent(5, 3);
  const Decoded decoded = decode(*encode_png(image), "a.png");
  ASSERT_EQ(decoded.spec.width, 5);
  ASSERT_EQ(decoded.spec.height, 3);
  ASSERT_EQ(decoded.spec.nchannels, 4);
  for (size_t i = 0; i < image.rgba.size(); ++i) {
    ASSERT_EQ(std::lround(decoded.values[i] * 255), image.rgba[i]) << "byte " << i;
  }
}

TEST(EncodeJpeg, LaysColoursOverBlack) {
  base::Image8 image{16, 16, {}};
  for (int i = 0; i < 256; ++i) image.rgba.insert(image.rgba.end(), {200, 200, 200, 128});
  const Decoded decoded = decode(*encode_jpeg(image, 95), "a.jpg");
  ASSERT_EQ(decoded.spec.nchannels, 3);
  EXPECT_NEAR(decoded.values[0] * 255, 200 * 128 / 255.0, 1.5);
}

TEST(EncodeJpeg, CarriesTheProfileOfSrgb) {
  const Decoded decoded = decode(*encode_jpeg(half_transparent(16, 16), 90), "a.jpg");
  const OIIO::ParamValue* found = decoded.spec.find_attribute("ICCProfile");
  ASSERT_NE(found, nullptr);
  const std::vector<uint8_t>& profile = srgb_profile();
  ASSERT_EQ(static_cast<size_t>(found->datasize()), profile.size());
  EXPECT_TRUE(std::equal(profile.begin(), profile.end(), static_cast<const uint8_t*>(found->data())));
}

TEST(EncodePng, SaysSrgb) { EXPECT_THAT(*encode_png(half_transparent(4, 4)), HasSubstr("sRGB")); }

TEST(SrgbProfile, HasTagsWithinItAndPrimariesThatAddUpToItsWhite) {
  const std::vector<uint8_t>& profile = srgb_profile();
  const auto u32 = [&](size_t at) {
    uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i) value = value << 8 | profile.at(at + i);
    return value;
  };
  ASSERT_EQ(u32(0), profile.size());
  double sum[3] = {};
  std::map<std::string, uint32_t> tags;
  for (uint32_t i = 0; i < u32(128); ++i) {
    const size_t entry = 132 + 12 * size_t{i};
    tags[std::string(profile.begin() + static_cast<ptrdiff_t>(entry),
                     profile.begin() + static_cast<ptrdiff_t>(entry) + 4)] = u32(entry + 4);
    EXPECT_EQ(u32(entry + 4) % 4, 0u);
    EXPECT_LE(u32(entry + 4) + u32(entry + 8), profile.size());
  }
  for (const char* primary : {"rXYZ", "gXYZ", "bXYZ"}) {
    for (size_t axis = 0; axis < 3; ++axis) sum[axis] += u32(tags.at(primary) + 8 + 4 * axis) / 65536.0;
  }
  for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(sum[axis], u32(tags.at("wtpt") + 8 + 4 * axis) / 65536.0, 2e-4);
}

TEST(EncodeJpeg, IsSmallerAtALowerQuality) {
  const base::Image8 image = half_transparent(64, 64);
  EXPECT_LT(encode_jpeg(image, 20)->size(), encode_jpeg(image, 95)->size());
}

TEST(EncodeJpeg, LiesOverBlackAndIsNearItsPicture) {
  base::Image8 image{16, 16, {}};
  for (int i = 0; i < 256; ++i) image.rgba.insert(image.rgba.end(), {200, 100, 50, 128});
  const Decoded decoded = decode(*encode_jpeg(image, 95), "a.jpg");
  ASSERT_EQ(decoded.spec.nchannels, 3);
  EXPECT_NEAR(decoded.values[0] * 255, 100, 3);
  EXPECT_NEAR(decoded.values[1] * 255, 50, 3);
  EXPECT_NEAR(decoded.values[2] * 255, 25, 3);
}

TEST(EncodeWebp, KeepsAlphaAndIsNearItsPicture) {
  base::Image8 image{32, 16, {}};
  for (int i = 0; i < 512; ++i) {
    image.rgba.insert(image.rgba.end(), {200, 100, 50, static_cast<uint8_t>(i % 32 < 16 ? 255 : 128)});
  }
  const std::string bytes = *encode_webp(image, 95);
  int width = 0, height = 0;
  const std::unique_ptr<uint8_t, void (*)(void*)> decoded(
      WebPDecodeRGBA(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), &width, &height), WebPFree);
  ASSERT_NE(decoded, nullptr);
  ASSERT_EQ(width, 32);
  ASSERT_EQ(height, 16);
  for (size_t i = 0; i < image.rgba.size(); ++i) {
    EXPECT_NEAR(decoded.get()[i], image.rgba[i], i % 4 == 3 ? 0 : 8) << "byte " << i;
  }
}

TEST(EncodeWebp, IsSmallerAtALowerQuality) {
  const base::Image8 image = half_transparent(64, 64);
  EXPECT_LT(encode_webp(image, 20)->size(), encode_webp(image, 95)->size());
}

TEST(EncodeExr, KeepsEveryFloat) {
  const float largest = std::numeric_limits<float>::max();
  const base::ImageF image{2, 1, {"R", "G", "B", "A"}, {1e-30f, -2.5f, largest, 1, 0.1f, 7e8f, 0, 0.25f}};
  const Decoded decoded = decode(*encode_exr(image), "a.exr");
  EXPECT_EQ(decoded.spec.format, OIIO::TypeFloat);
  EXPECT_EQ(decoded.values, image.values);
  EXPECT_THAT(decoded.spec.channelnames, ElementsAre("R", "G", "B", "A"));
}

TEST(EncodeExr, KeepsTheNamesOfOtherChannels) {
  const base::ImageF image{1, 1, {"R", "G", "B", "A", "Z"}, {1, 2, 3, 1, 9}};
  EXPECT_THAT(decode(*encode_exr(image), "a.exr").spec.channelnames, ElementsAre("R", "G", "B", "A", "Z"));
}

TEST(EncodeExr, KeepsLayersAndInfinity) {
  const float infinity = std::numeric_limits<float>::infinity();
  const base::ImageF image{
      1, 1, {"R", "G", "B", "A", "N.X", "N.Y", "N.Z", "Z", "irradiance.R"}, {1, 2, 3, 0, -1, 0, 0.5f, infinity, 7}};
  const Decoded decoded = decode(*encode_exr(image), "a.exr");
  const auto value = [&](const std::string& name) {
    const int index = decoded.spec.channelindex(name);
    return index < 0 ? std::numeric_limits<float>::quiet_NaN() : decoded.values[static_cast<size_t>(index)];
  };
  EXPECT_EQ(decoded.spec.format, OIIO::TypeFloat);
  for (size_t i = 0; i < image.channels.size(); ++i) EXPECT_EQ(value(image.channels[i]), image.values[i]);
}

TEST(Encode, WritesNothingButTheImage) {
  const base::ImageF linear{1, 1, {"R", "G", "B", "A"}, {1, 2, 3, 1}};
  for (const std::string& bytes :
       {*encode_png(half_transparent(8, 8)), *encode_jpeg(half_transparent(8, 8), 90), *encode_exr(linear)}) {
    for (const char* word : {"DateTime", "Software", "OpenImageIO", "tIME", "HostComputer"}) {
      EXPECT_THAT(bytes, Not(HasSubstr(word)));
    }
  }
}

TEST(EncodeExr, LeavesTheTimeOfDayOut) {
  const Decoded decoded = decode(*encode_exr({1, 1, {"R", "G", "B", "A"}, {1, 2, 3, 1}}), "a.exr");
  EXPECT_EQ(decoded.spec.get_string_attribute("DateTime"), "");
}

TEST(Encode, GivesTheSameBytesAgain) {
  const base::Image8 image = half_transparent(33, 17);
  EXPECT_EQ(*encode_png(image), *encode_png(image));
  EXPECT_EQ(*encode_jpeg(image, 90), *encode_jpeg(image, 90));
}

TEST(Encode, ReportsAnImageOfNoSize) { EXPECT_EQ(encode_png({}).status().code(), absl::StatusCode::kInternal); }

}  // namespace
}  // namespace diaphane::encode
