// The file that is being read, and the one form that every refusal of it takes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "diaphane/readers.h"

namespace diaphane::readers {

/// Where in a file something stands: "line 12", "byte 400", "face 3".
struct Place {
  std::string_view unit;
  uint64_t number = 0;
};

/// What is known of the file besides its bytes, and its errors. Thread-safe (const).
struct Source {
  std::string name;              ///< as errors name it
  std::filesystem::path folder;  ///< where files that it refers to may lie; empty: it may refer to none
  ReadLimits limits;

  /// kInvalidArgument "NAME: WHAT, WHERE, RANGE"; empty parts are left out, and control characters replaced.
  absl::Status malformed(std::string_view what, std::string_view where = {}, std::string_view range = {}) const;
  absl::Status malformed(std::string_view what, Place where, std::string_view range = {}) const;

  /// kResourceExhausted "NAME: `count` WHAT, must be at most `limit`".
  absl::Status over_limit(std::string_view what, uint64_t count, uint64_t limit) const;

  /// kUnimplemented "NAME: FEATURE cannot be read, WHERE".
  absl::Status unsupported(std::string_view feature, std::string_view where = {}) const;

  /// The same three parts under any code.
  absl::Status error(absl::StatusCode code, std::string_view what, std::string_view where = {},
                     std::string_view range = {}) const;
};

/// At most 40 characters of a file's own text, printable, in quotes: safe to put into a message.
std::string in_quotes(std::string_view text);

std::string to_string(Place place);

}  // namespace diaphane::readers
