// Positions of a client on the same machine.
#pragma once

#include <atomic>
#include <optional>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "base/shared_memory.h"
#include "diaphane/v1/scene_service.pb.h"
#include "scene/scene_store.h"

namespace diaphane::service {

/// Whether gRPC's `peer` can be a process of this machine: a Unix socket or a loopback address.
bool is_on_this_machine(std::string_view peer);

/// How many buffers the streams of a server share with their clients: each takes a file descriptor. Thread-safe.
class SharedBufferCount {
 public:
  /// False where there are too many.
  bool add();
  void remove(int count) { count_ -= count; }

 private:
  std::atomic<int> count_ = 0;
};

/// The memory that one stream shares with its client. One thread at a time; what it borrows outlives it.
class SharedBuffers {
 public:
  SharedBuffers(scene::SceneStore& store, SharedBufferCount& count, bool is_on_this_machine)
      : store_(store), count_(count), is_on_this_machine_(is_on_this_machine) {}
  ~SharedBuffers() { count_.remove(static_cast<int>(buffers_.size())); }

  SharedBuffers(const SharedBuffers&) = delete;
  SharedBuffers& operator=(const SharedBuffers&) = delete;

  /// Memory of `bytes`, taken from that of all meshes; none where there is none to be had. INVALID_ARGUMENT for a size
  /// out of range.
  absl::StatusOr<std::optional<v1::SharedMemory>> share(uint64_t bytes);

  /// The bytes that `named` means. They may change at any time. INVALID_ARGUMENT, with fields from "shared" on, for
  /// what is not in memory of this stream.
  absl::StatusOr<std::string_view> find(const v1::SharedBytes& named) const;

 private:
  struct Buffer {
    scene::Reservation reservation;
    base::SharedMemory memory;
  };

  scene::SceneStore& store_;
  SharedBufferCount& count_;
  const bool is_on_this_machine_;
  std::vector<Buffer> buffers_;  ///< by id
  uint64_t bytes_ = 0;           ///< of all
};

}  // namespace diaphane::service
