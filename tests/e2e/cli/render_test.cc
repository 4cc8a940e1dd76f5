// Frames through a real server.
#include "fixture.h"

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(CliWithServerTest, PrivateAndRunningServersMakeTheSameBytes) {
  const Finished through_private = run(render({"-o", "private.png", "--material", "marble"}));
  ASSERT_EQ(through_private.exit_code, 0) << through_private.err;
  EXPECT_EQ(through_private.out, "private.png\n");
  EXPECT_EQ(through_private.err, "");
  ASSERT_EQ(run(with_server(render({"-o", "running.png", "--material", "marble"}))).exit_code, 0);
  const std::string image = read_file(folder_ / "private.png");
  EXPECT_THAT(image, StartsWith("\x89PNG"));
  EXPECT_TRUE(image == read_file(folder_ / "running.png"));
}

TEST_F(CliWithServerTest, SceneFileAndOptionsMakeTheSameBytes) {
  write_file(folder_ / "scene.json", R"({"scene": {"millimetres_per_unit": 10},
    "materials": [{"name": "body", "preset": "skin1"}], "meshes": [{"file": "cube.obj", "material": "body"}],
    "lights": [{"point": {"position": {"x": 1, "y": 2, "z": 3}, "intensity": {"x": 900, "y": 800, "z": 700}}}],
    "camera": {"eye": {"x": 2, "y": 2, "z": 5}, "fov_y_deg": 40},
    "settings": {"technique": "TECHNIQUE_LAMBERT", "exposure_ev": 1}, "size": {"width_px": 32, "height_px": 24}})");
  const Finished from_file = run(with_server({"render", "--scene", "scene.json", "-o", "a.png"}));
  ASSERT_EQ(from_file.exit_code, 0) << from_file.err;
  const Finished from_options = run(with_server(
      {"render",        "cube.obj",          "-o",         "b.png", "--mm-per-unit", "10",    "--material", "skin1",
       "--point-light", "1,2,3,900,800,700", "--eye",      "2,2,5", "--target",      "0,0,0", "--fov",      "40",
       "--technique",   "lambert",           "--exposure", "1",     "--size",        "32x24"}));
  ASSERT_EQ(from_options.exit_code, 0) << from_options.err;
  EXPECT_TRUE(read_file(folder_ / "a.png") == read_file(folder_ / "b.png"));
}

TEST_F(CliWithServerTest, MaterialsByColourMeanTheSameInASceneFileAndAsOptions) {
  write_file(folder_ / "scene.json", R"({"scene": {"millimetres_per_unit": 10},
    "materials": [{"name": "body", "profile": "PROFILE_BETTER_DIPOLE", "diffuse_color":
        {"color": {"x": 0.9, "y": 0.5, "z": 0.01}, "mean_free_path_mm": {"x": 1, "y": 1, "z": 1}}}],
    "meshes": [{"file": "cube.obj", "material": "body"}], "settings": {"slab_correction": true},
    "lights": [{"point": {"position": {"x": 1, "y": 2, "z": 3}, "intensity": {"x": 900, "y": 800, "z": 700}}}],
    "camera": {"eye": {"x": 2, "y": 2, "z": 5}}, "size": {"width_px": 32, "height_px": 24}})");
  const Finished from_file = run(with_server({"render", "--scene", "scene.json", "-o", "a.png"}));
  ASSERT_EQ(from_file.exit_code, 0) << from_file.err;
  EXPECT_THAT(from_file.err, HasSubstr("warning: material: blue scatters too little"));
  const std::vector<std::string> options = {"render",
                                            "cube.obj",
                                            "-o",
                                            "b.png",
                                            "--mm-per-unit",
                                            "10",
                                            "--point-light",
                                            "1,2,3,900,800,700",
                                            "--eye",
                                            "2,2,5",
                                            "--size",
                                            "32x24",
                                            "--diffuse-color",
                                            "0.9,0.5,0.01",
                                            "--mean-free-path",
                                            "1"};
  const auto with = [&](std::initializer_list<std::string> more) {
    std::vector<std::string> all = options;
    all.insert(all.end(), more);
    return run(with_server(all));
  };
  const Finished from_options = with({"--profile", "better-dipole", "--slab-correction"});
  ASSERT_EQ(from_options.exit_code, 0) << from_options.err;
  EXPECT_TRUE(read_file(folder_ / "a.png") == read_file(folder_ / "b.png"));
  ASSERT_EQ(with({"--profile", "better-dipole"}).exit_code, 0);
  EXPECT_FALSE(read_file(folder_ / "a.png") == read_file(folder_ / "b.png")) << "the slab correction shows";
  ASSERT_EQ(with({"--profile", "dipole", "--slab-correction"}).exit_code, 0);
  EXPECT_FALSE(read_file(folder_ / "a.png") == read_file(folder_ / "b.png")) << "the profile shows";
}

