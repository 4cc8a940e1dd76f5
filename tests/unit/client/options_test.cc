#include <gmock/gmock.h>

#include "client/cli/parse.h"
#include "client/cli/placement.h"
#include "client/cli/render_arguments.h"
#include "client/cli/status.h"

namespace diaphane::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RenderOptionsTest : public testing::Test {
 protected:
  RenderOptionsTest() { add_render_options(app_, arguments_); }

  void parse(std::vector<std::string> words) {
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app_.parse(words);
  }

  // What is said of words that cannot be parsed.
  std::string complaint(const std::vector<std::string>& words) {
    try {
      parse(words);
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return "";
  }

  CLI::App app_;
  RenderArguments arguments_;
};

TEST(Numbers, AreExactlyAsManyAsAsked) {
  EXPECT_EQ(parse_vec3("1,-2.5,3e2"), (Vec3{1, -2.5f, 300}));
  for (const char* text : {"", "1,2", "1,2,3,4", "1,2,", "1,,3", "1, 2,3", "a,b,c", "nan,0,0", "inf,0,0", "1e99,0,0"}) {
    EXPECT_EQ(parse_vec3(text), std::nullopt) << text;
  }
}

TEST(Exposures, AreStopsOrFoundOrBoth) {
  const auto is = [](const char* text, bool found, float ev) {
    const std::optional<Exposure> exposure = parse_exposure(text);
    return exposure && exposure->found == found && exposure->ev == ev;
  };
  EXPECT_TRUE(is("-1.5", false, -1.5f));
  EXPECT_TRUE(is("auto", true, 0));
  EXPECT_TRUE(is("auto+1", true, 1));
  EXPECT_TRUE(is("auto-0.5", true, -0.5f));
  for (const char* text : {"", "a", "auto1", "auto+", "automatic", "1,2", "nan"})
    EXPECT_FALSE(parse_exposure(text)) << text;
}

TEST(Backgrounds, AreAColourOrTheEnvironment) {
  const std::optional<Background> colour = parse_background("1,0.5,0");
  ASSERT_TRUE(colour && colour->color);
  EXPECT_EQ(colour->color->g, 0.5f);
  EXPECT_FALSE(colour->environment);
  const std::optional<Background> environment = parse_background("environment");
  ASSERT_TRUE(environment);
  EXPECT_TRUE(environment->environment);
  EXPECT_FALSE(environment->color);
  for (const char* text : {"", "1,2", "Environment", "environment,1"}) EXPECT_FALSE(parse_background(text)) << text;
}

TEST(Sizes, AreTwoPositiveIntegers) {
  const std::optional<Size> size = parse_size("640x480");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width_px, 640);
  EXPECT_EQ(size->height_px, 480);
  for (const char* text : {"", "640", "x", "640x", "0x480", "640x0", "-1x5", "640x480x2", "6.5x5", "99999999999x1"}) {
    EXPECT_FALSE(parse_size(text)) << text;
  }
}

TEST(Formats, FollowTheExtensionInAnyCase) {
  EXPECT_EQ(format_of("a/b.PNG"), ImageFormat::kPng);
  EXPECT_EQ(format_of("b.jpeg"), ImageFormat::kJpeg);
  EXPECT_EQ(format_of("b.exr"), ImageFormat::kExr);
  EXPECT_EQ(format_of("b.gif"), std::nullopt);
  EXPECT_EQ(format_of("png"), std::nullopt);
}

TEST_F(RenderOptionsTest, FillTheArguments) {
  parse({"a.ply",         "b.glb",        "-o",          "out.jpg", "--size", "8x6",    "--technique",   "lambert",
         "--terms",       "global",       "--kernel",    "3",       "--eye",  "-1,0,0", "--point-light", "0,0,1,2,3,4",
         "--point-light", "-5,0,0,1,1,1", "--height-mm", "20"});
  EXPECT_THAT(arguments_.meshes, testing::ElementsAre("a.ply", "b.glb"));
  EXPECT_EQ(arguments_.output, "out.jpg");
  EXPECT_EQ(arguments_.format, ImageFormat::kJpeg);
  EXPECT_EQ(arguments_.size->width_px, 8);
  EXPECT_EQ(arguments_.technique, Technique::kLambert);
  EXPECT_EQ(arguments_.terms, Terms::kGlobal);
  EXPECT_EQ(arguments_.kernel_taps, 3);
  EXPECT_EQ(arguments_.eye, (Vec3{-1, 0, 0}));
  ASSERT_EQ(arguments_.lights.size(), 2);
  EXPECT_EQ(std::get<PointLight>(arguments_.lights[0]).intensity_w_sr, (Rgb{2, 3, 4}));
  EXPECT_EQ(std::get<PointLight>(arguments_.lights[1]).position, (Vec3{-5, 0, 0}));
  EXPECT_EQ(arguments_.height_mm, 20);
}

TEST(ChannelLists, NameEachChannelOnce) {
  EXPECT_THAT(parse_channels("depth,irradiance").value(), testing::ElementsAre(Channel::kDepth, Channel::kIrradiance));
  EXPECT_EQ(parse_channels(channel_names())->size(), 5);
  for (const char* text : {"", "depth,", ",depth", "depth,depth", "Depth", "depth irradiance", "albedo"}) {
    EXPECT_EQ(parse_channels(text), std::nullopt) << text;
  }
}

TEST_F(RenderOptionsTest, TakeMeshesAfterARepeatableOption) {
  parse({"--point-light", "0,0,1,2,3,4", "a.ply", "-o", "out.png"});
  EXPECT_THAT(arguments_.meshes, testing::ElementsAre("a.ply"));
}

