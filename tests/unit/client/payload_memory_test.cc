#include "client/src/payload_memory.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>

namespace diaphane::internal {
namespace {

constexpr size_t kBytes = 4096;
const std::string kNonce = "0123456789abcdef";

/// A file as a server shares it.
class Offered {
 public:
  explicit Offered(unsigned seals = F_SEAL_SHRINK, const char* name = "diaphane-edits")
      : file_(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
    EXPECT_EQ(ftruncate(file_, kBytes), 0);
    EXPECT_EQ(pwrite(file_, kNonce.data(), kNonce.size(), 0), static_cast<ssize_t>(kNonce.size()));
    EXPECT_EQ(fcntl(file_, F_ADD_SEALS, seals), 0);
    offer.set_process_id(getpid());
    offer.set_file_descriptor(file_);
    offer.set_bytes(kBytes);
    offer.set_nonce(kNonce);
  }
  ~Offered() { close(file_); }
  Offered(const Offered&) = delete;
  Offered& operator=(const Offered&) = delete;

  char byte_at(uint64_t offset) const {
    char byte = 0;
    EXPECT_EQ(pread(file_, &byte, 1, static_cast<off_t>(offset)), 1);
    return byte;
  }

  v1::SharedMemory offer;

 private:
  int file_;
};

TEST(SharedMemory, IsWhereTheServerReads) {
  const Offered offered;
  const auto memory = SharedMemory::open(offered.offer);
  ASSERT_NE(memory, nullptr);
  const PayloadPtr payload = memory->take(100);
  ASSERT_NE(payload, nullptr);
  EXPECT_EQ(payload->shared, memory.get());
  ASSERT_EQ(payload->bytes.size(), 100u);
  payload->bytes[99] = 'x';
  EXPECT_EQ(offered.byte_at(payload->offset + 99), 'x');
  EXPECT_EQ(offered.byte_at(0), kNonce[0]);
}

TEST(SharedMemory, GivesEachPayloadBytesOfItsOwnUntilItIsFull) {
  const Offered offered;
  const auto memory = SharedMemory::open(offered.offer);
  ASSERT_NE(memory, nullptr);
  std::vector<PayloadPtr> payloads;
  while (PayloadPtr payload = memory->take(500)) {
    std::memset(payload->bytes.data(), static_cast<int>(payloads.size()), 500);
    payloads.push_back(std::move(payload));
  }
  EXPECT_EQ(payloads.size(), 7u);
  for (size_t i = 0; i < payloads.size(); ++i) {
    EXPECT_EQ(payloads[i]->bytes.front(), static_cast<char>(i));
    EXPECT_EQ(payloads[i]->bytes.back(), static_cast<char>(i));
  }
  EXPECT_EQ(memory->take(kBytes), nullptr);
  const uint64_t middle = payloads[3]->offset;
  payloads[3].reset();
  EXPECT_EQ(memory->take(600), nullptr);
  const PayloadPtr again = memory->take(400);
  ASSERT_NE(again, nullptr);
  EXPECT_EQ(again->offset, middle);
}

TEST(SharedMemory, LivesAsLongAsItsPayloads) {
  PayloadPtr payload;
  {
    const Offered offered;
    payload = SharedMemory::open(offered.offer)->take(100);
  }
  payload->bytes[0] = 'y';
  EXPECT_EQ(payload->bytes[0], 'y');
}

TEST(SharedMemory, IsNotTakenForWhatIsSomethingElse) {
  Offered other;
  other.offer.set_nonce("fedcba9876543210");
  EXPECT_EQ(SharedMemory::open(other.offer), nullptr);
  Offered longer;
  longer.offer.set_bytes(2 * kBytes);
  EXPECT_EQ(SharedMemory::open(longer.offer), nullptr);
  Offered tiny;
  tiny.offer.set_bytes(0);
  EXPECT_EQ(SharedMemory::open(tiny.offer), nullptr);
  EXPECT_EQ(SharedMemory::open(Offered(0).offer), nullptr);
  EXPECT_EQ(SharedMemory::open(Offered(F_SEAL_GROW).offer), nullptr);
  EXPECT_EQ(SharedMemory::open(Offered(F_SEAL_SHRINK, "others").offer), nullptr);
  Offered nobody;
  nobody.offer.set_process_id(0);
  EXPECT_EQ(SharedMemory::open(nobody.offer), nullptr);
  Offered closed;
  closed.offer.set_file_descriptor(-1);
  EXPECT_EQ(SharedMemory::open(closed.offer), nullptr);
}

TEST(PayloadPool, GivesTheSameMemoryAgainOnceItIsGivenBack) {
  PayloadPool pool;
  PayloadPtr first = pool.take(100'000);
  const char* const bytes = first->bytes.data();
  const PayloadPtr second = pool.take(100'000);
  EXPECT_NE(second->bytes.data(), bytes);
  first.reset();
  const PayloadPtr third = pool.take(50'000);
  EXPECT_EQ(third->bytes.data(), bytes);
  EXPECT_EQ(third->bytes.size(), 50'000u);
  EXPECT_EQ(third->shared, nullptr);
}

}  // namespace
}  // namespace diaphane::internal
