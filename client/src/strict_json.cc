#include "strict_json.h"

#include <cctype>
#include <set>
#include <string>
#include <vector>

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace diaphane::internal {
namespace {

using nlohmann::json;

constexpr size_t kMaxDepth = 32;

// protobuf takes display_name and displayName for the same field.
std::string normalised(std::string_view key) {
  std::string name;
  for (const unsigned char c : key) {
    if (c != '_') name.push_back(static_cast<char>(std::tolower(c)));
  }
  return name;
}

// Sees the text's events one by one and builds nothing.
class Checker final : public json::json_sax_t {
 public:
  const std::string& error() const { return error_; }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(json::number_integer_t) override { return true; }
  bool number_unsigned(json::number_unsigned_t) override { return true; }
  bool number_float(json::number_float_t, const json::string_t&) override { return true; }
  bool string(json::string_t&) override { return true; }
  bool binary(json::binary_t&) override { return true; }
  bool start_object(size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool start_array(size_t) override { return open(); }
  bool end_array() override { return close(); }

  bool key(json::string_t& key) override {
    if (keys_.back().insert(normalised(key)).second) return true;
    error_ = fmt::format("'{}' is given twice", key);
    return false;
  }

  bool parse_error(size_t, const std::string&, const json::exception& exception) override {
    const std::string_view what = exception.what();
    const size_t prefix = what.find("] ");
    error_ = prefix == std::string_view::npos ? what : what.substr(prefix + 2);
    return false;
  }

 private:
  bool open() {
    keys_.emplace_back();
    if (keys_.size() <= kMaxDepth) return true;
    error_ = fmt::format("nested deeper than {}", kMaxDepth);
    return false;
  }

  bool close() {
    keys_.pop_back();
    return true;
  }

  std::vector<std::set<std::string>> keys_;
  std::string error_;
};

}  // namespace

absl::Status check_json(std::string_view text) {
  Checker checker;
  if (json::sax_parse(text.begin(), text.end(), &checker)) return absl::OkStatus();
  return absl::InvalidArgumentError(checker.error());
}

}  // namespace diaphane::internal
