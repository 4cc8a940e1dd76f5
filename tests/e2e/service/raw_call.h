// Calls of services whose messages no library here declares: bytes out, bytes in.
#pragma once

#include <future>
#include <string>
#include <string_view>
#include <vector>

#include "grpcpp/generic/generic_stub.h"
#include "grpcpp/grpcpp.h"
#include "grpcpp/support/byte_buffer.h"

namespace diaphane::e2e {

inline std::string to_string(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  std::string bytes;
  if (!buffer.Dump(&slices).ok()) return bytes;
  for (const grpc::Slice& slice : slices) bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return bytes;
}

/// One request, any number of answers.
class RawCall : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method, const std::string& request)
      : stub_(channel), first_answer_(first_.get_future()), end_(status_.get_future()) {
    const grpc::Slice slice(request);
    request_ = grpc::ByteBuffer(&slice, 1);
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
    stub_.PrepareBidiStreamingCall(&context_, method, {}, this);
    StartWriteLast(&request_, {});
    StartRead(&answer_);
    StartCall();
  }

  /// Cancels what is left of the call, and waits for its end.
  ~RawCall() override {
    context_.TryCancel();
    end_.wait();
  }

  /// Empty when the call ended without one.
  std::string first_answer() { return first_answer_.get(); }
  grpc::Status status() { return end_.get(); }

  void OnReadDone(bool ok) override {
    if (!answered_) first_.set_value(ok ? to_string(answer_) : "");
    answered_ = true;
    if (ok) StartRead(&answer_);
  }
  void OnDone(const grpc::Status& status) override { status_.set_value(status); }

 private:
  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::ByteBuffer request_;
  grpc::ByteBuffer answer_;
  bool answered_ = false;
  std::promise<std::string> first_;
  std::promise<grpc::Status> status_;
  std::future<std::string> first_answer_;
  std::shared_future<grpc::Status> end_;
};

}  // namespace diaphane::e2e
