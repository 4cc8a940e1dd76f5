#include "payload.h"

#include <openssl/evp.h>

#include <algorithm>
#include <bit>
#include <memory>

namespace diaphane::internal {

static_assert(std::endian::native == std::endian::little, "payloads are little-endian");
static_assert(sizeof(Vec3) == 3 * sizeof(float) && sizeof(Rgb) == 3 * sizeof(float),
              "they travel as they lie in memory");

void Payload::append_bytes(std::span<const std::byte> bytes) {
  parts_.push_back(bytes);
  total_bytes_ += bytes.size();
}

std::string Payload::sha256() const {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  for (const auto part : parts_) EVP_DigestUpdate(context.get(), part.data(), part.size());
  std::string digest(32, '\0');
  EVP_DigestFinal_ex(context.get(), reinterpret_cast<unsigned char*>(digest.data()), nullptr);
  return digest;
}

bool Payload::for_each_chunk(const std::function<bool(std::string)>& take) const {
  uint64_t left = total_bytes_;
  std::string chunk;
  for (auto part : parts_) {
    while (!part.empty()) {
      if (chunk.empty()) chunk.reserve(std::min<uint64_t>(kChunkBytes, left));
      const size_t count = std::min(part.size(), kChunkBytes - chunk.size());
      chunk.append(reinterpret_cast<const char*>(part.data()), count);
      part = part.subspan(count);
      left -= count;
      if (chunk.size() < kChunkBytes && left > 0) continue;
      if (!take(std::move(chunk))) return false;
      chunk = {};
    }
  }
  return true;
}

}  // namespace diaphane::internal
