#include "album.h"

#include <fstream>

#include "fmt/format.h"

namespace diaphane::examples {
namespace {

namespace fs = std::filesystem;

constexpr double kFramesPerSecond = 12;
constexpr int kCell_px = 192;

absl::Status save(const RenderedFrame& frame, const fs::path& path) {
  std::ofstream picture(path, std::ios::binary);
  picture.write(frame.image.data(), static_cast<std::streamsize>(frame.image.size()));
  if (!picture.flush()) return absl::DataLossError(fmt::format("{}: cannot be written", path.string()));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Album> Album::open(const fs::path& folder, const Size& size) {
  Album album;
  album.folder_ = folder;
  album.files_ = {"contact_sheet.png", "demo.webp"};
  const media::AnimationOptions options{.width_px = 2 * static_cast<int>(size.width_px),
                                        .height_px = static_cast<int>(size.height_px),
                                        .frames_per_second = kFramesPerSecond};
  auto webp = media::open_webp(folder / "demo.webp", options);
  if (!webp.ok()) return webp.status();
  album.animations_.push_back(*std::move(webp));
  auto mp4 = media::open_mp4(folder / "demo.mp4", options);
  if (mp4.ok()) {
    album.files_.push_back(fmt::format("demo.mp4 (by {})", (*mp4)->encoder()));
    album.animations_.push_back(*std::move(mp4));
  } else if (absl::IsUnimplemented(mp4.status()) || absl::IsUnavailable(mp4.status())) {
    album.notes_.push_back(fmt::format("no demo.mp4: {}", std::string(mp4.status().message())));
  } else {
    return mp4.status();
  }
  return album;
}

absl::Status Album::add(const RenderedFrame& integral, const RenderedFrame& paper) {
  std::vector<media::Picture> pictures;
  for (const auto& [name, frame] : {std::pair("integral", &integral), std::pair("paper", &paper)}) {
    const absl::Status saved = save(*frame, folder_ / fmt::format("{}_{:03}.png", name, count_));
    if (!saved.ok()) return saved;
    absl::StatusOr<media::Picture> picture = media::decode_picture(frame->image);
    if (!picture.ok()) return picture.status();
    sheet_[pictures.size()].push_back({media::shrunk(*picture, kCell_px), ""});
    pictures.push_back(*std::move(picture));
  }
  ++count_;
  const media::Picture both = media::beside(pictures);
  for (const auto& animation : animations_) {
    if (absl::Status added = animation->add(both); !added.ok()) return added;
  }
  return absl::OkStatus();
}

absl::Status Album::finish() {
  const absl::StatusOr<media::Picture> sheet = media::contact_sheet(sheet_, {.cell_px = kCell_px});
  if (!sheet.ok()) return sheet.status();
  if (absl::Status written = media::write_png(*sheet, folder_ / "contact_sheet.png"); !written.ok()) return written;
  for (const auto& animation : animations_) {
    if (absl::Status finished = animation->finish(); !finished.ok()) return finished;
  }
  return absl::OkStatus();
}

}  // namespace diaphane::examples
