// The rooms of server/ include only rooms on lower floors, and the client none of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

const std::map<std::string, int> kFloors = {{"base", 0},   {"geometry", 1},  {"optics", 1},  {"encode", 1},
                                            {"gl", 1},     {"diffusion", 2}, {"scene", 2},   {"store", 3},
                                            {"render", 3}, {"session", 4},   {"service", 5}, {"app", 6}};

struct Include {
  std::string file;    // relative to the project
  std::string target;  // what stands between the quotes or brackets
};

std::vector<Include> includes_below(const std::string& folder) {
  static const std::regex directive("^\\s*#\\s*include\\s+[\"<]([^\">]+)[\">]");
  const fs::path root = DIAPHANE_SOURCE_DIR;
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const std::string suffix = entry.path().extension();
    if (suffix != ".h" && suffix != ".cc") continue;
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);) {
      if (std::regex_search(line, match, directive)) {
        includes.push_back({fs::relative(entry.path(), root).string(), match[1]});
      }
    }
  }
  return includes;
}

// The first folder of a path, which is a room's name where it is one.
std::string first_folder(const std::string& path) { return path.substr(0, path.find('/')); }

TEST(Rooms, HaveAFloorEach) {
  std::vector<std::string> without;
  for (const auto& entry : fs::directory_iterator(fs::path(DIAPHANE_SOURCE_DIR) / "server")) {
    if (entry.is_directory() && !kFloors.contains(entry.path().filename())) without.push_back(entry.path().filename());
  }
  EXPECT_THAT(without, IsEmpty());
}

TEST(Rooms, IncludeOnlyRoomsOnLowerFloors) {
  std::vector<std::string> wrong;
  std::vector<std::string> seen;
  for (const Include& include : includes_below("server")) {
    const std::string here = first_folder(include.file.substr(std::string("server/").size()));
    const auto there = kFloors.find(first_folder(include.target));
    if (there == kFloors.end()) continue;
    seen.push_back(there->first);
    if (there->first != here && there->second >= kFloors.at(here)) {
      wrong.push_back(include.file + " includes " + include.target);
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
  // The test sees what it judges.
  EXPECT_THAT(seen, IsSupersetOf({"base", "geometry", "optics", "scene", "render", "session", "service"}));
}

TEST(Rooms, KeepGlBelowTheSession) {
  std::vector<std::string> wrong;
  for (const char* room : {"server/session", "server/service"}) {
    for (const Include& include : includes_below(room)) {
      const std::string there = first_folder(include.target);
      if (there == "gl" || there == "epoxy" || there == "EGL" || there == "GL") {
        wrong.push_back(include.file + " includes " + include.target);
      }
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(Contract, IsReadOnlyByTheService) {
  std::vector<std::string> wrong;
  for (const Include& include : includes_below("server")) {
    const std::string there = first_folder(include.target);
    const bool contract = there == "diaphane" || there == "google" || there == "grpcpp";
    const std::string here = first_folder(include.file.substr(std::string("server/").size()));
    if (contract && kFloors.at(here) < kFloors.at("service"))
      wrong.push_back(include.file + " includes " + include.target);
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(Client, IncludesNoRoomOfTheServer) {
  std::vector<std::string> wrong;
  for (const Include& include : includes_below("client")) {
    if (kFloors.contains(first_folder(include.target)) || include.target.find("server/") != std::string::npos) {
      wrong.push_back(include.file + " includes " + include.target);
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
}

}  // namespace
