// Extra channels, shadows and the reference, through a real server.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

#include "fixture.h"

namespace diaphane::testing_support {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// An EXR by names.
struct Exr {
  OIIO::ImageSpec spec;
  std::vector<float> values;

  explicit Exr(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (input == nullptr) {
      ADD_FAILURE() << OIIO::geterror();
      return;
    }
    spec = input->spec();
    values.resize(spec.image_pixels() * static_cast<size_t>(spec.nchannels));
    EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, values.data()));
  }

  float at(int x, int y, const std::string& channel) const {
    const int index = spec.channelindex(channel);
    EXPECT_GE(index, 0) << channel;
    return index < 0 ? NAN : values[static_cast<size_t>((y * spec.width + x) * spec.nchannels + index)];
  }
};

TEST_F(CliWithServerTest, AovPutsChannelsInTheExr) {
  // A cube from -1 to 1, 10 mm a unit, straight from the front.
  const std::vector<std::string> view{"--eye", "0,0,6", "--target", "0,0,0", "--point-light", "0,0,5,900,900,900"};
  for (const char* technique : {"integral", "paper", "lambert", "reference"}) {
    SCOPED_TRACE(technique);
    std::vector<std::string> words = render({"-o", "x.exr", "--technique", technique});
    words.insert(words.end(), view.begin(), view.end());
    std::vector<std::string> with_channels = words;
    with_channels.insert(with_channels.end(), {"--aov", "irradiance,radiosity,normal,depth,position"});
    const Finished finished = run(with_server(with_channels));
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    const Exr exr(folder_ / "x.exr");
    EXPECT_EQ(exr.spec.nchannels, 17);
    EXPECT_EQ(exr.spec.format, OIIO::TypeFloat);
    EXPECT_NEAR(exr.at(32, 24, "Z"), 5, 1e-4);
    EXPECT_NEAR(exr.at(32, 24, "P.Z"), 1, 1e-4);
    EXPECT_NEAR(exr.at(32, 24, "N.Z"), 1, 1e-3);
    EXPECT_GT(exr.at(32, 24, "irradiance.G"), 0);
    EXPECT_GT(exr.at(32, 24, "radiosity.G"), 0);
    EXPECT_EQ(exr.at(0, 0, "A"), 0);
    EXPECT_EQ(exr.at(0, 0, "N.Z"), 0);
    EXPECT_EQ(exr.at(0, 0, "irradiance.R"), 0);
    EXPECT_EQ(exr.at(0, 0, "Z"), INFINITY);
    ASSERT_EQ(run(with_server(words)).exit_code, 0);
    const Exr plain(folder_ / "x.exr");
    EXPECT_EQ(plain.spec.nchannels, 4);
    EXPECT_FLOAT_EQ(plain.at(32, 24, "G"), exr.at(32, 24, "G"));
  }
}

TEST_F(CliTest, AovNeedsAnExrAndKnownNames) {
  EXPECT_THAT(refusal(2, render({"-o", "x.png", "--aov", "depth"})), AllOf(HasSubstr("--aov"), HasSubstr("x.png")));
  EXPECT_THAT(refusal(2, render({"-o", "x.exr", "--aov", "albedo"})), AllOf(HasSubstr("--aov"), HasSubstr("albedo")));
  EXPECT_THAT(refusal(2, render({"-o", "x.exr", "--aov", "depth,depth"})), HasSubstr("--aov"));
}

TEST_F(CliWithServerTest, ShadowsCanBeAskedOfEveryTechnique) {
  for (const char* technique : {"paper", "lambert"}) {
    const Finished finished = run(with_server(render({"-o", "x.png", "--technique", technique, "--shadows", "on"})));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
  }
}

TEST_F(CliWithServerTest, ReferenceShowsABarOnATerminalAlone) {
  const std::vector<std::string> words = with_server(render({"-o", "x.png", "--technique", "reference"}));
  const Finished quiet = run(words);
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(quiet.out, "x.png\n");
  const Finished watched = run_diaphane_on_terminal(folder_, words);
  EXPECT_EQ(watched.exit_code, 0);
  EXPECT_EQ(watched.out, "x.png\n");
  EXPECT_THAT(watched.err, HasSubstr("rendering 64x48 [##############################] 100 %"));
  const Finished other = run_diaphane_on_terminal(folder_, with_server(render({"-o", "x.png"})));
  EXPECT_THAT(other.err, AllOf(HasSubstr("rendering 64x48 ..."), Not(HasSubstr("%"))));
}

class CliWithHurriedServerTest : public CliWithServerTest {
 protected:
  CliWithHurriedServerTest() : CliWithServerTest({"--max-reference-seconds", "0.001"}) {}
};

TEST_F(CliWithHurriedServerTest, TooSlowAReferenceExitsWithThreeAndNamesTheLimit) {
  const std::string refused = refusal(3, with_server({"render", "cube.obj", "-o", "x.png", "--size", "512x512",
                                                      "--height-mm", "20", "--technique", "reference"}));
  EXPECT_THAT(refused, HasSubstr("reference_seconds: must be at most 0.001"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.png"));
  EXPECT_EQ(run(with_server(render({"-o", "x.png"}))).exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(run(with_server({"info", "--json"})).out)["limits"]["max_reference_seconds"], 0.001);
}

}  // namespace
}  // namespace diaphane::testing_support
