// Streams of frames through a real server.
#include <algorithm>

#include "fixture.h"
#include "fmt/format.h"
#include "tests/support/h264_decoder.h"

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

class CliStreamTest : public CliWithServerTest {
 protected:
  Finished stream(const std::vector<std::string>& more) const {
    // A double pyramid: unlike a cube's, its corners are not on their bounding sphere.
    write_file(folder_ / "long.obj",
               "v 2 0 0\nv -2 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
               "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    std::vector<std::string> words{"stream", "long.obj", "--height-mm", "20",
                                   "--size", "64x48",    "--technique", "lambert"};
    words.insert(words.end(), more.begin(), more.end());
    return run(with_server(words));
  }

  bool has_video() const {
    const Finished info = run(with_server({"info", "--json"}));
    return info.out.find("\"h264\"") != std::string::npos;
  }
};

/// The access units of a bare video: each begins with a delimiter, parameter sets or a slice after the one before.
std::vector<std::string> access_units(const std::string& video) {
  std::vector<size_t> begins;
  bool had_slice = true;
  for (size_t at = video.find(std::string("\0\0\1", 3)); at != std::string::npos;
       at = video.find(std::string("\0\0\1", 3), at + 3)) {
    const int kind = video[at + 3] & 0x1f;
    const bool slice = kind == 1 || kind == 5;
    // The first macroblock of a slice that begins a picture is 0: a one bit.
    const bool first_slice = slice && (video[at + 4] & 0x80) != 0;
    const size_t start = at > 0 && video[at - 1] == 0 ? at - 1 : at;
    if (had_slice && (!slice || first_slice)) begins.push_back(start);
    had_slice = slice;
  }
  std::vector<std::string> units;
  for (size_t i = 0; i < begins.size(); ++i) {
    units.push_back(video.substr(begins[i], (i + 1 < begins.size() ? begins[i + 1] : video.size()) - begins[i]));
  }
  return units;
}

TEST_F(CliStreamTest, KeepsTheFramesOfADeformationInAFolder) {
  const Finished finished = stream({"--morph", "sphere", "--seconds", "0.5", "-o", "out", "--json"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const json made = json::parse(finished.out);
  EXPECT_EQ(made["edits"], 15);
  EXPECT_GE(made["frames"], 2);
  EXPECT_LE(made["frames"], 16);
  EXPECT_GT(made["latency_ms"]["p50"], 0);
  const std::string last = fmt::format("out/frame_{:05}.jpg", made["frames"].get<int>() - 1);
  EXPECT_THAT(read_file(folder_ / last), StartsWith("\xff\xd8\xff"));
  EXPECT_FALSE(read_file(folder_ / "out/frame_00000.jpg") == read_file(folder_ / "out/frame_00002.jpg"));
}

TEST_F(CliStreamTest, RecordsThreeHundredFramesOfVideoEveryOneOfWhichDecodes) {
  if (!has_video()) GTEST_SKIP() << "the server has no encoder of H.264";
  const Finished finished = stream({"--morph", "sphere", "--seconds", "3", "--fps", "100", "--every-revision",
                                    "--encoding", "h264", "-o", "morph.h264", "--json"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(json::parse(finished.out)["frames"], 301);
  const std::vector<std::string> units = access_units(read_file(folder_ / "morph.h264"));
  ASSERT_EQ(units.size(), 301u);
  H264Decoder decoder;
  double least = 255, most = 0;
  for (size_t i = 0; i < units.size(); ++i) {
    const auto frame = decoder.decode(units[i]);
    ASSERT_TRUE(frame.has_value()) << "frame " << i;
    EXPECT_EQ(frame->width_px, 64);
    least = std::min(least, frame->mean_luma);
    most = std::max(most, frame->mean_luma);
  }
  EXPECT_GT(most, least + 2);
}

TEST_F(CliStreamTest, WritesFramesToStdoutAndWhatItSaysToStderr) {
  const Finished finished = stream({"--morph", "sphere", "--seconds", "0.2", "-o", "-"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, StartsWith("\xff\xd8\xff"));
  EXPECT_THAT(finished.err, HasSubstr("6 edits"));
}

TEST_F(CliStreamTest, RefusesWhatDoesNotGoTogether) {
  const auto refused = [&](const std::vector<std::string>& more) {
    const Finished finished = stream(more);
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    return finished.err;
  };
  EXPECT_THAT(refused({"-o", "out"}), HasSubstr("give one of --morph sphere, --animation NAME"));
  EXPECT_THAT(refused({"--morph", "cube", "-o", "out"}), HasSubstr("--morph"));
  EXPECT_THAT(refused({"--morph", "sphere", "-o", "a.h264"}), HasSubstr("must be h264 for an .h264"));
  EXPECT_THAT(refused({"--morph", "sphere", "-o", "out", "--encoding", "h264"}), HasSubstr("to an .h264"));
  EXPECT_THAT(refused({"--morph", "sphere", "-o", "out", "--encoding", "exr"}), HasSubstr("--encoding"));
}

}  // namespace
}  // namespace diaphane::testing_support