TEST_F(CliWithServerTest, CoatsReflect) {
  const auto with = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"-o", output, "--point-light", "0,0,100,9000,9000,9000"};
    words.insert(words.end(), more.begin(), more.end());
    return with_server(render(words));
  };
  ASSERT_EQ(run(with("bare.png", {})).exit_code, 0);
  ASSERT_EQ(run(with("coat.png", {"--coat"})).exit_code, 0);
  ASSERT_EQ(run(with("rough.png", {"--coat", "--roughness", "0.8"})).exit_code, 0);
  EXPECT_NE(read_file(folder_ / "bare.png"), read_file(folder_ / "coat.png"));
  EXPECT_NE(read_file(folder_ / "rough.png"), read_file(folder_ / "coat.png"));
  EXPECT_THAT(refusal(4, with("x.png", {"--coat", "--roughness", "2"})), HasSubstr("material.coat.roughness"));
  EXPECT_THAT(refusal(2, with("x.png", {"--roughness", "0.5"})), HasSubstr("--coat"));
}

TEST_F(CliWithServerTest, EveryFormatIsWhatItsNameSays) {
  ASSERT_EQ(run(with_server(render({"-o", "x.jpg"}))).exit_code, 0);
  EXPECT_THAT(read_file(folder_ / "x.jpg"), StartsWith("\xff\xd8\xff"));
  ASSERT_EQ(run(with_server(render({"-o", "x.exr"}))).exit_code, 0);
  EXPECT_THAT(read_file(folder_ / "x.exr"), StartsWith("\x76\x2f\x31\x01"));
}

TEST_F(CliWithServerTest, EnvironmentsLightInPlaceOfTheKeyLightAndTurn) {
  // Red from +x, the right half of the map; what is left is dark.
  std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n";
  for (int row = 0; row < 4; ++row) {
    hdr += std::string("\x01\x01\x00\x7c", 4) + std::string("\x01\x01\x00\x7c", 4);
    hdr += std::string("\xff\x10\x10\x80", 4) + std::string("\xff\x10\x10\x80", 4);
  }
  write_file(folder_ / "red.hdr", hdr);
  const auto with = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"-o", output, "--environment", "red.hdr"};
    words.insert(words.end(), more.begin(), more.end());
    return with_server(render(words));
  };
  const Finished lit = run(with("a.png", {}));
  ASSERT_EQ(lit.exit_code, 0) << lit.err;
  ASSERT_EQ(run(with("b.png", {"--environment-rotation", "180"})).exit_code, 0);
  ASSERT_EQ(run(with("c.png", {"--environment-rotation", "360"})).exit_code, 0);
  EXPECT_NE(read_file(folder_ / "a.png"), read_file(folder_ / "b.png"));
  for (const char* technique : {"paper", "lambert"}) {
    EXPECT_EQ(run(with("d.png", {"--technique", technique})).exit_code, 0) << technique;
  }
  ASSERT_EQ(run(with("e.png", {"--background", "environment"})).exit_code, 0);
  EXPECT_NE(read_file(folder_ / "e.png"), read_file(folder_ / "a.png"));
  EXPECT_THAT(refusal(4, with_server(render({"-o", "x.png", "--background", "environment"}))),
              HasSubstr("no environment to show"));
  write_file(folder_ / "broken.hdr", hdr.substr(0, 60));
  EXPECT_THAT(refusal(5, with_server(render({"-o", "x.png", "--environment", "broken.hdr"}))), HasSubstr("broken.hdr"));
  EXPECT_THAT(refusal(4, with("x.png", {"--environment-intensity", "-1"})), HasSubstr("environment.intensity"));
  EXPECT_THAT(refusal(2, with_server(render({"-o", "x.png", "--environment-rotation", "3"}))),
              HasSubstr("--environment"));
}

