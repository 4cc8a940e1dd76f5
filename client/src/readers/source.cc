#include "readers/source.h"

#include "fmt/format.h"

namespace diaphane::readers {
namespace {

constexpr size_t kLongestQuote = 40;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

absl::Status Source::error(absl::StatusCode code, std::string_view what, std::string_view where,
                           std::string_view range) const {
  std::string line = fmt::format("{}: {}", name, what);
  for (std::string_view part : {where, range}) {
    if (!part.empty()) line += fmt::format(", {}", part);
  }
  for (char& c : line) {
    if (is_control(c)) c = '?';
  }
  return absl::Status(code, line);
}

absl::Status Source::malformed(std::string_view what, std::string_view where, std::string_view range) const {
  return error(absl::StatusCode::kInvalidArgument, what, where, range);
}

absl::Status Source::malformed(std::string_view what, Place where, std::string_view range) const {
  return malformed(what, to_string(where), range);
}

absl::Status Source::over_limit(std::string_view what, uint64_t count, uint64_t limit) const {
  return error(absl::StatusCode::kResourceExhausted, fmt::format("{} {}", count, what), {},
               fmt::format("must be at most {}", limit));
}

absl::Status Source::unsupported(std::string_view feature, std::string_view where) const {
  return error(absl::StatusCode::kUnimplemented, fmt::format("{} cannot be read", feature), where);
}

std::string in_quotes(std::string_view text) {
  std::string line(text.substr(0, kLongestQuote));
  for (char& c : line) {
    if (is_control(c) || static_cast<unsigned char>(c) >= 0x80) c = '?';
  }
  return fmt::format("\"{}{}\"", line, text.size() > kLongestQuote ? "..." : "");
}

std::string to_string(Place place) { return fmt::format("{} {}", place.unit, place.number); }

}  // namespace diaphane::readers
