// Folders and servers for tests of the command line.
#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

#include "client/src/child_process.h"
#include "nlohmann/json.hpp"
#include "programs.h"

namespace diaphane::testing_support {

/// Each test in a folder of its own that holds cube.obj.
class CliTest : public testing::Test {
 protected:
  CliTest();
  ~CliTest() override;

  Finished run(const std::vector<std::string>& arguments) const { return run_diaphane(folder_, arguments); }

  /// A refusal: that exit code, nothing on stdout, and one line on stderr, which is returned.
  std::string refusal(int exit_code, const std::vector<std::string>& arguments) const;

  /// render cube.obj, small and 20 mm high, and `more`.
  static std::vector<std::string> render(const std::vector<std::string>& more);

  std::filesystem::path folder_;
};

/// With a server on a free port of the loopback interface.
class CliWithServerTest : public CliTest {
 protected:
  /// `flags` for the server beside those that every one of these has.
  explicit CliWithServerTest(const std::vector<std::string>& flags = {});
  ~CliWithServerTest() override { server_.stop(std::chrono::seconds(30)); }

  std::vector<std::string> with_server(std::vector<std::string> words) const;
  nlohmann::json scenes() const;

  internal::ChildProcess server_;
  std::string address_;
};

}  // namespace diaphane::testing_support
