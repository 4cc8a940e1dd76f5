// Lines, tokens and numbers of text formats, without a locale and without a copy.
#pragma once

#include <cstdint>
#include <string_view>

#include "readers/source.h"

namespace diaphane::readers {

/// Hands out the lines of a text; "\n", "\r\n" and "\r" end one. The text outlives the reader.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// The next line without its end, or false after the last. With `join_backslashes`, a line that ends in a backslash
  /// continues on the next: the ends inside it are left in, which tokens() takes for spaces.
  bool next(std::string_view& line, bool join_backslashes = false);

  /// Where the last line began, counted from 1.
  Place place() const { return {"line", line_}; }

 private:
  size_t end_of_line(size_t from) const;
  size_t after_end_of_line(size_t end) const;

  std::string_view text_;
  size_t offset_ = 0;
  uint64_t line_ = 0;
  uint64_t next_line_ = 1;
};

/// Takes the next token off `rest`, or gives an empty one. Blanks, line ends and backslashes part tokens; '#' ends all.
std::string_view next_token(std::string_view& rest);

/// The whole token as a number: decimal, "nan" and "inf" included, "1e-999" is 0. False where it is none.
bool parse_number(std::string_view token, double& value);

/// The whole token as a decimal integer. False where it is none or does not fit.
bool parse_integer(std::string_view token, int64_t& value);

/// ASCII only.
bool equals_ignoring_case(std::string_view a, std::string_view b);

}  // namespace diaphane::readers
