// The examples do what they say.
#include <OpenImageIO/imageio.h>

#include "fixture.h"

namespace diaphane::testing_support {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::StartsWith;

constexpr char kPng[] = "\x89PNG";
constexpr char kExr[] = "\x76\x2f\x31\x01";

class Examples : public CliTest {
 protected:
  void expect_success(const std::string& name, const std::vector<std::string>& arguments) const {
    const Finished finished = run_program(name, folder_, arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
  }

  std::string picture(const std::string& name) const { return read_file(folder_ / name); }
};

TEST_F(Examples, RenderFrameWritesAPicture) {
  expect_success("example_render_frame", {"cube.obj", "cube.png"});
  EXPECT_THAT(picture("cube.png"), StartsWith(kPng));
}

TEST_F(Examples, RenderFrameNamesTheFileThatIsNotThere) {
  const Finished finished = run_program("example_render_frame", folder_, {"none.obj", "cube.png"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr("none.obj"));
}

TEST_F(Examples, DeformShowsAnotherShapeInEveryStep) {
  expect_success("example_deform", {"cube.obj", "."});
  for (int step = 0; step < 4; ++step) {
    const std::string now = picture("step_" + std::to_string(step) + ".png");
    EXPECT_THAT(now, StartsWith(kPng));
    EXPECT_NE(now, picture("step_" + std::to_string((step + 1) % 4) + ".png"));
  }
}

TEST_F(Examples, LiveShowsTheLastPoseAtRest) {
  expect_success("example_live", {"cube.obj", "."});
  EXPECT_THAT(picture("at_rest.png"), StartsWith(kPng));
}

TEST_F(Examples, LightAndMaterialChangeThePicture) {
  expect_success("example_light_and_material", {"cube.obj", "before.exr", "after.exr"});
  EXPECT_THAT(picture("before.exr"), StartsWith(kExr));
  EXPECT_THAT(picture("after.exr"), StartsWith(kExr));
  EXPECT_NE(picture("before.exr"), picture("after.exr"));
}

TEST_F(Examples, SaveChannelsKeepsThemBesideTheColour) {
  expect_success("example_save_channels", {"cube.obj", "cube.exr"});
  const auto input = OIIO::ImageInput::open((folder_ / "cube.exr").string());
  ASSERT_NE(input, nullptr) << OIIO::geterror();
  EXPECT_THAT(input->spec().channelnames, IsSupersetOf({"R", "irradiance.R", "radiosity.G", "N.X", "Z"}));
}

}  // namespace
}  // namespace diaphane::testing_support
