#include "readers/text.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace diaphane::readers {
namespace {

bool parts_tokens(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f' || c == '\\';
}

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// from_chars takes no leading '+', which files do have.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') token.remove_prefix(1);
  return token;
}

}  // namespace

size_t LineReader::end_of_line(size_t from) const { return std::min(text_.find_first_of("\r\n", from), text_.size()); }

size_t LineReader::after_end_of_line(size_t end) const {
  if (text_.substr(end, 2) == "\r\n") return end + 2;
  return std::min(end + 1, text_.size());
}

bool LineReader::next(std::string_view& line, bool join_backslashes) {
  if (offset_ >= text_.size()) return false;
  const size_t begin = offset_;
  line_ = next_line_;
  size_t end = end_of_line(begin);
  offset_ = after_end_of_line(end);
  ++next_line_;
  while (join_backslashes && end > begin && text_[end - 1] == '\\' && offset_ < text_.size()) {
    end = end_of_line(offset_);
    offset_ = after_end_of_line(end);
    ++next_line_;
  }
  line = text_.substr(begin, end - begin);
  return true;
}

std::string_view next_token(std::string_view& rest) {
  const auto begin = std::find_if_not(rest.begin(), rest.end(), parts_tokens);
  rest.remove_prefix(static_cast<size_t>(begin - rest.begin()));
  if (rest.empty() || rest.front() == '#') {
    rest = {};
    return {};
  }
  const auto end = std::find_if(rest.begin(), rest.end(), [](char c) { return parts_tokens(c) || c == '#'; });
  const size_t length = static_cast<size_t>(end - rest.begin());
  const std::string_view token = rest.substr(0, length);
  rest.remove_prefix(length);
  return token;
}

bool parse_number(std::string_view token, double& value) {
  token = without_plus(token);
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (stop != end || token.empty()) return false;
  if (error == std::errc::result_out_of_range) {
    const size_t exponent = token.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && token.substr(exponent + 1, 1) == "-";
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    return true;
  }
  return error == std::errc();
}

bool parse_integer(std::string_view token, int64_t& value) {
  token = without_plus(token);
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  return error == std::errc() && stop == end && !token.empty();
}

bool equals_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return to_lower(x) == to_lower(y); });
}

}  // namespace diaphane::readers