TEST_F(CliWithServerTest, RefusalsOfTheServerExitWithFourAndNameTheField) {
  EXPECT_THAT(refusal(4, with_server(render({"-o", "x.png", "--material", "gold"}))), HasSubstr("gold"));
  EXPECT_THAT(refusal(4, with_server(render({"-o", "x.png", "--material", "gold", "--ior", "1.4"}))),
              HasSubstr("gold"));
  EXPECT_THAT(refusal(4, with_server(render({"-o", "x.png", "--kernel", "99"}))), HasSubstr("kernel_taps"));
  EXPECT_THAT(refusal(4, with_server(render({"-o", "x.png", "--fov", "200"}))), HasSubstr("fov_y_deg"));
  EXPECT_THAT(refusal(4, with_server(render({"-o", "x.png", "--up", "0,0,1", "--eye", "0,0,5"}))),
              HasSubstr("camera.up"));
  EXPECT_FALSE(fs::exists(folder_ / "x.png"));
}

TEST_F(CliWithServerTest, UnknownScenesExitWithFour) {
  refusal(4, with_server({"scene", "show", "nobody"}));
  refusal(4, with_server({"scene", "rm", "nobody"}));
}

TEST_F(CliWithServerTest, RenderLeavesNoSceneBehind) {
  ASSERT_EQ(run(with_server(render({"-o", "x.png"}))).exit_code, 0);
  EXPECT_EQ(scenes(), json::array());
  ASSERT_EQ(run(with_server(render({"-o", "x.png", "--material", "gold"}))).exit_code, 4);
  EXPECT_EQ(scenes(), json::array());
}

TEST_F(CliWithServerTest, JsonSaysWhatWasMade) {
  const Finished finished = run(with_server(render({"-o", "x.png", "--json"})));
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const json made = json::parse(finished.out);
  EXPECT_EQ(made["output"], "x.png");
  EXPECT_EQ(made["content_type"], "image/png");
  EXPECT_EQ(made["bytes"], fs::file_size(folder_ / "x.png"));
  EXPECT_EQ(made["width_px"], 64);
  EXPECT_EQ(made["millimetres_per_unit"], 10);
  EXPECT_FALSE(made["stages"].empty());
}

TEST_F(CliWithServerTest, HealthSaysThatItServes) {
  const Finished text = run(with_server({"health"}));
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.out, "serving\n");
  EXPECT_EQ(nlohmann::json::parse(run(with_server({"--json", "health"})).out), nlohmann::json({{"serving", true}}));
}

TEST_F(CliWithServerTest, JsonListsWhatTheServerKnows) {
  const json presets = json::parse(run(with_server({"materials", "--json"})).out);
  const auto marble = std::find_if(presets.begin(), presets.end(), [](const json& p) { return p["name"] == "marble"; });
  ASSERT_NE(marble, presets.end());
  EXPECT_EQ((*marble)["absorption_mm"], json::parse("[0.0021, 0.0041, 0.0071]"));
  EXPECT_EQ((*marble)["refractive_index"], 1.5);
  const json info = json::parse(run(with_server({"info", "--json"})).out);
  EXPECT_GT(info["limits"]["max_pixels"], 0);
  EXPECT_FALSE(info["gl_renderer"].get<std::string>().empty());
  EXPECT_THAT(run(with_server({"materials"})).out, HasSubstr("wax"));
}

TEST_F(CliWithServerTest, NoSizeIsSaidInOneLine) {
  const Finished finished = run(with_server({"render", "cube.obj", "-o", "x.png", "--size", "16x16"}));
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.err, HasSubstr("50 mm"));
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1);
}

}  // namespace
}  // namespace diaphane::testing_support