TEST_F(RenderOptionsTest, NameTheFlagAndTheValue) {
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--eye", "1,2"}), AllOf(HasSubstr("--eye"), HasSubstr("1,2")));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--size", "12"}), AllOf(HasSubstr("--size"), HasSubstr("12")));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.gif"}), AllOf(HasSubstr("-o"), HasSubstr("o.gif")));
  EXPECT_THAT(complaint({"a.ply"}), HasSubstr("-o"));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--kernel", "0"}), HasSubstr("--kernel"));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--technique", "magic"}),
              AllOf(HasSubstr("--technique"), HasSubstr("integral | paper | reference | lambert")));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--height-mm", "0"}), HasSubstr("--height-mm"));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.exr", "--aov", "depth,colour"}),
              AllOf(HasSubstr("--aov"), HasSubstr("irradiance,radiosity,normal,depth,position")));
}

TEST_F(RenderOptionsTest, RefuseWhatContradictsItself) {
  EXPECT_THAT(
      complaint({"a.ply", "-o", "o.png", "--material", "wax", "--absorption", "1,1,1", "--scattering", "1,1,1"}),
      HasSubstr("--material"));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--absorption", "1,1,1"}), HasSubstr("--scattering"));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--height-mm", "5", "--mm-per-unit", "1"}),
              HasSubstr("--mm-per-unit"));
  EXPECT_THAT(complaint({"a.ply", "-o", "o.png", "--scene", "s.json"}), HasSubstr("--scene"));
  EXPECT_THAT(complaint({"-o", "o.png", "--scene", "s.json", "--material", "wax"}), HasSubstr("--material"));
}

// Two units high along y, flat along z.
std::vector<MeshData> board() { return {{.positions = {{0, 0, 0}, {1, 2, 0}}, .triangles = {0, 1, 0}}}; }

FileUnits units_of(std::initializer_list<std::optional<double>> meshes) {
  FileUnits units;
  for (const auto& unit : meshes) units.add(unit);
  return units;
}

TEST(Units, FollowTheCommandLineThenTheFilesThenFiftyMillimetres) {
  const auto meshes = board();
  const Vec3 up{0, 1, 0};
  EXPECT_EQ(choose_unit({.millimetres_per_unit = 7}, units_of({1000}), meshes, up)->millimetres_per_unit, 7);
  EXPECT_EQ(choose_unit({.height_mm = 20}, units_of({1000}), meshes, up)->millimetres_per_unit, 10);
  EXPECT_EQ(choose_unit({}, units_of({1000}), meshes, up)->millimetres_per_unit, 1000);
  EXPECT_EQ(choose_unit({}, units_of({1000}), meshes, up)->note, "");
  EXPECT_EQ(choose_unit({}, units_of({std::nullopt}), meshes, up)->millimetres_per_unit, 25);
  EXPECT_THAT(choose_unit({}, units_of({std::nullopt}), meshes, up)->note, HasSubstr("50 mm"));
}

TEST(Units, AreAGuessWhereFilesDisagree) {
  const auto meshes = board();
  EXPECT_EQ(choose_unit({}, units_of({1000, std::nullopt}), meshes, {0, 1, 0})->millimetres_per_unit, 25);
  EXPECT_EQ(choose_unit({}, units_of({1000, 1}), meshes, {0, 1, 0})->millimetres_per_unit, 25);
}

TEST(Units, RefuseAHeightOfMeshesThatHaveNone) {
  const auto unit = choose_unit({.height_mm = 20}, units_of({std::nullopt}), board(), {0, 0, 1});
  EXPECT_EQ(exit_code_of(unit.status()), kExitUsage);
  EXPECT_EQ(choose_unit({}, units_of({std::nullopt}), board(), {0, 0, 1})->millimetres_per_unit, 25);
}

TEST(Cameras, TargetAloneMovesTheFramedCamera) {
  const Bounds bounds{{-1, -1, -1}, {1, 1, 1}};
  const Camera framed = choose_camera({}, std::nullopt, bounds, {});
  const Camera moved = choose_camera({.target = Vec3{1, 0, 0}}, std::nullopt, bounds, {});
  EXPECT_FLOAT_EQ(moved.eye.x, framed.eye.x + 1);
  EXPECT_FLOAT_EQ(moved.eye.z, framed.eye.z);
}

TEST(Cameras, CommandLineWinsOverTheFile) {
  const Camera file{.eye = {0, 0, 9}, .fov_y_deg = 50};
  const Camera camera = choose_camera({.fov_y_deg = 20}, file, {}, {});
  EXPECT_EQ(camera.eye, (Vec3{0, 0, 9}));
  EXPECT_EQ(camera.fov_y_deg, 20);
}

TEST(ExitCodes, FollowTheKindOfError) {
  EXPECT_EQ(exit_code_of(absl::OkStatus()), 0);
  EXPECT_EQ(exit_code_of(usage_error("--x", "y")), 2);
  EXPECT_EQ(exit_code_of(absl::UnavailableError("")), 3);
  EXPECT_EQ(exit_code_of(absl::DeadlineExceededError("")), 3);
  EXPECT_EQ(exit_code_of(absl::InvalidArgumentError("")), 4);
  EXPECT_EQ(exit_code_of(absl::ResourceExhaustedError("")), 4);
  EXPECT_EQ(exit_code_of(with_exit_code(absl::NotFoundError(""), kExitFile)), 5);
}

}  // namespace
}  // namespace diaphane::cli
