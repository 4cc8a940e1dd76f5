// diaphane view, in a terminal.
#include <signal.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "fixture.h"

namespace diaphane::testing_support {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr const char* kAtRest = "at rest";
constexpr const char* kLeave = "\x1b[?25h\x1b[?1049l";

class ViewTest : public CliTest {
 protected:
  // Not all of its vertices lie on its bounding sphere, as a cube's do.
  ViewTest() {
    write_file(folder_ / "pyramid.obj",
               "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 3 0\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n");
  }

  Finished view(const std::vector<std::string>& more, const std::vector<Typed>& typed) const {
    std::vector<std::string> arguments = {"view", "pyramid.obj", "--height-mm", "20"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_diaphane_in_terminal(folder_, arguments, typed);
  }
};

/// What was drawn, picture by picture, without what the last row says.
std::vector<std::string> pictures(const std::string& out, const std::string& begin, const std::string& last_row) {
  std::vector<std::string> found;
  for (size_t at = out.find(begin); at != std::string::npos; at = out.find(begin, at + 1)) {
    const size_t end = out.find(last_row, at);
    if (end != std::string::npos) found.push_back(out.substr(at, end - at));
  }
  return found;
}

TEST_F(ViewTest, DrawsInHalfBlocksUntilTheUserEndsIt) {
  const Finished finished = view({"--protocol", "blocks"}, {{kAtRest, "q"}});
  EXPECT_EQ(finished.exit_code, 0) << finished.out;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("\x1b[?1049h"), HasSubstr("▀"), HasSubstr("\x1b[11;1H"), EndsWith(kLeave)));
}

TEST_F(ViewTest, TurnsByKeysAndComesBack) {
  const Finished finished =
      view({"--protocol", "blocks"}, {{kAtRest, "\x1b[C"}, {kAtRest, "0"}, {kAtRest, "++"}, {kAtRest, "q"}});
  ASSERT_EQ(finished.exit_code, 0) << finished.out;
  // Of each place the frames are the same while it moves and at rest.
  std::vector<std::string> drawn = pictures(finished.out, "\x1b[1;1H", "\x1b[12;1H");
  drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
  ASSERT_GE(drawn.size(), 4u);
  EXPECT_EQ(drawn[2], drawn[0]);
  EXPECT_NE(drawn[1], drawn[0]);
  EXPECT_NE(drawn.back(), drawn[0]);
}

TEST_F(ViewTest, ShowsWhatMovesInKittysProtocolAndStopsIt) {
  // The sphere begins slowly.
  std::vector<Typed> typed(12, {"frames/s", ""});
  typed.push_back({"frames/s", " "});
  typed.push_back({kAtRest, "q"});
  const Finished finished = view({"--protocol", "kitty", "--morph", "sphere"}, typed);
  ASSERT_EQ(finished.exit_code, 0) << finished.out;
  const std::vector<std::string> drawn = pictures(finished.out, "\x1b[H\x1b_Ga=T,f=100", "\x1b[12;1H");
  const std::set<std::string> different(drawn.begin(), drawn.end());
  EXPECT_GE(different.size(), 2u);
}

TEST_F(ViewTest, PutsTheTerminalBackOnCtrlC) {
  const Finished finished = view({"--protocol", "iterm"}, {{kAtRest, "\x03"}});
  EXPECT_EQ(finished.exit_code, 128 + SIGINT);
  EXPECT_THAT(finished.out, AllOf(HasSubstr("\x1b]1337;File=inline=1"), HasSubstr(kLeave)));
}

TEST_F(ViewTest, RefusesWhatIsNoTerminalAndWhatItDoesNotKnow) {
  EXPECT_THAT(refusal(2, {"view", "cube.obj"}), HasSubstr("stdin and stdout must be a terminal"));
  EXPECT_THAT(refusal(2, {"view", "cube.obj", "--size", "64x64"}), HasSubstr("--size: does not go with view"));
  EXPECT_THAT(refusal(2, {"view", "cube.obj", "--protocol", "sixel"}),
              HasSubstr("must be kitty | iterm | blocks, got 'sixel'"));
}

TEST_F(ViewTest, SaysOnAWorkingTerminalWhatTheServerRefuses) {
  const Finished finished = view({"--technique", "reference"}, {});
  EXPECT_EQ(finished.exit_code, 4) << finished.out;
  EXPECT_THAT(finished.out, AllOf(HasSubstr(std::string(kLeave) + "diaphane: "), HasSubstr("technique")));
}

}  // namespace
}  // namespace diaphane::testing_support
