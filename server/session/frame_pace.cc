#include "session/frame_pace.h"

#include <algorithm>
#include <cmath>

namespace diaphane::session {
namespace {

constexpr double kUsualRate = 30;  // of frames, where only bytes are bounded
constexpr absl::Duration kBurst = absl::Milliseconds(250);
constexpr double kTooMuch = 1.1;
constexpr double kRoom = 0.9;
constexpr int kSettled = 3;  // frames that were on their way before a step are not judged
constexpr int kLongest = 256;
constexpr int kJpegStep = 10;
constexpr uint32_t kFewestPixels = 32;  // a side

uint32_t scaled(uint32_t size_px, double scale) {
  const auto smaller = static_cast<uint32_t>(std::lround(size_px * scale));
  return std::min(size_px, std::max(smaller, kFewestPixels));
}

}  // namespace

void FramePace::Ladder::see(double load, double rise) {
  ++quiet_;
  if (quiet_ <= kSettled) return;
  load_ = quiet_ == kSettled + 1 ? load : 0.7 * load_ + 0.3 * load;
  if (load_ > kTooMuch && step_ < lowest_) {
    patience_ = rose_ ? std::min(2 * patience_, kLongest) : patience_;
    rose_ = false;
    ++step_;
    quiet_ = 0;
  } else if (step_ > 0 && load_ < kTooMuch && rise < kRoom && quiet_ > patience_) {
    rose_ = true;
    --step_;
    quiet_ = 0;
  }
}

void FramePace::set_aim(const PaceAim& aim) {
  if (aim == aim_) return;
  *this = FramePace();
  aim_ = aim;
}

absl::Time FramePace::next_start() const { return std::max(next_start_, paid_until_ - kBurst); }

void FramePace::began(absl::Time now) {
  if (aim_.frames_per_second <= 0) return;
  const absl::Duration period = absl::Seconds(1 / aim_.frames_per_second);
  // From the due time on, so that lateness does not add up; an idle time is not made good.
  next_start_ = (now - next_start_ < period ? next_start_ : now) + period;
}

bool FramePace::reduce(render::FrameRequest& request, encode::Encoding& encoding) const {
  const bool integral = request.settings.technique == render::Technique::kIntegral;
  const int finer = integral ? static_cast<int>(request.settings.quality) : 0;
  const int coarser = std::min(time_.step(), finer);
  request.settings.quality = static_cast<diffusion::Quality>(static_cast<int>(request.settings.quality) - coarser);

  const bool lossy = encoding.format == encode::ImageFormat::kJpeg || encoding.format == encode::ImageFormat::kWebp;
  const int steps = lossy ? std::max(0, (encoding.quality - kLowestQuality + kJpegStep - 1) / kJpegStep) : 0;
  const bool video = encoding.format == encode::ImageFormat::kH264;  // whose encoder keeps to a rate
  if (video && aim_.bytes_per_second > 0) {
    encoding.bits_per_second = std::min(encoding.bits_per_second, static_cast<uint32_t>(8 * aim_.bytes_per_second));
  }
  const int for_size = video ? 0 : size_.step();
  const int lower = std::min(for_size, steps);
  if (lower > 0) {
    encoding.quality = std::max(kLowestQuality, encoding.quality - kJpegStep * lower);
  }

  const int smaller = time_.step() - coarser + for_size - lower;
  const double scale = std::max(kSmallestScale, std::exp2(-0.25 * smaller));
  const uint32_t even = video ? ~1u : ~0u;
  const uint32_t width_px = scaled(request.width_px, scale) & even;
  const uint32_t height_px = scaled(request.height_px, scale) & even;
  const bool reduced = coarser > 0 || lower > 0 || width_px != request.width_px || height_px != request.height_px;
  request.width_px = width_px;
  request.height_px = height_px;
  return reduced;
}

void FramePace::moved(const Moved& frame) {
  // What waits behind another frame of the same viewer is not late by it.
  const absl::Duration took = frame.ended - std::max(frame.began, last_ended_);
  last_ended_ = std::max(last_ended_, frame.ended);
  if (aim_.frames_per_second > 0) {
    const double rate = aim_.frames_per_second;
    time_.see(absl::ToDoubleSeconds(took) * rate, 1.45 * frame.work_ms / 1000 * rate);
  }
  if (aim_.bytes_per_second > 0) {
    const double rate = aim_.frames_per_second > 0 ? aim_.frames_per_second : kUsualRate;
    const double load = static_cast<double>(frame.bytes) * rate / aim_.bytes_per_second;
    size_.see(load, 1.35 * load);
  }
}

void FramePace::sent(absl::Time now, size_t bytes) {
  if (aim_.bytes_per_second <= 0) return;
  const absl::Duration takes = absl::Seconds(static_cast<double>(bytes) / aim_.bytes_per_second);
  paid_until_ = std::max(paid_until_, now) + takes;
}

}  // namespace diaphane::session
