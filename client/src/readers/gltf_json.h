// JSON into a tree that holds only what is read of a glTF file, and that no file can make large or deep.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "nlohmann/json.hpp"
#include "readers/source.h"

namespace diaphane::readers {

/// Takes nlohmann's SAX events (json::sax_parse). Left out are root members that are not read, extras, extensions but
/// kReadExtensions, and the min and max of accessors. nlohmann's own filtering parser would do but for its cost, which
/// grows with the square of an array's length.
class GltfJsonBuilder {
 public:
  using json = nlohmann::json;

  static constexpr size_t kDeepest = 64;
  static constexpr uint64_t kMostValues = 8'000'000;
  /// Objects per limits.max_nodes: a node with its own mesh, primitive, accessors and views.
  static constexpr uint64_t kMostObjectsPerNode = 10;

  explicit GltfJsonBuilder(const Source& source);

  json take() { return std::move(root_); }
  /// Why the parse stopped.
  const absl::Status& error() const { return error_; }

  bool null() { return add(json()); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(int64_t value);
  bool number_unsigned(uint64_t value);
  bool number_float(double value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(json::binary_t&) { return false; }
  bool start_object(size_t);
  bool start_array(size_t);
  bool key(std::string& name);
  bool end_object() { return end(); }
  bool end_array() { return end(); }
  bool parse_error(size_t position, const std::string& token, const json::exception& error);

 private:
  bool add(json value);
  bool start(json container);
  bool end();
  bool stop(absl::Status error);
  json* place(json value);

  const Source& source_;
  const uint64_t most_objects_;
  json root_;
  struct Open {
    json* container;
    bool is_extensions;  // the value of a member of that name
  };

  std::vector<Open> open_;  // containers that have not ended; the outermost is root_
  json* member_ = nullptr;  // of the innermost object, named and still without its value
  bool member_is_extensions_ = false;
  bool skipping_ = false;      // the value of a member that is left out
  size_t skipped_levels_ = 0;  // containers of that value which have not ended
  uint64_t values_ = 0;
  uint64_t objects_ = 0;
  absl::Status error_;
};

}  // namespace diaphane::readers
