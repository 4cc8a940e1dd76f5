// The parts of diaphane view.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <vector>

#include "absl/strings/escaping.h"
#include "client/cli/orbit.h"
#include "client/cli/terminal_picture.h"
#include "client/cli/view_keys.h"

namespace diaphane::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const Camera kFirst{.eye = {3, 2, 5}, .target = {1, 2, 5}, .up = {0, 0, 2}, .fov_y_deg = 40};

void expect_eye(const Orbit& orbit, const Vec3& eye) {
  const Camera camera = orbit.camera();
  EXPECT_NEAR(camera.eye.x, eye.x, 1e-5);
  EXPECT_NEAR(camera.eye.y, eye.y, 1e-5);
  EXPECT_NEAR(camera.eye.z, eye.z, 1e-5);
  EXPECT_EQ(camera.target, kFirst.target);
  EXPECT_EQ(camera.up, kFirst.up);
  EXPECT_EQ(camera.fov_y_deg, kFirst.fov_y_deg);
}

TEST(Orbit, TurnsAboutUp) {
  Orbit orbit(kFirst);
  expect_eye(orbit, kFirst.eye);
  orbit.turn(90, 0);
  expect_eye(orbit, {1, 4, 5});
  orbit.turn(90, 30);
  expect_eye(orbit, {1 - std::sqrt(3.f), 2, 6});
  orbit.reset();
  expect_eye(orbit, kFirst.eye);
}

TEST(Orbit, StaysBelowTheTopAndWithinReach) {
  Orbit orbit(kFirst);
  orbit.turn(0, 500);
  const double steepest = 85 * M_PI / 180;
  expect_eye(orbit,
             {static_cast<float>(1 + 2 * std::cos(steepest)), 2, static_cast<float>(5 + 2 * std::sin(steepest))});
  orbit.reset();
  orbit.move_away(0.5);
  expect_eye(orbit, {2, 2, 5});
  orbit.move_away(1e-9);
  expect_eye(orbit, {1.5f, 2, 5});
  orbit.move_away(1e9);
  expect_eye(orbit, {9, 2, 5});
}

std::vector<ViewKey> keys_of(std::string_view typed) {
  std::vector<ViewKey> keys;
  for_each_key(typed, [&](ViewKey key) { keys.push_back(key); });
  return keys;
}

TEST(ViewKeys, AreArrowsOfBothModesAndLetters) {
  EXPECT_THAT(keys_of("\x1b[A\x1bOD+h q"), ElementsAre(ViewKey::kUp, ViewKey::kLeft, ViewKey::kNearer, ViewKey::kLeft,
                                                       ViewKey::kPause, ViewKey::kEnd));
}

TEST(ViewKeys, PassOverWhatMeansNothing) {
  // Delete, a function key with a modifier, Escape alone, a letter, a sequence cut short.
  EXPECT_THAT(keys_of("\x1b[3~\x1b[15;2~\x1bz-"), ElementsAre(ViewKey::kFarther));
  EXPECT_THAT(keys_of("\x1b[1;5"), IsEmpty());
  EXPECT_THAT(keys_of("\x1b"), IsEmpty());
}

PictureProtocol found_with(std::map<std::string, const char*> variables) {
  return found_picture_protocol(
      [&](const char* name) { return variables.count(name) != 0 ? variables[name] : nullptr; });
}

TEST(PictureProtocol, IsFoundByTheTerminalsName) {
  EXPECT_EQ(found_with({}), PictureProtocol::kBlocks);
  EXPECT_EQ(found_with({{"TERM", "xterm-256color"}}), PictureProtocol::kBlocks);
  EXPECT_EQ(found_with({{"TERM", "xterm-kitty"}}), PictureProtocol::kKitty);
  EXPECT_EQ(found_with({{"TERM_PROGRAM", "WezTerm"}}), PictureProtocol::kITerm);
  EXPECT_EQ(found_with({{"TERM", "screen-256color"}, {"TERM_PROGRAM", "WezTerm"}}), PictureProtocol::kBlocks);
  EXPECT_EQ(found_with({{"TERM", "xterm-kitty"}, {"TMUX", "/tmp/a"}}), PictureProtocol::kBlocks);
}

TEST(PictureSize, FillsAllRowsButTheLast) {
  const auto size = [](PictureProtocol protocol, const TerminalExtent& extent) {
    const Size found = picture_size(protocol, extent);
    return std::pair(found.width_px, found.height_px);
  };
  EXPECT_EQ(size(PictureProtocol::kBlocks, {100, 40, 1000, 800}), std::pair(100u, 78u));
  EXPECT_EQ(size(PictureProtocol::kKitty, {100, 40, 1000, 800}), std::pair(1000u, 780u));
  EXPECT_EQ(size(PictureProtocol::kKitty, {100, 40, 0, 0}), std::pair(800u, 624u));
  EXPECT_EQ(size(PictureProtocol::kITerm, {200, 50, 4096, 2000}), std::pair(1024u, 490u));
  EXPECT_EQ(size(PictureProtocol::kBlocks, {1, 1, 0, 0}), std::pair(1u, 2u));
}

TEST(PictureText, CarriesAFileInChunksThatKittyTakes) {
  std::string file;
  for (int i = 0; i < 7000; ++i) file += static_cast<char>(i * 31);
  std::string text = picture_text(PictureProtocol::kKitty, file, {100, 40, 0, 0});
  EXPECT_THAT(text, StartsWith("\x1b[H\x1b_Ga=T,f=100,i=1,p=1,q=2,C=1,c=100,r=39,m=1;"));
  std::string coded;
  for (size_t at = text.find(";"); at != std::string::npos; at = text.find(";", at)) {
    const size_t end = text.find("\x1b\\", ++at);
    ASSERT_NE(end, std::string::npos);
    EXPECT_LE(end - at, 4096u);
    EXPECT_EQ(text.substr(at - 4, 4), end + 2 == text.size() ? "m=0;" : "m=1;");
    coded += text.substr(at, end - at);
    at = end;
  }
  std::string decoded;
  ASSERT_TRUE(absl::Base64Unescape(coded, &decoded));
  EXPECT_EQ(decoded, file);
}

TEST(PictureText, CarriesAFileAsITermHasIt) {
  EXPECT_EQ(picture_text(PictureProtocol::kITerm, "abc", {80, 24, 0, 0}),
            "\x1b[H\x1b]1337;File=inline=1;size=3;width=80;height=23;preserveAspectRatio=0:YWJj\a");
}

TEST(BlocksText, HoldsTwoPixelsACellAndSaysColoursOnce) {
  TextureData picture;
  picture.width_px = 2;
  picture.height_px = 4;
  // Red over blue, twice; then half a green over nothing, and white over white.
  picture.rgba = {255, 0,   0, 255, 255, 0,   0,   255, 0, 0, 255, 255, 0,   0,   255, 255,
                  0,   255, 0, 128, 255, 255, 255, 255, 9, 9, 9,   0,   255, 255, 255, 255};
  EXPECT_EQ(blocks_text(picture),
            "\x1b[1;1H\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m▀▀\x1b[0m"
            "\x1b[2;1H\x1b[38;2;0;128;0m\x1b[48;2;0;0;0m▀\x1b[38;2;255;255;255m\x1b[48;2;255;255;255m▀\x1b[0m");
}

}  // namespace
}  // namespace diaphane::cli
