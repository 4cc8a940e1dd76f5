// Radiance pictures: Ward, "Real pixels", Graphics Gems II (1991), and the file formats of Radiance.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "fmt/format.h"
#include "readers/environment.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

struct Rgbe {
  uint8_t r = 0, g = 0, b = 0, e = 0;
};

constexpr uint32_t kShortestNewRun_px = 8, kLongestNewRun_px = 32767;  // widths that the newer coding is for

class RadianceReader {
 public:
  RadianceReader(std::string_view bytes, const Source& source) : bytes_(bytes), source_(source) {}

  absl::StatusOr<EnvironmentMap> read() {
    if (absl::Status header = read_header(); !header.ok()) return header;
    std::vector<Rgbe> row(map_.width_px);
    for (uint32_t y = 0; y < map_.height_px; ++y) {
      if (absl::Status line = read_row(row, y); !line.ok()) return line;
      // A row at a time: a short file cannot ask for the memory of a long one.
      for (const Rgbe& pixel : row) map_.radiance.push_back(decode(pixel));
    }
    return std::move(map_);
  }

 private:
  Rgb decode(const Rgbe& pixel) const {
    if (pixel.e == 0) return {};
    const float scale = std::ldexp(1.0f, pixel.e - (128 + 8)) / exposure_;
    return {scale * pixel.r, scale * pixel.g, scale * pixel.b};
  }

  bool next_line(std::string_view& line) {
    const size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) return false;
    line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return true;
  }

  absl::Status read_header() {
    std::string_view line;
    while (next_line(line) && !line.empty()) {
      if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
        return source_.unsupported(in_quotes(line), "header");
      }
      if (line.starts_with("EXPOSURE=")) {
        double exposure = 0;
        std::string_view rest = line.substr(9);
        if (!parse_number(next_token(rest), exposure) || !(exposure >= 1e-12 && exposure <= 1e12)) {
          return source_.malformed(in_quotes(line), "header", "must be EXPOSURE=1e-12..1e12");
        }
        exposure_ *= static_cast<float>(exposure);
      }
    }
    if (!(exposure_ >= 1e-12f && exposure_ <= 1e12f)) return source_.malformed("exposures that multiply out of range");
    if (!next_line(line)) return source_.malformed("ends within its header");
    std::string_view rest = line;
    const std::string_view y = next_token(rest), height = next_token(rest), x = next_token(rest),
                           width = next_token(rest);
    int64_t height_px = 0, width_px = 0;
    if (!parse_integer(height, height_px) || !parse_integer(width, width_px)) {
      return source_.malformed(in_quotes(line), "header", "must be -Y HEIGHT +X WIDTH");
    }
    if (y != "-Y" || x != "+X")
      return source_.unsupported(fmt::format("the orientation {}", in_quotes(line)), "header");
    if (absl::Status size = check_map_size(width_px, height_px, source_); !size.ok()) return size;
    map_.width_px = static_cast<uint32_t>(width_px);
    map_.height_px = static_cast<uint32_t>(height_px);
    return absl::OkStatus();
  }

  size_t left() const { return bytes_.size() - at_; }
  uint8_t next() { return static_cast<uint8_t>(bytes_[at_++]); }

  absl::Status truncated(uint32_t y) const { return source_.malformed("ends within its pixels", Place{"row", y}); }

  absl::Status read_row(std::vector<Rgbe>& row, uint32_t y) {
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(bytes_[at_ + i]); };
    const bool has_new_runs = row.size() >= kShortestNewRun_px && row.size() <= kLongestNewRun_px && left() >= 4 &&
                              byte(0) == 2 && byte(1) == 2 && (byte(2) & 0x80) == 0;
    if (!has_new_runs) return read_old_row(row, y);
    if ((byte(2) << 8 | byte(3)) != static_cast<int>(row.size())) {
      return source_.malformed(fmt::format("a row of {} pixels", byte(2) << 8 | byte(3)), Place{"row", y},
                               fmt::format("must be {}", row.size()));
    }
    at_ += 4;
    for (uint8_t Rgbe::*const channel : {&Rgbe::r, &Rgbe::g, &Rgbe::b, &Rgbe::e}) {
      if (absl::Status read = read_channel(row, channel, y); !read.ok()) return read;
    }
    return absl::OkStatus();
  }

  // Runs of one channel: a count above 128 repeats the byte after it, else that many bytes follow.
  absl::Status read_channel(std::vector<Rgbe>& row, uint8_t Rgbe::*channel, uint32_t y) {
    for (size_t x = 0; x < row.size();) {
      if (left() < 2) return truncated(y);
      const uint8_t code = next();
      const bool repeats = code > 128;
      const size_t count = repeats ? code - 128u : code;
      if (count == 0 || count > row.size() - x) {
        return source_.malformed(fmt::format("a run of {}", count), Place{"row", y},
                                 fmt::format("must be 1..{}", row.size() - x));
      }
      if (left() < (repeats ? 1 : count)) return truncated(y);
      const uint8_t repeated = repeats ? next() : uint8_t{0};
      for (size_t i = 0; i < count; ++i) row[x++].*channel = repeats ? repeated : next();
    }
    return absl::OkStatus();
  }

  // Plain pixels; 1, 1, 1, n repeats the one before n times, and one right behind it counts in 256ths more.
  absl::Status read_old_row(std::vector<Rgbe>& row, uint32_t y) {
    uint32_t shift = 0;
    for (size_t x = 0; x < row.size();) {
      if (left() < 4) return truncated(y);
      Rgbe pixel;
      std::memcpy(&pixel, bytes_.data() + at_, 4);
      at_ += 4;
      if (pixel.r != 1 || pixel.g != 1 || pixel.b != 1) {
        row[x++] = pixel;
        shift = 0;
        continue;
      }
      const size_t count = size_t{pixel.e} << shift;
      if (x == 0 || shift > 16 || count > row.size() - x) {
        return source_.malformed(fmt::format("a run of {}", count), Place{"row", y},
                                 fmt::format("must be behind a pixel, and at most {}", row.size() - x));
      }
      for (size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    }
    return absl::OkStatus();
  }

  std::string_view bytes_;
  const Source& source_;
  size_t at_ = 0;
  float exposure_ = 1;
  EnvironmentMap map_;
};

}  // namespace

bool is_radiance(std::string_view bytes) { return bytes.starts_with("#?"); }

absl::StatusOr<EnvironmentMap> read_radiance(std::string_view bytes, const Source& source) {
  return RadianceReader(bytes, source).read();
}

}  // namespace diaphane::readers
