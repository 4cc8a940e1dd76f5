#include "fixture.h"

#include <stdlib.h>

#include <algorithm>

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kListening = "listening on ";

std::vector<std::string> server_words(const std::vector<std::string>& flags) {
  std::vector<std::string> words{"--listen", "127.0.0.1:0", "--exit-with-stdin", "--warm", "none"};
  words.insert(words.end(), flags.begin(), flags.end());
  return words;
}

}  // namespace

CliTest::CliTest() {
  std::string pattern = (fs::temp_directory_path() / "diaphane_cli_XXXXXX").string();
  folder_ = mkdtemp(pattern.data());
  write_file(folder_ / "cube.obj", cube_obj());
}

CliTest::~CliTest() { fs::remove_all(folder_); }

std::string CliTest::refusal(int exit_code, const std::vector<std::string>& arguments) const {
  const Finished finished = run(arguments);
  EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  EXPECT_THAT(finished.err, testing::StartsWith("diaphane: "));
  return finished.err;
}

std::vector<std::string> CliTest::render(const std::vector<std::string>& more) {
  std::vector<std::string> words{"render", "cube.obj", "--size", "64x48", "--height-mm", "20"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

CliWithServerTest::CliWithServerTest(const std::vector<std::string>& flags)
    : server_(internal::ChildProcess::start(std::string(DIAPHANE_BIN_DIR) + "/diaphane-server", server_words(flags),
                                            /*inherit_stderr=*/true)
                  .value()) {
  const std::string line = server_.read_line(std::chrono::minutes(2), {}).value();
  EXPECT_THAT(line, testing::StartsWith("listening on 127.0.0.1:"));
  address_ = line.substr(kListening.size());
}

std::vector<std::string> CliWithServerTest::with_server(std::vector<std::string> words) const {
  words.insert(words.begin(), {"--server", address_});
  return words;
}

nlohmann::json CliWithServerTest::scenes() const {
  return nlohmann::json::parse(run(with_server({"--json", "scene", "ls"})).out);
}

}  // namespace diaphane::testing_support
