// Sequences of frames through a real server.
#include <algorithm>
#include <fstream>

#include "fixture.h"

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class SequenceTest : public CliWithServerTest {
 protected:
  Finished sequence(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"sequence", "cube.obj",    "--height-mm", "20",    "--size",
                                   "48x32",    "--technique", "lambert",     "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(with_server(words));
  }

  /// What a sequence that ended well says of itself.
  json made(const std::vector<std::string>& more) const {
    const Finished finished = sequence(more);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.exit_code == 0 ? json::parse(finished.out) : json();
  }

  std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / folder))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  std::string picture(const std::string& name) const { return read_file(folder_ / name); }
};

TEST_F(SequenceTest, TurnsOnceRoundAndBeginsWithTheStill) {
  EXPECT_EQ(made({"--turntable", "4", "-o", "out"})["rendered"], 4);
  EXPECT_THAT(files("out"),
              ElementsAre("frame_00000.png", "frame_00001.png", "frame_00002.png", "frame_00003.png", "sequence.json"));
  ASSERT_EQ(run(with_server({"render", "cube.obj", "--height-mm", "20", "--size", "48x32", "--technique", "lambert",
                             "-o", "still.png"}))
                .exit_code,
            0);
  EXPECT_TRUE(picture("out/frame_00000.png") == picture("still.png"));
  // The light stays where it is: the four sides of the cube are lit differently.
  EXPECT_FALSE(picture("out/frame_00000.png") == picture("out/frame_00002.png"));
  EXPECT_FALSE(picture("out/frame_00001.png") == picture("out/frame_00003.png"));
}

TEST_F(SequenceTest, GoesOnWhereItWasStopped) {
  const std::vector<std::string> words{"--morph", "sphere", "5", "-o", "out", "--format", "jpg"};
  EXPECT_EQ(made(words)["rendered"], 5);
  const std::string second = picture("out/frame_00001.jpg");
  fs::remove(folder_ / "out/frame_00001.jpg");
  fs::remove(folder_ / "out/frame_00004.jpg");
  const fs::file_time_type before = fs::last_write_time(folder_ / "out/frame_00002.jpg");
  const json rest = made(words);
  EXPECT_EQ(rest["rendered"], 2);
  EXPECT_EQ(rest["found"], 3);
  EXPECT_EQ(fs::last_write_time(folder_ / "out/frame_00002.jpg"), before);
  EXPECT_TRUE(picture("out/frame_00001.jpg") == second);
  EXPECT_EQ(made(words)["rendered"], 0);
}

TEST_F(SequenceTest, ShardsTogetherMakeWhatOneRunMakes) {
  EXPECT_EQ(made({"--turntable", "5", "-o", "whole"})["rendered"], 5);
  EXPECT_EQ(made({"--turntable", "5", "-o", "parts", "--shard", "2/2"})["rendered"], 2);
  EXPECT_EQ(made({"--turntable", "5", "-o", "parts", "--shard", "1/2"})["rendered"], 3);
  EXPECT_EQ(files("whole"), files("parts"));
  for (const std::string& name : files("whole")) EXPECT_TRUE(picture("whole/" + name) == picture("parts/" + name));
}

TEST_F(SequenceTest, DoesNotMixTwoSequencesInAFolder) {
  made({"--turntable", "2", "-o", "out"});
  EXPECT_THAT(sequence({"--turntable", "3", "-o", "out"}).err, HasSubstr("out holds another sequence"));
  EXPECT_THAT(sequence({"--turntable", "2", "-o", "out", "--exposure", "1"}).err, HasSubstr("another sequence"));
  std::ofstream(folder_ / "cube.obj", std::ios::app) << "v 9 9 9\nv 9 8 9\nv 9 9 8\nf -1 -2 -3\n";
  const Finished other_mesh = sequence({"--turntable", "2", "-o", "out"});
  EXPECT_EQ(other_mesh.exit_code, 2);
  EXPECT_EQ(files("out").size(), 3u);
}

TEST_F(SequenceTest, MakesAMovieAndLeavesNothingElse) {
  EXPECT_EQ(made({"--turntable", "3", "-o", "turn.webp"})["rendered"], 3);
  EXPECT_THAT(picture("turn.webp"), StartsWith("RIFF"));
  EXPECT_FALSE(fs::exists(folder_ / "turn.webp.frames"));
}

TEST_F(SequenceTest, PlaysAnAnimationOfAFileByNameOrNumber) {
  // A triangle that moves up: key 0 at 0 s, key 1 at 1 s.
  write_file(folder_ / "up.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [{"name": "up", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                    "samplers": [{"input": 1, "output": 2}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
                  {"bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": 2},
                  {"bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 2}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                    {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
    "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAAAAQAAAAAA="}]})");
  const auto play = [&](const std::string& name, const std::string& output) {
    return run(
        with_server({"sequence", "up.gltf", "--animation", name, "--fps", "4", "--size", "32x32", "-o", output}));
  };
  ASSERT_EQ(play("up", "named").exit_code, 0);
  ASSERT_EQ(play("0", "numbered").exit_code, 0);
  EXPECT_EQ(files("named").size(), 5u);
  EXPECT_TRUE(picture("named/frame_00003.png") == picture("numbered/frame_00003.png"));
  EXPECT_FALSE(picture("named/frame_00000.png") == picture("named/frame_00003.png"));
  const Finished unknown = play("down", "x");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("'down' is none of the file's: 'up'"));
}

TEST_F(SequenceTest, RefusesWhatDoesNotGoTogether) {
  const auto refused = [&](const std::vector<std::string>& more) {
    const Finished finished = sequence(more);
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_EQ(finished.out, "");
    return finished.err;
  };
  EXPECT_THAT(refused({"-o", "out"}), HasSubstr("give one of --turntable N, --morph sphere N, --animation NAME"));
  EXPECT_THAT(refused({"--turntable", "0", "-o", "out"}), HasSubstr("must be 1 to 100000 frames, got '0'"));
  EXPECT_THAT(refused({"--morph", "cube", "3", "-o", "out"}), HasSubstr("must be sphere N"));
  EXPECT_THAT(refused({"--turntable", "2", "--morph", "sphere", "3", "-o", "out"}), HasSubstr("excludes"));
  EXPECT_THAT(refused({"--turntable", "2", "-o", "out", "--shard", "3/2"}), HasSubstr("must be I/N"));
  EXPECT_THAT(refused({"--turntable", "2", "-o", "out.mp4", "--shard", "1/2"}), HasSubstr("needs a folder"));
  EXPECT_THAT(refused({"--turntable", "2", "-o", "out", "--format", "bmp"}), HasSubstr("--format"));
  EXPECT_THAT(refused({"--turntable", "2", "-o", "out", "--aov", "depth"}), HasSubstr("--aov"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  const Finished no_animations = sequence({"--animation", "0", "-o", "out"});
  EXPECT_EQ(no_animations.exit_code, 5);
  EXPECT_THAT(no_animations.err, HasSubstr("must be glTF or GLB"));
  const Finished nowhere = sequence({"--turntable", "2", "-o", "no/such/folder"});
  EXPECT_EQ(nowhere.exit_code, 5);
}

}  // namespace
}  // namespace diaphane::testing_support
