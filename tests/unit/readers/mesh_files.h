// Small mesh files for the tests.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "diaphane/readers.h"

namespace diaphane::testing {

/// A folder of the running test's own, emptied when it ends.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            (std::string(test->test_suite_name()) + "." + test->name() + "." + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// What read_mesh_file() makes of `bytes` in a file called `name`.
inline absl::StatusOr<LoadedFile> read_bytes(const std::string& name, std::string_view bytes,
                                             const ReadLimits& limits = {}) {
  const ScratchFolder folder;
  return read_mesh_file(folder.write(name, bytes), limits);
}

/// `value` as it lies in a little-endian file.
template <typename T>
std::string raw(T value) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

/// A GLB file of one JSON chunk and, unless `binary` is empty, one binary chunk.
inline std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string chunks = raw(static_cast<uint32_t>(json.size())) + "JSON" + json;
  if (!binary.empty()) chunks += raw(static_cast<uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
  return "glTF" + raw(uint32_t{2}) + raw(static_cast<uint32_t>(12 + chunks.size())) + chunks;
}

inline std::string message(const absl::StatusOr<LoadedFile>& file) { return std::string(file.status().message()); }

}  // namespace diaphane::testing
