#include "aliased_message.h"

#include <string>
#include <utility>
#include <vector>

#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream.h"

namespace diaphane::internal {
namespace {

using MessagePtr = std::shared_ptr<const google::protobuf::MessageLite>;

/// Slices of what is written: short pieces copied, long ones where they lie.
class SliceStream final : public google::protobuf::io::ZeroCopyOutputStream {
 public:
  explicit SliceStream(MessagePtr owner) : owner_(std::move(owner)) {}

  bool Next(void** data, int* size) override {
    close_block();
    block_.resize(kBlockBytes);
    *data = block_.data();
    *size = kBlockBytes;
    return true;
  }
  void BackUp(int count) override { block_.resize(block_.size() - static_cast<size_t>(count)); }
  int64_t ByteCount() const override { return closed_bytes_ + static_cast<int64_t>(block_.size()); }

  bool AllowsAliasing() const override { return true; }
  bool WriteAliasedRaw(const void* data, int size) override {
    close_block();
    add(aliased_slice(data, static_cast<size_t>(size), owner_));
    return true;
  }

  grpc::ByteBuffer take() {
    close_block();
    return {slices_.data(), slices_.size()};
  }

 private:
  static constexpr int kBlockBytes = 256;

  void close_block() {
    if (!block_.empty()) add(grpc::Slice(block_));
    block_.clear();
  }
  void add(grpc::Slice slice) {
    closed_bytes_ += static_cast<int64_t>(slice.size());
    slices_.push_back(std::move(slice));
  }

  const MessagePtr owner_;
  std::string block_;
  std::vector<grpc::Slice> slices_;
  int64_t closed_bytes_ = 0;
};

}  // namespace

grpc::Slice aliased_slice(const void* bytes, size_t count, std::shared_ptr<const void> owner) {
  using Owner = std::shared_ptr<const void>;
  return {const_cast<void*>(bytes), count, [](void* kept) { delete static_cast<Owner*>(kept); },
          new Owner(std::move(owner))};
}

grpc::ByteBuffer aliased_bytes(const MessagePtr& message) {
  SliceStream stream(message);
  {
    google::protobuf::io::CodedOutputStream out(&stream);
    out.EnableAliasing(true);
    message->SerializeToCodedStream(&out);
  }
  return stream.take();
}

}  // namespace diaphane::internal
