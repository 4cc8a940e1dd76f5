#include "readers/ply_header.h"

#include <cmath>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "readers/text.h"

namespace diaphane::readers {
namespace {

// Enough for any file that is meant; keeps a hostile header from costing time.
constexpr size_t kMostElements = 100;
constexpr size_t kMostProperties = 1000;

std::optional<PlyType> parse_type(std::string_view token) {
  static constexpr std::pair<std::string_view, PlyType> kTypes[] = {
      {"char", PlyType::kInt8},      {"int8", PlyType::kInt8},       {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},    {"short", PlyType::kInt16},     {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},  {"uint16", PlyType::kUint16},   {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},    {"uint", PlyType::kUint32},     {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},  {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64}};
  for (const auto& [name, type] : kTypes) {
    if (token == name) return type;
  }
  return std::nullopt;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const Source& source) : bytes_(bytes), source_(source) {}

  absl::StatusOr<PlyHeader> parse() {
    std::string_view line;
    if (!next_line(line) || line != "ply") {
      return source_.malformed(fmt::format("{} at its start", in_quotes(line)), "", "must be \"ply\"");
    }
    bool has_format = false;
    while (next_line(line)) {
      const std::string_view keyword = next_token(line);
      absl::Status status;
      if (keyword == "end_header") {
        if (!has_format) return source_.malformed("no format", Place{"line", line_});
        header_.body_offset = offset_;
        header_.body_line = line_ + 1;
        status = check_counts();
        if (!status.ok()) return status;
        return std::move(header_);
      }
      if (keyword == "format") {
        status = parse_format(line);
        has_format = true;
      } else if (keyword == "element") {
        status = parse_element(line);
      } else if (keyword == "property") {
        status = parse_property(line);
      } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
        return malformed(fmt::format("{} in the header", in_quotes(keyword)),
                         "must be format, element, property, comment or end_header");
      }
      if (!status.ok()) return status;
    }
    return malformed("ends within the header", "must have end_header");
  }

 private:
  absl::Status malformed(std::string_view what, std::string_view range) const {
    return source_.malformed(what, Place{"line", line_}, range);
  }

  // Lines end as the first one does, so that a binary body may begin with any byte.
  bool next_line(std::string_view& line) {
    if (offset_ >= bytes_.size()) return false;
    if (line_ == 0) {
      const size_t end = bytes_.find_first_of("\r\n");
      if (end == std::string_view::npos) return false;
      line_end_ = bytes_.substr(end, bytes_.substr(end, 2) == "\r\n" ? 2 : 1);
    }
    const size_t end = bytes_.find(line_end_, offset_);
    if (end == std::string_view::npos) return false;
    line = bytes_.substr(offset_, end - offset_);
    offset_ = end + line_end_.size();
    ++line_;
    return true;
  }

  absl::Status parse_format(std::string_view rest) {
    const std::string_view token = next_token(rest);
    if (token == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (token == "binary_little_endian") {
      header_.format = PlyFormat::kLittleEndian;
    } else if (token == "binary_big_endian") {
      header_.format = PlyFormat::kBigEndian;
    } else {
      return malformed(fmt::format("format {}", in_quotes(token)),
                       "must be ascii, binary_little_endian or binary_big_endian");
    }
    const std::string_view version = next_token(rest);
    return version == "1.0" ? absl::OkStatus()
                            : malformed(fmt::format("version {}", in_quotes(version)), "must be 1.0");
  }

  absl::Status parse_element(std::string_view rest) {
    PlyElement element;
    element.name = next_token(rest);
    const std::string_view token = next_token(rest);
    int64_t count = 0;
    if (element.name.empty() || !parse_integer(token, count) || count < 0) {
      return malformed(fmt::format("element {} {}", in_quotes(element.name), in_quotes(token)),
                       "must have a name and a count of at least 0");
    }
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) return malformed(fmt::format("a second element {}", in_quotes(element.name)), "");
    }
    if (header_.elements.size() == kMostElements) {
      return source_.over_limit("elements", kMostElements + 1, kMostElements);
    }
    element.count = static_cast<uint64_t>(count);
    header_.elements.push_back(std::move(element));
    return absl::OkStatus();
  }

  absl::Status parse_property(std::string_view rest) {
    if (header_.elements.empty()) return malformed("a property before any element", "");
    PlyProperty property;
    std::string_view token = next_token(rest);
    if (token == "list") {
      property.is_list = true;
      token = next_token(rest);
      const std::optional<PlyType> type = parse_type(token);
      if (!type || !is_integer(*type)) {
        return malformed(fmt::format("list count type {}", in_quotes(token)), "must be an integer type");
      }
      property.count_type = *type;
      token = next_token(rest);
    }
    const std::optional<PlyType> type = parse_type(token);
    if (!type) return malformed(fmt::format("type {}", in_quotes(token)), "must be char, uchar, ..., float or double");
    property.type = *type;
    property.name = next_token(rest);
    if (property.name.empty()) return malformed("a property without a name", "");
    PlyElement& element = header_.elements.back();
    if (element.find(property.name) >= 0) {
      return malformed(fmt::format("a second property {}", in_quotes(property.name)), "");
    }
    if (++properties_ > kMostProperties) {
      return source_.over_limit("properties", properties_, kMostProperties);
    }
    element.properties.push_back(property);
    return absl::OkStatus();
  }

  // Before anything is allocated: the rows that the header promises have to fit into what is left of the file.
  absl::Status check_counts() const {
    uint64_t left = bytes_.size() - header_.body_offset;
    // The last ASCII value needs no blank behind it.
    if (header_.format == PlyFormat::kAscii) ++left;
    for (const PlyElement& element : header_.elements) {
      uint64_t row = 0;
      for (const PlyProperty& property : element.properties) {
        row +=
            header_.format == PlyFormat::kAscii ? 2 : size_of(property.is_list ? property.count_type : property.type);
      }
      if (row > 0 && element.count > left / row) {
        return source_.malformed(fmt::format("{} of element {}", element.count, in_quotes(element.name)),
                                 "in the header", fmt::format("at most {} fit into the rest of the file", left / row));
      }
      left -= row * element.count;
    }
    return absl::OkStatus();
  }

  std::string_view bytes_;
  const Source& source_;
  PlyHeader header_;
  std::string_view line_end_;
  size_t offset_ = 0;
  uint64_t line_ = 0;
  uint64_t properties_ = 0;
};

}  // namespace

size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 0;
}

bool is_integer(PlyType type) { return type != PlyType::kFloat32 && type != PlyType::kFloat64; }

double largest_of(PlyType type) {
  const bool is_signed = type == PlyType::kInt8 || type == PlyType::kInt16 || type == PlyType::kInt32;
  return std::exp2(8.0 * static_cast<double>(size_of(type)) - (is_signed ? 1 : 0)) - 1;
}

int PlyElement::find(std::string_view property) const {
  for (size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return static_cast<int>(i);
  }
  return -1;
}

absl::StatusOr<PlyHeader> parse_ply_header(std::string_view bytes, const Source& source) {
  return HeaderParser(bytes, source).parse();
}

}  // namespace diaphane::readers
