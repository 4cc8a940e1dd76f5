// Maps of light from files.
#include "diaphane/environment.h"

#include <ImfArray.h>
#include <ImfRgbaFile.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "tests/unit/readers/mesh_files.h"

namespace diaphane::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

absl::StatusOr<EnvironmentMap> read_map(const std::string& name, const std::string& bytes) {
  // Of this process alone: tests run beside each other.
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("diaphane_maps_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::ofstream(folder / name, std::ios::binary) << bytes;
  auto map = read_environment_file(folder / name);
  std::filesystem::remove_all(folder);
  return map;
}

std::string hdr(const std::string& pixels, const std::string& size = "-Y 1 +X 2", const std::string& variables = "") {
  return "#?RADIANCE\n# made here\nFORMAT=32-bit_rle_rgbe\n" + variables + "\n" + size + "\n" + pixels;
}

std::string complaint(const absl::StatusOr<EnvironmentMap>& map) { return std::string(map.status().message()); }

TEST(RadianceReader, ReadsPlainPixels) {
  const auto map = read_map("a.hdr", hdr(std::string("\x80\x40\x00\x81\x00\x00\x00\x00", 8)));
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->width_px, 2u);
  EXPECT_THAT(map->radiance, ElementsAre(Rgb{1, 0.5f, 0}, Rgb{0, 0, 0}));
}

TEST(RadianceReader, DividesExposuresOut) {
  const auto map =
      read_map("a.hdr", hdr("\x80\x80\x80\x81\x80\x80\x80\x81", "-Y 1 +X 2", "EXPOSURE=4\nEXPOSURE= 0.5\n"));
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->radiance[0], (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(RadianceReader, ReadsOldRuns) {
  const auto map = read_map("a.hdr", hdr("\x80\x80\x80\x81\x01\x01\x01\x02\x80\x80\x80\x82", "-Y 1 +X 4"));
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->radiance[2].r, 1);
  EXPECT_EQ(map->radiance[3].r, 2);
}

TEST(RadianceReader, ReadsNewRunsOfEachChannel) {
  std::string row("\x02\x02\x00\x08", 4);
  row += std::string("\x88\x80", 2);                              // eight times 128
  row += std::string("\x08\x00\x10\x20\x30\x40\x50\x60\x70", 9);  // eight of them
  row += std::string("\x84\x00\x84\x80", 4);
  row += std::string("\x88\x81", 2);
  const auto map = read_map("a.hdr", hdr(row, "-Y 1 +X 8"));
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->radiance[1], (Rgb{1, 0.125f, 0}));
  EXPECT_EQ(map->radiance[7], (Rgb{1, 0.875f, 1}));
}

TEST(RadianceReader, RefusesInOneLineWhatIsNoSuchPicture) {
  EXPECT_THAT(complaint(read_map("a.hdr", "#?RADIANCE\n")), HasSubstr("ends within its header"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr("", "-Y 1 +X 9000"))), HasSubstr("at most 8192x4096"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr("", "-Y 99999999999999999999 +X 2"))), HasSubstr("must be -Y HEIGHT"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr("", "+X 2 -Y 2"))), HasSubstr("orientation"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr("", "-Y 1 +X 2", "FORMAT=32-bit_rle_xyze\n"))), HasSubstr("xyze"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr("", "-Y 1 +X 2", "EXPOSURE=0\n"))), HasSubstr("EXPOSURE"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr("\x80\x80\x80"))), HasSubstr("ends within its pixels, row 0"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr("\x01\x01\x01\x02"))), HasSubstr("a run of 2"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr(std::string("\x02\x02\x00\x09", 4), "-Y 1 +X 8"))),
              HasSubstr("must be 8"));
  EXPECT_THAT(complaint(read_map("a.hdr", hdr(std::string("\x02\x02\x00\x08\x00\x00", 6), "-Y 1 +X 8"))),
              HasSubstr("a run of 0"));
}

std::string exr_of(int width, int height, int left, const std::vector<Imf::Rgba>& pixels) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "written.exr";
  const Imath::Box2i window({left, -3}, {left + width - 1, height - 4});
  Imf::RgbaOutputFile file(path.c_str(), window, window, Imf::WRITE_RGB);
  file.setFrameBuffer(pixels.data() - left + 3 * width, 1, static_cast<size_t>(width));
  file.writePixels(height);
  return path.string();
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(OpenExrReader, ReadsAWindowThatBeginsElsewhereAndTakesNegativesForNothing) {
  const auto map =
      read_environment_file(exr_of(3, 2, 5, {{1, 2, 3}, {-1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {4, 5, 6}}));
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->width_px, 3u);
  EXPECT_EQ(map->height_px, 2u);
  EXPECT_EQ(map->radiance[0], (Rgb{1, 2, 3}));
  EXPECT_EQ(map->radiance[1], (Rgb{0, 0, 0}));
  EXPECT_EQ(map->radiance[5], (Rgb{4, 5, 6}));
}

TEST(OpenExrReader, RefusesPixelsThatAreNotFinite) {
  const std::string infinite = exr_of(2, 1, 0, {{1, 1, 1}, {1, half::posInf(), 1}});
  EXPECT_THAT(complaint(read_environment_file(infinite)), HasSubstr("not finite, row 0, column 1"));
}

TEST(OpenExrReader, RefusesEveryTruncationInOneLine) {
  const std::string bytes = bytes_of(exr_of(8, 4, 0, std::vector<Imf::Rgba>(32, {1, 2, 3})));
  for (size_t size = 5; size < bytes.size(); size += 7) {
    const auto map = read_map("cut.exr", bytes.substr(0, size));
    EXPECT_FALSE(map.ok()) << size;
    EXPECT_EQ(complaint(map).find('\n'), std::string::npos);
  }
}

TEST(EnvironmentReader, SaysWhatItIsNot) {
  EXPECT_THAT(complaint(read_map("a.hdr", "P6 1 1")), HasSubstr("neither a Radiance picture (.hdr) nor OpenEXR"));
  EXPECT_EQ(read_environment_file("/nowhere/a.hdr").status().code(), absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace diaphane::testing
