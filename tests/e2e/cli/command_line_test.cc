// What the command line does before it needs a server, and when there is none.
#include "fixture.h"

namespace diaphane::testing_support {
namespace {

using testing::HasSubstr;

TEST_F(CliTest, WrongCommandLinesExitWithTwoAndNameTheFlag) {
  EXPECT_THAT(refusal(2, render({"-o", "x.png", "--colour", "red"})), HasSubstr("--colour"));
  EXPECT_THAT(refusal(2, render({"-o", "x.gif"})), HasSubstr("x.gif"));
  EXPECT_THAT(refusal(2, render({"-o", "x.png", "--eye", "1,2"})), HasSubstr("--eye"));
  EXPECT_THAT(refusal(2, render({"-o", "x.png", "--absorption", "1,1,1"})), HasSubstr("--scattering"));
  EXPECT_THAT(refusal(2, render({})), HasSubstr("-o"));
  EXPECT_THAT(refusal(2, render({"--ouput", "x.png"})), HasSubstr("--ouput"));
  EXPECT_THAT(refusal(2, {"render", "-o", "x.png"}), HasSubstr("MESH"));
  EXPECT_THAT(refusal(2, {"--server", "nowhere", "info"}), HasSubstr("--server"));
  EXPECT_THAT(refusal(2, {"--server", "nowhere", "health"}), HasSubstr("--server"));
  EXPECT_THAT(refusal(2, {"health"}), HasSubstr("--server"));
  EXPECT_THAT(refusal(2, {"scene", "ls"}), HasSubstr("--server"));
  EXPECT_THAT(refusal(2, {"scene"}), HasSubstr("ls"));
  EXPECT_THAT(refusal(2, {"paint"}), HasSubstr("paint"));
  EXPECT_THAT(refusal(2, {}), HasSubstr("COMMAND"));
}

TEST_F(CliTest, LocalFilesThatCannotBeUsedExitWithFiveAndAreNamed) {
  EXPECT_THAT(refusal(5, {"render", "none.ply", "-o", "x.png"}), HasSubstr("none.ply"));
  EXPECT_THAT(refusal(5, {"render", "cube.obj", "-o", "none/x.png"}), HasSubstr("none/x.png"));
  EXPECT_THAT(refusal(5, {"render", "--scene", "none.json", "-o", "x.png"}), HasSubstr("none.json"));
  write_file(folder_ / "bad.json", R"({"meshes": [{"file": "cube.obj", "colour": 3}]})");
  EXPECT_THAT(refusal(5, {"render", "--scene", "bad.json", "-o", "x.png"}), HasSubstr("colour"));
  write_file(folder_ / "bad.obj", "v 0 0 0\nf 1 2 3\n");
  EXPECT_THAT(refusal(5, {"render", "bad.obj", "-o", "x.png"}), HasSubstr("bad.obj"));
}

TEST_F(CliTest, ServersThatDoNotAnswerExitWithThree) {
  EXPECT_THAT(refusal(3, {"--server", "unix:" + (folder_ / "none").string(), "info"}), HasSubstr("no answer"));
  EXPECT_THAT(refusal(3, {"--server", "unix:" + (folder_ / "none").string(), "health"}), HasSubstr("none"));
}

TEST_F(CliTest, HelpAndVersionGoToStdout) {
  const Finished help = run({"render", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("--point-light"));
  EXPECT_EQ(help.err, "");
  EXPECT_EQ(run({"--version"}).exit_code, 0);
}

// Files of every kind and complaint, each refused in one line that names it.
TEST_F(CliTest, MalformedMeshesAreRefusedInOneLine) {
  const std::filesystem::path malformed = DIAPHANE_SOURCE_DIR "/../shared/data/malformed";
  if (!std::filesystem::exists(malformed)) GTEST_SKIP() << malformed << " is not there";
  const char* const files[] = {
      "cgltf/BadBasisU.gltf",
      "fastgltf/empty_json.gltf",
      "gltf-rs/non_sparse_accessor_without_buffer_view.gltf",
      "gltf-validator/asset/invalid_version.gltf",
      "gltf-validator/buffer/no_bin_chunk.glb",
      "gltf-validator/glb/json_and_two_buffers.glb",
      "gltf-validator/glb/only_bin_chunk.glb",
      "gltf-validator/json/invalid_syntax.gltf",
      "gltf-validator/mesh/unresolved_indices.gltf",
      "gltf-validator/mesh_data/index_buffer_oob.gltf",
      "magnum-gltf/buffer-invalid-short-size-embedded.glb",
      "magnum-gltf/mesh-invalid-buffer-notfound.gltf",
      "magnum-gltf/scene-invalid-cycle.gltf",
      "magnum-obj/invalid-number-count.obj",
      "magnum-obj/invalid-mixed-primitives.obj",
      "magnum-ply/format-missing.ply",
      "magnum-ply/invalid-face-size-type.ply",
      "magnum-ply/invalid-signature.ply",
      "tinyobjloader/clusterfuzz-testcase-minimized-fuzz_Pars.obj",
      "trimesh/stl_empty_bin.stl",
      "trimesh/face_in_group_name_mid_file.obj",
      "ufbx-obj-fuzz/fuzz_0028.obj",
      "ufbx-obj-fuzz/fuzz_0112.obj",
  };
  for (const char* file : files) {
    EXPECT_THAT(refusal(5, {"render", (malformed / file).string(), "-o", "x.png"}), HasSubstr(file));
  }
}

}  // namespace
}  // namespace diaphane::testing_support
