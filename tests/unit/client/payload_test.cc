#include "client/src/payload.h"

#include <gmock/gmock.h>

#include <cstring>

namespace diaphane::internal {
namespace {

using testing::ElementsAre;

std::vector<size_t> chunk_sizes(const Payload& payload) {
  std::vector<size_t> sizes;
  payload.for_each_chunk([&](std::string chunk) {
    sizes.push_back(chunk.size());
    return true;
  });
  return sizes;
}

std::string to_hex(std::string_view bytes) {
  std::string hex;
  for (const unsigned char byte : bytes) {
    hex.push_back("0123456789abcdef"[byte >> 4]);
    hex.push_back("0123456789abcdef"[byte & 15]);
  }
  return hex;
}

TEST(Payload, HoldsArraysOneAfterTheOther) {
  const std::vector<Vec3> positions{{1, 2, 3}, {4, 5, 6}};
  const std::vector<uint32_t> triangles{0, 1, 0};
  Payload payload;
  payload.append(positions);
  payload.append(std::vector<Vec3>());
  payload.append(triangles);
  EXPECT_EQ(payload.total_bytes(), 36);

  std::string bytes;
  payload.for_each_chunk([&](std::string chunk) {
    bytes += chunk;
    return true;
  });
  std::string expected(36, '\0');
  std::memcpy(expected.data(), positions.data(), 24);
  std::memcpy(expected.data() + 24, triangles.data(), 12);
  EXPECT_EQ(bytes, expected);
}

TEST(Payload, CutsFullChunksAcrossArrays) {
  const std::vector<uint32_t> first(kChunkBytes / 4 - 1);
  const std::vector<uint32_t> second(kChunkBytes / 4 + 3);
  Payload payload;
  payload.append(first);
  payload.append(second);
  EXPECT_THAT(chunk_sizes(payload), ElementsAre(kChunkBytes, kChunkBytes, 8));
}

TEST(Payload, SendsNoEmptyChunk) {
  const std::vector<uint32_t> exactly(kChunkBytes / 4);
  Payload payload;
  payload.append(exactly);
  EXPECT_THAT(chunk_sizes(payload), ElementsAre(kChunkBytes));
  EXPECT_THAT(chunk_sizes(Payload()), ElementsAre());
}

TEST(Payload, StopsWhenAChunkIsNotTaken) {
  const std::vector<uint32_t> values(kChunkBytes);
  Payload payload;
  payload.append(values);
  int taken = 0;
  EXPECT_FALSE(payload.for_each_chunk([&](std::string) { return ++taken < 2; }));
  EXPECT_EQ(taken, 2);
}

TEST(Payload, HashesAllBytes) {
  Payload payload;
  const std::vector<Vec3> zeros(1);
  payload.append(zeros);
  // sha256sum of twelve zero bytes
  EXPECT_EQ(to_hex(payload.sha256()), "15ec7bf0b50732b49f8228e07d24365338f9e3ab994b00af08e5a3bffe55fd8b");
}

}  // namespace
}  // namespace diaphane::internal
