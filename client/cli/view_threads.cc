#include "view_threads.h"

#include <algorithm>
#include <string_view>

#include "diaphane/texture.h"
#include "fmt/format.h"

namespace diaphane::cli {

void Outcome::end(const absl::Status& status) {
  const std::lock_guard lock(mutex_);
  if (status_.ok()) status_ = status;
  ended_ = true;
}

absl::Status Outcome::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

Screen::Screen(FrameStream& stream, Terminal& terminal, PictureProtocol protocol, Outcome& outcome)
    : stream_(stream), terminal_(terminal), protocol_(protocol), thread_([this, &outcome] { outcome.end(run()); }) {}

Screen::~Screen() {
  stream_.close();
  thread_.join();
}

absl::Status Screen::run() {
  while (true) {
    const absl::StatusOr<StreamedFrame> frame = stream_.next();
    if (absl::IsCancelled(frame.status())) return absl::OkStatus();
    if (!frame.ok()) return frame.status();
    if (absl::Status drawn = draw(*frame); !drawn.ok()) return drawn;
  }
}

absl::Status Screen::draw(const StreamedFrame& frame) {
  const TerminalExtent extent = terminal_.extent();
  std::string text;
  if (drawn_ != extent) text = "\x1b[0m\x1b[2J";
  if (protocol_ == PictureProtocol::kBlocks) {
    const absl::StatusOr<TextureData> picture = decode_texture(frame.frame.image, true);
    if (!picture.ok()) return picture.status();
    const Size wanted = picture_size(protocol_, extent);
    // One of before the window changed does not fit into it.
    if (picture->width_px != wanted.width_px || picture->height_px != wanted.height_px) return absl::OkStatus();
    text += blocks_text(*picture);
  } else {
    text += picture_text(protocol_, frame.frame.image, extent);
  }
  drawn_ = extent;
  return terminal_.write(text + last_row(frame, extent));
}

std::string Screen::last_row(const StreamedFrame& frame, const TerminalExtent& extent) {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - before_).count();
  before_ = now;
  // A mean of the last few.
  frames_per_second_ += 0.2 * (1 / std::max(seconds, 1e-3) - frames_per_second_);
  const std::string pace = frame.at_rest ? "at rest" : fmt::format("{:.1f} frames/s", frames_per_second_);
  const std::string said = fmt::format("{:<14}  arrows turn  +/- nearer, away  0 back  space stops  q ends", pace);
  return fmt::format("\x1b[{};1H\x1b[0;2m{}\x1b[0m\x1b[K", extent.rows,
                     std::string_view(said).substr(0, extent.columns - 1));
}

Mover::Mover(Animator& animator, double edits_per_second, Outcome& outcome)
    : animator_(animator),
      between_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / edits_per_second))),
      thread_([this, &outcome] {
        if (const absl::Status moved = run(); !moved.ok()) outcome.end(moved);
      }) {}

Mover::~Mover() {
  stopped_ = true;
  thread_.join();
}

absl::Status Mover::run() {
  Clock::time_point next = Clock::now();
  for (uint32_t edit = 0; !stopped_;) {
    // Poses that there was no time for are not made up for.
    next = std::max(next + between_, Clock::now());
    std::this_thread::sleep_until(next);
    if (paused_) continue;
    if (absl::Status sent = animator_.send(edit); !sent.ok()) return sent;
    edit = (edit + 1) % animator_.edits();
  }
  return absl::OkStatus();
}

}  // namespace diaphane::cli
