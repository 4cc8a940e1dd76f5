#include "encode/srgb_profile.h"

#include <cmath>
#include <initializer_list>
#include <iterator>
#include <string_view>

namespace diaphane::encode {
namespace {

/// Big-endian, as ICC.1:2010 has everything.
class Bytes {
 public:
  void u16(uint32_t value) {
    bytes_.push_back(static_cast<uint8_t>(value >> 8));
    bytes_.push_back(static_cast<uint8_t>(value));
  }
  void u32(uint32_t value) {
    u16(value >> 16);
    u16(value & 0xffff);
  }
  void fixed(double value) { u32(static_cast<uint32_t>(static_cast<int32_t>(std::lround(value * 65536)))); }
  void text(std::string_view ascii) { bytes_.insert(bytes_.end(), ascii.begin(), ascii.end()); }
  void zeros(size_t count) { bytes_.insert(bytes_.end(), count, 0); }
  void pad() { zeros((4 - bytes_.size() % 4) % 4); }
  void append(const Bytes& other) { bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end()); }
  size_t size() const { return bytes_.size(); }
  const std::vector<uint8_t>& all() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

Bytes localized(std::string_view ascii) {
  constexpr uint32_t kRecordBytes = 12;
  constexpr uint32_t kTextOffset = 28;
  Bytes bytes;
  bytes.text("mluc");
  bytes.u32(0);
  bytes.u32(1);
  bytes.u32(kRecordBytes);
  bytes.text("enUS");
  bytes.u32(static_cast<uint32_t>(2 * ascii.size()));
  bytes.u32(kTextOffset);
  for (const char c : ascii) bytes.u16(static_cast<uint8_t>(c));
  return bytes;
}

Bytes numbers(std::string_view type, std::initializer_list<double> values) {
  Bytes bytes;
  bytes.text(type);
  bytes.u32(0);
  for (const double value : values) bytes.fixed(value);
  return bytes;
}

/// Y = (aX + b)^g for X ≥ d, else cX.
Bytes curve() {
  constexpr uint32_t kFiveParameters = 3;
  Bytes bytes;
  bytes.text("para");
  bytes.u32(0);
  bytes.u16(kFiveParameters);
  bytes.u16(0);
  for (const double value : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}) bytes.fixed(value);
  return bytes;
}

void header(uint32_t profile_bytes, Bytes& bytes) {
  bytes.u32(profile_bytes);
  bytes.u32(0);
  bytes.u32(0x04300000);
  bytes.text("mntrRGB XYZ ");
  for (const uint32_t field : {2020, 1, 1, 0, 0, 0}) bytes.u16(field);  // made when: any day, but always the same
  bytes.text("acsp");
  bytes.zeros(28);  // platform, flags, maker, model, attributes, intent (perceptual)
  for (const double white : {0.9642, 1.0, 0.8249}) bytes.fixed(white);
  bytes.zeros(48);
}

std::vector<uint8_t> make_profile() {
  struct Tag {
    std::string_view name;
    Bytes data;
  };
  // Bradford's adaptation from D65 to D50, and the primaries after it, as the registry of ICC gives them.
  const Tag tags[] = {
      {"desc", localized("sRGB")},
      {"cprt", localized("No copyright, use freely")},
      {"wtpt", numbers("XYZ ", {0.9642, 1, 0.8249})},
      {"rXYZ", numbers("XYZ ", {0.43607, 0.22249, 0.01392})},
      {"gXYZ", numbers("XYZ ", {0.38515, 0.71687, 0.09708})},
      {"bXYZ", numbers("XYZ ", {0.14307, 0.06061, 0.7141})},
      {"chad", numbers("sf32", {1.04788, 0.02292, -0.05022, 0.02959, 0.99048, -0.01707, -0.00925, 0.01508, 0.75168})},
      {"rTRC", curve()}};
  constexpr std::string_view kSharedCurves[] = {"gTRC", "bTRC"};
  constexpr size_t kHeaderBytes = 128, kEntryBytes = 12;
  const size_t count = std::size(tags) + std::size(kSharedCurves);
  Bytes table, data;
  table.u32(static_cast<uint32_t>(count));
  const size_t first = kHeaderBytes + 4 + kEntryBytes * count;
  const auto enter = [&](std::string_view name, size_t offset, size_t size) {
    table.text(name);
    table.u32(static_cast<uint32_t>(offset));
    table.u32(static_cast<uint32_t>(size));
  };
  size_t offset = first;
  for (const Tag& tag : tags) {
    offset = first + data.size();
    enter(tag.name, offset, tag.data.size());
    data.append(tag.data);
    data.pad();
  }
  for (const std::string_view name : kSharedCurves) enter(name, offset, tags[std::size(tags) - 1].data.size());
  Bytes profile;
  header(static_cast<uint32_t>(first + data.size()), profile);
  profile.append(table);
  profile.append(data);
  return profile.all();
}

}  // namespace

const std::vector<uint8_t>& srgb_profile() {
  static const std::vector<uint8_t> kProfile = make_profile();
  return kProfile;
}

}  // namespace diaphane::encode
