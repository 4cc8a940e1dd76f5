// What the demo leaves: frames, a contact sheet, and animations.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "diaphane/render_options.h"
#include "media/animation.h"
#include "media/sheet.h"

namespace diaphane::examples {

/// Keeps the frames of two techniques, side by side where they move. One thread.
class Album {
 public:
  /// The folder must be there. An MP4 is made where libavcodec can; notes() says why not.
  static absl::StatusOr<Album> open(const std::filesystem::path& folder, const Size& size);

  /// integral_NNN.png and paper_NNN.png, and the next frame of the animations.
  absl::Status add(const RenderedFrame& integral, const RenderedFrame& paper);

  /// contact_sheet.png, demo.webp, demo.mp4.
  absl::Status finish();

  /// The files that finish() left, by name.
  const std::vector<std::string>& files() const { return files_; }
  /// One line each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::unique_ptr<media::AnimationWriter>> animations_;
  std::vector<std::vector<media::Cell>> sheet_ = std::vector<std::vector<media::Cell>>(2);  // integral, paper
  std::vector<std::string> files_;
  std::vector<std::string> notes_;
  uint32_t count_ = 0;
};

}  // namespace diaphane::examples
