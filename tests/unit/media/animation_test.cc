// Animated files hold the frames that were given.
#include "media/animation.h"

#include <gmock/gmock.h>
#include <stdlib.h>

#include "tests/support/decoders.h"

namespace diaphane::media {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::decode_mp4;
using testing_support::decode_webp;

constexpr int kFrames = 5;

class Animations : public testing::Test {
 protected:
  Animations() {
    std::string pattern = (fs::temp_directory_path() / "diaphane_media_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Animations() override { fs::remove_all(folder_); }

  // Grey that grows brighter: 40, 80, ...
  static void add_frames(AnimationWriter& writer, int width_px, int height_px) {
    for (int i = 1; i <= kFrames; ++i) {
      const auto grey = static_cast<uint8_t>(40 * i);
      ASSERT_TRUE(writer.add(filled(width_px, height_px, {grey, grey, grey})).ok());
    }
  }

  size_t files_left() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(Animations, WebpKeepsEveryFrameInOrder) {
  const fs::path path = folder_ / "a.webp";
  const auto writer = open_webp(path, {.width_px = 64, .height_px = 48});
  ASSERT_TRUE(writer.ok()) << writer.status();
  add_frames(**writer, 64, 48);
  ASSERT_TRUE((*writer)->finish().ok());
  const auto read = decode_webp(path);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->width_px, 64);
  EXPECT_EQ(read->height_px, 48);
  ASSERT_EQ(read->mean.size(), kFrames);
  for (int i = 0; i < kFrames; ++i) EXPECT_NEAR(read->mean[static_cast<size_t>(i)], 40 * (i + 1), 3);
}

TEST_F(Animations, Mp4KeepsEveryFrameInOrderAndCutsWhatIsOdd) {
  const fs::path path = folder_ / "a.mp4";
  const auto writer = open_mp4(path, {.width_px = 65, .height_px = 49});
  if (absl::IsUnimplemented(writer.status()) || absl::IsUnavailable(writer.status())) {
    GTEST_SKIP() << writer.status();
  }
  ASSERT_TRUE(writer.ok()) << writer.status();
  add_frames(**writer, 65, 49);
  ASSERT_TRUE((*writer)->finish().ok());
  const auto read = decode_mp4(path);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->width_px, 64);
  EXPECT_EQ(read->height_px, 48);
  ASSERT_EQ(read->mean.size(), kFrames);
  // Luma of video goes from 16 to 235.
  for (int i = 0; i < kFrames; ++i) EXPECT_NEAR(read->mean[static_cast<size_t>(i)], 16 + 40 * (i + 1) * 219 / 255, 4);
  EXPECT_EQ(files_left(), 1);
}

TEST_F(Animations, DroppedBeforeTheirEndLeaveNothing) {
  {
    const auto webp = open_webp(folder_ / "a.webp", {.width_px = 32, .height_px = 32});
    ASSERT_TRUE(webp.ok());
    add_frames(**webp, 32, 32);
    const auto mp4 = open_mp4(folder_ / "a.mp4", {.width_px = 32, .height_px = 32});
    if (mp4.ok()) add_frames(**mp4, 32, 32);
  }
  EXPECT_EQ(files_left(), 0);
}

TEST_F(Animations, RefuseWhatTheyCannotKeep) {
  const auto message = [&](const AnimationOptions& options) {
    const auto writer = open_webp(folder_ / "a.webp", options);
    EXPECT_TRUE(absl::IsInvalidArgument(writer.status()));
    return std::string(writer.status().message());
  };
  EXPECT_THAT(message({.width_px = 15, .height_px = 32}), HasSubstr("width_px: must be 16..8192, got 15"));
  EXPECT_THAT(message({.width_px = 32, .height_px = 8193}), HasSubstr("height_px"));
  EXPECT_THAT(message({.width_px = 32, .height_px = 32, .frames_per_second = 0}), HasSubstr("frames_per_second"));
  EXPECT_THAT(message({.width_px = 32, .height_px = 32, .quality = 101}), HasSubstr("quality"));
  const auto writer = open_webp(folder_ / "a.webp", {.width_px = 32, .height_px = 32});
  ASSERT_TRUE(writer.ok());
  EXPECT_THAT(std::string((*writer)->add(filled(32, 16, {})).message()), HasSubstr("frame: must be 32x32, got 32x16"));
  EXPECT_TRUE(absl::IsFailedPrecondition((*writer)->finish()));
}

TEST_F(Animations, SayWhereTheyCannotWrite) {
  const auto writer = open_webp(folder_ / "none" / "a.webp", {.width_px = 32, .height_px = 32});
  ASSERT_TRUE(writer.ok());
  add_frames(**writer, 32, 32);
  const absl::Status finished = (*writer)->finish();
  EXPECT_TRUE(absl::IsDataLoss(finished));
  EXPECT_THAT(std::string(finished.message()), HasSubstr("none/a.webp"));
}

}  // namespace
}  // namespace diaphane::media
