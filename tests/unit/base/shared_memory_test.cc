#include "base/shared_memory.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace diaphane::base {
namespace {

std::string path_of(const SharedMemory& memory) { return "/proc/self/fd/" + std::to_string(memory.file_descriptor()); }

TEST(SharedMemory, IsWhatOthersWrite) {
  const absl::StatusOr<SharedMemory> memory = SharedMemory::create(10'000);
  ASSERT_TRUE(memory.ok()) << memory.status();
  ASSERT_EQ(memory->bytes().size(), 10'000u);
  EXPECT_EQ(std::string(memory->bytes().data(), SharedMemory::kNonceBytes), memory->nonce());
  EXPECT_TRUE(std::all_of(memory->bytes().begin() + SharedMemory::kNonceBytes, memory->bytes().end(),
                          [](char byte) { return byte == 0; }));
  const int file = open(path_of(*memory).c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(file, 0);
  EXPECT_EQ(pwrite(file, "wax", 3, 9'997), 3);
  EXPECT_EQ(std::string(memory->bytes().data() + 9'997, 3), "wax");
  EXPECT_NE(ftruncate(file, 100), 0);
  close(file);
}

TEST(SharedMemory, IsOfItsOwnerAlone) {
  const absl::StatusOr<SharedMemory> memory = SharedMemory::create(100);
  ASSERT_TRUE(memory.ok()) << memory.status();
  struct stat status {};
  ASSERT_EQ(fstat(memory->file_descriptor(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  EXPECT_EQ(status.st_uid, geteuid());
}

TEST(SharedMemory, HasANonceOfItsOwn) {
  EXPECT_NE(SharedMemory::create(100)->nonce(), SharedMemory::create(100)->nonce());
}

TEST(SharedMemory, OfMoreThanAGigabyteIsRefused) {
  for (const size_t size : {SharedMemory::kMostBytes + 1, SIZE_MAX}) {
    EXPECT_EQ(SharedMemory::create(size).status().code(), absl::StatusCode::kResourceExhausted);
  }
}

TEST(SharedMemory, GivesItsDescriptorBack) {
  std::string path;
  {
    absl::StatusOr<SharedMemory> memory = SharedMemory::create(100);
    ASSERT_TRUE(memory.ok()) << memory.status();
    const SharedMemory moved = *std::move(memory);
    path = path_of(moved);
    EXPECT_EQ(access(path.c_str(), F_OK), 0);
  }
  EXPECT_NE(access(path.c_str(), F_OK), 0);
}

}  // namespace
}  // namespace diaphane::base
