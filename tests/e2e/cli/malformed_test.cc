// Every malformed mesh file that is at hand, through the program as a person would run it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <iostream>
#include <map>
#include <set>

#include "fixture.h"

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;

constexpr long kLargestMemory_kib = 1 << 20;
constexpr auto kLongest = std::chrono::seconds(20);

std::vector<fs::path> mesh_files_below(const fs::path& folder) {
  const std::set<std::string> kinds = {".obj", ".ply", ".stl", ".off", ".gltf", ".glb"};
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::string kind = entry.path().extension().string();
    for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (entry.is_regular_file() && kinds.contains(kind)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// A bound on time that a busy machine does not break: what is caught is a hang.
TEST_F(CliWithServerTest, MalformedFilesRenderOrAreRefusedInOneLine) {
  const fs::path folder = DIAPHANE_SOURCE_DIR "/../shared/data/malformed";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  std::map<int, int> count_of_exit_code;
  for (const fs::path& file : mesh_files_below(folder)) {
    const auto begin = std::chrono::steady_clock::now();
    const Finished finished =
        run(with_server({"render", file.string(), "--mm-per-unit", "1", "--size", "32x32", "-o", "x.png"}));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, kLongest) << file;
    EXPECT_LT(finished.peak_memory_kib, kLargestMemory_kib) << file;
    EXPECT_THAT(finished.exit_code, testing::AnyOf(0, 4, 5)) << file << ": " << finished.err;
    const auto lines = std::count(finished.err.begin(), finished.err.end(), '\n');
    // A file that renders may have had parts left out.
    EXPECT_LE(lines, 1) << file << ": " << finished.err;
    if (finished.exit_code != 0) {
      EXPECT_EQ(lines, 1) << file;
    }
    EXPECT_THAT(finished.err, testing::AnyOf("", testing::HasSubstr(file.filename().string())));
    ++count_of_exit_code[finished.exit_code];
  }
  for (const auto& [code, count] : count_of_exit_code) std::cout << count << " files with exit code " << code << "\n";
  EXPECT_GT(count_of_exit_code[5], 0);
}

}  // namespace
}  // namespace diaphane::testing_support
