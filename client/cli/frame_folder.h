// The pictures of a sequence in a folder, where a run that was stopped goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace diaphane::cli {

/// frame_00000.EXT and so on, each there whole or not at all, beside sequence.json, which says what they are of:
/// several runs, on several machines, may fill one folder.
class FrameFolder {
 public:
  /// Makes the folder unless it is there. `job` is what the frames depend on, as text.
  ///
  /// Errors: kExitFile it cannot be made or written; kExitUsage it holds frames of another job.
  static absl::StatusOr<FrameFolder> open(const std::filesystem::path& folder, std::string_view extension,
                                          std::string_view job);

  std::filesystem::path path_of(uint32_t frame) const;
  bool has(uint32_t frame) const;
  absl::Status write(uint32_t frame, std::string_view bytes) const;

  /// Deletes the first `frames` of them, sequence.json, and the folder if nothing else is in it.
  void remove(uint32_t frames) const;

 private:
  FrameFolder(std::filesystem::path folder, std::string_view extension)
      : folder_(std::move(folder)), extension_(extension) {}

  std::filesystem::path folder_;
  std::string extension_;
};

}  // namespace diaphane::cli
