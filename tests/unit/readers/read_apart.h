// Files that may be hostile, read in a process of their own.
#pragma once

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <string>

#include "tests/unit/readers/mesh_files.h"

namespace diaphane::testing {

// A sanitizer's own memory and time are not the reader's.
#ifdef __SANITIZE_ADDRESS__
inline constexpr long kMostMemory_kib = 8 << 20;
inline constexpr rlim_t kMostProcessor_s = 60;
#else
inline constexpr long kMostMemory_kib = 1 << 20;
inline constexpr rlim_t kMostProcessor_s = 5;
#endif

struct Outcome {
  bool exited = false;
  std::string line;  // "read", or the status
  long peak_kib = 0;
};

/// Reads `path` in a process of its own, which may use kMostProcessor_s and, on a busy machine, some minutes.
inline Outcome read_apart(const std::filesystem::path& path) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    const rlimit seconds{kMostProcessor_s, kMostProcessor_s};
    setrlimit(RLIMIT_CPU, &seconds);
    alarm(250);
    const auto file = read_mesh_file(path);
    uint64_t triangles = 0;
    for (size_t i = 0; file.ok() && i < file->meshes.size(); ++i) triangles += file->meshes[i].triangles.size() / 3;
    const std::string line = file.ok() ? "read" : file.status().ToString();
    if (write(ends[1], line.data(), line.size()) < 0) _exit(2);
    _exit(file.ok() && triangles == 0 ? 3 : 0);
  }
  close(ends[1]);
  Outcome outcome;
  char buffer[4096];
  for (ssize_t got; (got = read(ends[0], buffer, sizeof(buffer))) > 0;)
    outcome.line.append(buffer, static_cast<size_t>(got));
  close(ends[0]);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  outcome.exited = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  outcome.peak_kib = usage.ru_maxrss;
  return outcome;
}

/// It ended by itself, in bounds, and said in one short line what is wrong where something is.
inline void expect_bounded(const Outcome& outcome, const std::filesystem::path& path) {
  EXPECT_TRUE(outcome.exited) << path << ": " << outcome.line;
  EXPECT_LT(outcome.peak_kib, kMostMemory_kib) << path;
  EXPECT_EQ(std::count(outcome.line.begin(), outcome.line.end(), '\n'), 0) << outcome.line;
  if (outcome.line == "read") return;
  EXPECT_THAT(outcome.line, ::testing::HasSubstr(path.string() + ": ")) << path;
  EXPECT_LT(outcome.line.size(), path.string().size() + 300) << outcome.line;
}

}  // namespace diaphane::testing
