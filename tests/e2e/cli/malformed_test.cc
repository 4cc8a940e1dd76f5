// Malformed mesh files, those at hand and some made here, through the program as a person would run it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>

#include "fixture.h"

namespace diaphane::testing_support {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

constexpr long kLargestMemory_kib = 1 << 20;
// A bound on time that a busy machine does not break, nor what sanitizers cost: what is caught is a hang.
#ifdef __SANITIZE_ADDRESS__
constexpr Seconds kLongest{120};
#else
constexpr Seconds kLongest{20};
#endif

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

// The most memory that a process had, by Linux's account of it.
long peak_memory_kib(const std::string& pid) {
  std::ifstream status("/proc/" + pid + "/status");
  std::string word;
  long kib = 0;
  while (status >> word) {
    if (word == "VmHWM:") status >> kib;
  }
  return kib;
}

// The one child that runs while no command line does: the server.
std::string server_pid() {
  std::string pid;
  for (const auto& task : fs::directory_iterator("/proc/self/task")) {
    std::ifstream children(task.path() / "children");
    for (std::string child; children >> child;) pid = child;
  }
  return pid;
}

class MalformedFileTest : public CliWithServerTest {
 protected:
  /// Renders `file` and checks what holds for every file. Its exit code.
  int render_in_bounds(const fs::path& file) {
    const auto begin = std::chrono::steady_clock::now();
    const Finished finished =
        run(with_server({"render", file.string(), "--mm-per-unit", "1", "--size", "32x32", "-o", "x.png"}));
    const Seconds took = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(took.count(), kLongest.count()) << file;
    EXPECT_LT(finished.peak_memory_kib, kLargestMemory_kib) << file;
    EXPECT_THAT(finished.exit_code, testing::AnyOf(0, 4, 5)) << file << ": " << finished.err;
    const auto lines = std::count(finished.err.begin(), finished.err.end(), '\n');
    // A file that renders may have had parts left out.
    EXPECT_LE(lines, 1) << file << ": " << finished.err;
    if (finished.exit_code != 0) {
      EXPECT_EQ(lines, 1) << file;
    }
    if (finished.exit_code != 4) {
      EXPECT_THAT(finished.err, testing::AnyOf("", testing::HasSubstr(file.filename().string())));
    }
    longest_ = std::max(longest_, took);
    largest_kib_ = std::max(largest_kib_, finished.peak_memory_kib);
    return finished.exit_code;
  }

  /// The server lived through it, in bounds, and keeps nothing.
  void check_server() {
    const long server_kib = peak_memory_kib(server_pid());
    EXPECT_GT(server_kib, 0) << "no server";
    EXPECT_LT(server_kib, kLargestMemory_kib);
    EXPECT_TRUE(scenes().empty());
    std::cout << std::fixed << std::setprecision(2) << "longest " << longest_.count()
              << " s; most memory: command line " << largest_kib_ / 1024 << " MiB, server " << server_kib / 1024
              << " MiB\n";
  }

 private:
  Seconds longest_{0};
  long largest_kib_ = 0;
};

TEST_F(MalformedFileTest, AtHandRendersOrIsRefusedInOneLine) {
  const fs::path folder = DIAPHANE_SOURCE_DIR "/../shared/data/malformed";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  std::map<std::string, std::map<int, int>> count_of_code_of_folder;
  for (const fs::path& file : mesh_files_below(folder)) {
    const int code = render_in_bounds(file);
    ++count_of_code_of_folder[fs::relative(file, folder).begin()->string()][code];
    ++count_of_code_of_folder["all"][code];
  }
  std::cout << std::left << std::setw(16) << "exit code"
            << "    0    4    5\n";
  for (auto& [name, count_of_code] : count_of_code_of_folder) {
    std::cout << std::left << std::setw(16) << name << std::right;
    for (const int code : {0, 4, 5}) std::cout << std::setw(5) << count_of_code[code];
    std::cout << "\n";
  }
  EXPECT_GT(count_of_code_of_folder["all"][5], 0);
  check_server();
}

// Meshes that a reader has no cause to refuse, and a renderer might choke on.
TEST_F(MalformedFileTest, MadeHereRendersOrIsRefusedInOneLine) {
  std::string fan = "v 0 0 0\nv 0 0 1\n", soup, sliver;
  for (int i = 0; i < 2000; ++i) {
    fan += "v " + std::to_string(i) + " 1 0\nf 1 2 " + std::to_string(i + 3) + "\n";
    soup += "v " + std::to_string(i * 7919 % 101) + " " + std::to_string(i * 104729 % 97) + " " +
            std::to_string(i * 31 % 89) + "\n";
  }
  for (int i = 3; i < 2000; ++i)
    soup += "f " + std::to_string(i) + " " + std::to_string(i - 1) + " " + std::to_string(i / 2) + "\n";
  for (int i = 0; i < 100; ++i) sliver += "v " + std::to_string(i) + " " + (i % 2 == 0 ? "0" : "1e-30") + " 0\n";
  for (int i = 3; i <= 100; ++i) {
    sliver += "f " + std::to_string(i - 2) + " " + std::to_string(i - 1) + " " + std::to_string(i) + "\n";
  }
  const std::map<std::string, std::string> files = {
      {"largest_floats.obj", "v 3.4e38 0 0\nv -3.4e38 0 0\nv 0 3.4e38 0\nv 0 0 3.4e38\nf 1 2 3\nf 1 2 4\n"},
      {"large_floats.obj", "v 1e17 0 0\nv -1e17 0 0\nv 0 1e17 0\nv 0 0 1e17\nf 1 2 3\nf 1 2 4\n"},
      {"smallest_floats.obj", "v 1e-45 0 0\nv 0 0 0\nv 0 1e-45 0\nf 1 2 3\n"},
      {"small_floats.obj", "v 1e-20 0 0\nv 0 0 0\nv 0 1e-20 0\nf 1 2 3\n"},
      {"wide_range.obj", "v 1e15 0 0\nv 0 0 0\nv 0 1e-15 0\nv 1 1 1\nf 1 2 3\nf 2 3 4\n"},
      {"one_place.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"},
      {"one_line.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"},
      {"one_plane.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"both_sides.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\nf 1 2 3\n"},
      {"stray_vertex.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nv 1e30 1e30 1e30\nf 1 2 3\n"},
      {"wild_normals.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn 3e38 3e38 3e38\nvn nan 0 0\nf 1//1 2//2 3//3\n"},
      {"fan.obj", fan},
      {"soup.obj", soup},
      {"sliver.obj", sliver},
      {"huge_scale.gltf",
       R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0,"scale":[3e38,3e38,3e38]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"},
      {"tiny_scale.gltf",
       R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0,"scale":[1e-30,1,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"},
      {"empty.ply", ""},
  };
  for (const auto& [name, text] : files) {
    write_file(folder_ / name, text);
    const int code = render_in_bounds(folder_ / name);
    std::cout << code << " " << std::quoted(name) << "\n";
  }
  check_server();
}

}  // namespace
}  // namespace diaphane::testing_support
