#include "service/convert/vertex_positions.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/status.h"
#include "fmt/format.h"
#include "geometry/topology.h"
#include "meshoptimizer.h"
#include "service/convert/check.h"

namespace diaphane::service {
namespace {

using Steps = glm::vec<3, uint16_t>;
// As the codec has them: its elements are of four bytes or a multiple.
using PaddedSteps = glm::vec<4, uint16_t>;
static_assert(sizeof(glm::vec3) == 12 && sizeof(Steps) == 6 && sizeof(PaddedSteps) == 8);

// The codec gives each sixteen bytes of a kind two bits at least.
constexpr uint64_t kMostExpansion = 64;

uint64_t most_elements(uint64_t coded_bytes, uint64_t each) {
  // Of more no memory is left anyway; and the product stays in range.
  return kMostExpansion * std::min(coded_bytes, uint64_t{1} << 40) / each;
}

size_t bytes_of_one(const v1::VertexPositions& message) {
  const bool coded = message.meshopt_count() != 0;
  return message.has_quantized() ? coded ? sizeof(PaddedSteps) : sizeof(Steps) : sizeof(glm::vec3);
}

/// What came with the message.
std::string_view inline_bytes(const v1::VertexPositions& message) {
  return message.has_quantized() ? message.quantized().uint16() : message.float32();
}

uint64_t size_in_bytes(const v1::VertexPositions& message) {
  if (message.has_shared()) return message.shared().bytes();
  return message.payload_bytes() != 0 ? message.payload_bytes() : inline_bytes(message).size();
}

std::string_view field_of(const v1::VertexPositions& message) {
  if (message.has_shared()) return "positions.shared.bytes";
  if (message.payload_bytes() != 0) return "positions.payload_bytes";
  return message.has_quantized() ? "positions.quantized.uint16" : "positions.float32";
}

/// Whether so many bytes can be the positions.
absl::Status check_plain_size(const v1::VertexPositions& message) {
  const uint64_t each = bytes_of_one(message), bytes = size_in_bytes(message);
  const auto indices = static_cast<uint64_t>(message.indices_size());
  const std::string got = fmt::format("{} bytes", bytes);
  if (bytes == 0 || bytes % each != 0) {
    return base::invalid_field(field_of(message), fmt::format("whole positions of {} bytes, at least one", each), got);
  }
  if (indices != 0 && bytes != each * indices) {
    return base::invalid_field(field_of(message), fmt::format("{} bytes, as many positions as indices", each * indices),
                               got);
  }
  return absl::OkStatus();
}

absl::Status check_coded_count(const v1::VertexPositions& message) {
  const auto indices = static_cast<uint32_t>(message.indices_size());
  const uint32_t count = message.meshopt_count();
  if (indices != 0 && indices != count) {
    return base::invalid_field("positions.meshopt_count", fmt::format("{}, as many as indices", indices),
                               fmt::format("{}", count));
  }
  const uint64_t most = most_elements(size_in_bytes(message), bytes_of_one(message));
  if (count <= most) return absl::OkStatus();
  return base::invalid_field("positions.meshopt_count",
                             fmt::format("what {} bytes can hold, at most {}", size_in_bytes(message), most),
                             fmt::format("{}", count));
}

/// The elements that the codec made `bytes` of.
template <typename Element>
absl::StatusOr<std::vector<Element>> decoded(std::string_view field, std::string_view bytes, uint32_t count) {
  std::vector<Element> elements(count);
  if (meshopt_decodeVertexBuffer(elements.data(), count, sizeof(Element),
                                 reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()) == 0) {
    return elements;
  }
  return base::invalid_field(
      field, fmt::format("{} elements of {} bytes by meshoptimizer's vertex codec", count, sizeof(Element)),
      fmt::format("{} bytes that are not", bytes.size()));
}

constexpr std::string_view kFloats = "positions.float32", kSteps = "positions.quantized.uint16";

/// A mean of the ends, so that they are met.
glm::vec3 in_box(const Steps& steps, const glm::vec3& lowest, const glm::vec3& highest) {
  const glm::vec3 share = glm::vec3(steps) / 65535.f;
  return lowest * (1.f - share) + highest * share;
}

// So much is copied, and looked at while it is near.
constexpr size_t kAtOnce = 2048;

}  // namespace

absl::StatusOr<PositionsReader> PositionsReader::begin(const v1::VertexPositions& message, FindShared find_shared) {
  PositionsReader reader;
  reader.quantized_ = message.has_quantized();
  if (reader.quantized_) {
    const auto lowest = position_from_proto(message.quantized().lowest(), "positions.quantized.lowest");
    if (!lowest.ok()) return lowest.status();
    const auto highest = position_from_proto(message.quantized().highest(), "positions.quantized.highest");
    if (!highest.ok()) return highest.status();
    reader.lowest_ = *lowest;
    reader.highest_ = *highest;
  } else if (message.values_case() != v1::VertexPositions::kFloat32) {
    return base::invalid_field("positions.values", "float32 or quantized", "none");
  }
  if (message.payload_bytes() != 0 && (message.has_shared() || !inline_bytes(message).empty())) {
    return base::invalid_field("positions.payload_bytes", "0 with bytes that are here",
                               fmt::format("{}", message.payload_bytes()));
  }
  if (message.has_shared() && !inline_bytes(message).empty()) {
    return base::invalid_field("positions.shared", "unset with bytes in the message", "set");
  }
  reader.coded_count_ = message.meshopt_count();
  const absl::Status size = reader.coded_count_ == 0 ? check_plain_size(message) : check_coded_count(message);
  if (!size.ok()) return size;
  reader.patch_.indices.assign(message.indices().begin(), message.indices().end());
  reader.patch_.displacements = message.displacements();
  reader.bytes_to_come_ = message.payload_bytes();
  if (message.has_shared()) {
    const absl::StatusOr<std::string_view> bytes = find_shared(message.shared());
    if (!bytes.ok()) return base::within("positions.", bytes.status());
    // The codec may look at bytes twice.
    if (reader.coded_count_ != 0) reader.coded_ = *bytes;
    const absl::Status taken = reader.take(reader.coded_count_ != 0 ? reader.coded_ : *bytes);
    if (!taken.ok()) return taken;
    return reader;
  }
  if (reader.bytes_to_come_ == 0) {
    if (absl::Status taken = reader.take(inline_bytes(message)); !taken.ok()) return taken;
    return reader;
  }
  if (reader.coded_count_ == 0) {
    reader.patch_.positions.reserve(reader.bytes_to_come_ / bytes_of_one(message));
  } else {
    reader.coded_.reserve(reader.bytes_to_come_);
  }
  return reader;
}

absl::Status PositionsReader::add(std::string_view bytes) {
  const size_t each = coded_count_ != 0 ? 1 : quantized_ ? sizeof(Steps) : sizeof(glm::vec3);
  if (bytes.empty() || bytes.size() > bytes_to_come_ || bytes.size() % each != 0) {
    return base::invalid_field("payload", fmt::format("1..{} bytes, a multiple of {}", bytes_to_come_, each),
                               fmt::format("{} bytes", bytes.size()));
  }
  bytes_to_come_ -= bytes.size();
  if (coded_count_ == 0) return take(bytes);
  coded_.append(bytes);
  return bytes_to_come_ == 0 ? take(coded_) : absl::OkStatus();
}

/// Plain ones, or all that the codec made.
absl::Status PositionsReader::take(std::string_view bytes) {
  std::vector<glm::vec3>& positions = patch_.positions;
  if (quantized_) {
    if (coded_count_ == 0) {
      take_steps({reinterpret_cast<const Steps*>(bytes.data()), bytes.size() / sizeof(Steps)});
      return absl::OkStatus();
    }
    const auto steps = decoded<PaddedSteps>(kSteps, bytes, coded_count_);
    if (!steps.ok()) return steps.status();
    positions.reserve(steps->size());
    for (const PaddedSteps& s : *steps) positions.push_back(in_box(Steps(s), lowest_, highest_));
    return absl::OkStatus();
  }
  if (coded_count_ != 0) {
    auto coded = decoded<glm::vec3>(kFloats, bytes, coded_count_);
    if (!coded.ok()) return coded.status();
    positions = *std::move(coded);
    return geometry::check_finite(positions, kFloats);
  }
  return take_floats({reinterpret_cast<const glm::vec3*>(bytes.data()), bytes.size() / sizeof(glm::vec3)});
}

/// Each is copied once, into memory that nothing wrote before, and it is the copy that is checked.
absl::Status PositionsReader::take_floats(std::span<const glm::vec3> values) {
  std::vector<glm::vec3>& positions = patch_.positions;
  positions.reserve(positions.size() + values.size());
  bool finite = true;
  for (size_t first = 0; first < values.size(); first += kAtOnce) {
    const auto some = values.subspan(first, std::min(kAtOnce, values.size() - first));
    positions.insert(positions.end(), some.begin(), some.end());
    finite &= geometry::check_finite(std::span(positions).last(some.size()), kFloats).ok();
  }
  return finite ? absl::OkStatus() : geometry::check_finite(positions, kFloats);
}

void PositionsReader::take_steps(std::span<const Steps> steps) {
  std::array<glm::vec3, kAtOnce> values;
  patch_.positions.reserve(patch_.positions.size() + steps.size());
  for (size_t first = 0; first < steps.size(); first += kAtOnce) {
    const auto some = steps.subspan(first, std::min(kAtOnce, steps.size() - first));
    std::transform(some.begin(), some.end(), values.begin(),
                   [&](const Steps& s) { return in_box(s, lowest_, highest_); });
    patch_.positions.insert(patch_.positions.end(), values.begin(),
                            values.begin() + static_cast<ptrdiff_t>(some.size()));
  }
}

uint64_t decoded_bytes(const v1::VertexPositions& message) {
  const uint64_t each = bytes_of_one(message), bytes = size_in_bytes(message);
  const uint64_t count = message.meshopt_count();
  const uint64_t payload = message.has_shared() ? bytes : message.payload_bytes();
  if (count == 0) return payload / each * sizeof(glm::vec3);
  if (count > most_elements(bytes, each)) return 0;
  return payload + count * (message.has_quantized() ? each + sizeof(glm::vec3) : each);
}

}  // namespace diaphane::service
