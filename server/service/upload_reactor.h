// A stream of one header and then chunks.
#pragma once

#include <atomic>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "base/status.h"
#include "base/worker_pool.h"
#include "diaphane/v1/scene_service.pb.h"
#include "fmt/format.h"
#include "grpcpp/alarm.h"
#include "grpcpp/server_context.h"
#include "grpcpp/support/server_callback.h"
#include "service/convert/status.h"
#include "service/limits.h"
#include "service/payload.h"
#include "service/reply_memory.h"

namespace diaphane::service {

/// What uploads share; all of it outlives them.
struct UploadServices {
  const ServiceLimits& limits;
  base::WorkerPool& workers;
  ReplyMemory& replies;
};

/// One call of `Upload` (MeshUpload, PositionsUpload, EnvironmentUpload). Reads on gRPC's threads, hands the whole
/// payload to a worker, and finishes exactly once: from a read, a cancellation, the silence alarm or the worker,
/// whichever comes first; but only the worker finishes while it works. Deletes itself.
template <typename Upload>
class UploadReactor final : public grpc::ServerReadReactor<typename Upload::Request> {
 public:
  UploadReactor(std::unique_ptr<Upload> upload, const UploadServices& services, grpc::CallbackServerContext* context,
                typename Upload::Response* response)
      : services_(services), context_(context), response_(response), upload_(std::move(upload)) {
    watch_silence();
    this->StartRead(&request_);
  }

  void OnReadDone(bool ok) override {
    {
      absl::MutexLock lock(&mutex_);
      last_read_ = absl::Now();
    }
    if (!ok) return at_end();
    if (absl::Status status = take(request_); !status.ok()) return release_and_finish(State::kReading, status);
    if (answered_before_) return release_and_finish(State::kReading, absl::OkStatus());
    this->StartRead(&request_);
  }

  void OnCancel() override { finish(State::kReading, absl::CancelledError("the upload was cancelled")); }

  void OnDone() override {
    release();
    {
      absl::MutexLock lock(&mutex_);
      silence_->Cancel();
    }
    leave();
  }

 private:
  enum class State { kReading, kApplying, kFinished };

  // The part that a message carries.
  absl::Status take(const typename Upload::Request& request) {
    if (request.has_header()) return take(request.header());
    if (!payload_.has_value()) return base::invalid_field("part", "a header first", "no header");
    if (!request.has_chunk()) return base::invalid_field("part", "a chunk", "nothing");
    return payload_->append(request.chunk(), kMaxChunkBytes);
  }

  absl::Status take(const typename Upload::Header& header) {
    if (payload_.has_value()) return base::invalid_field("part", "one header, then chunks", "a second header");
    auto call = services_.replies.begin(Upload::kMethod, header.request_id(), header.SerializeAsString());
    if (!call.ok()) return call.status();
    call_.emplace(*std::move(call));
    if (call_->reply().has_value()) {
      answered_before_ = response_->ParseFromString(*call_->reply());
      return absl::OkStatus();
    }
    absl::StatusOr<PayloadSpec> spec = upload_->open(header);
    if (!spec.ok()) return spec.status();
    absl::StatusOr<Payload> payload = Payload::create(*std::move(spec));
    if (!payload.ok()) return payload.status();
    payload_.emplace(*std::move(payload));
    return absl::OkStatus();
  }

  // The client has sent all that it will send.
  void at_end() {
    if (!payload_.has_value()) {
      return release_and_finish(State::kReading, base::invalid_field("part", "a header first", "no message"));
    }
    {
      absl::MutexLock lock(&mutex_);
      if (state_ != State::kReading) return;
      state_ = State::kApplying;
    }
    if (services_.workers.try_submit([this] { release_and_finish(State::kApplying, apply()); })) return;
    release_and_finish(State::kApplying, absl::ResourceExhaustedError("too many uploads end at once; try again"));
  }

  // On a worker.
  absl::Status apply() {
    if (absl::Status complete = payload_->check_complete(); !complete.ok()) return complete;
    if (context_->IsCancelled()) return absl::CancelledError("the upload was cancelled");
    try {
      absl::Status status = upload_->apply(*payload_, *response_);
      if (status.ok()) call_->remember(response_->SerializeAsString());
      return status;
    } catch (const std::bad_alloc&) {
      return absl::ResourceExhaustedError("out of memory");
    }
  }

  // Gives back what the upload holds before the answer goes out, so that a retry finds it free. Only where nobody else
  // reads or applies: on the reading thread, on the worker, or after both.
  void release() {
    payload_.reset();
    upload_.reset();
    call_.reset();
  }

  void release_and_finish(State state, const absl::Status& status) {
    release();
    finish(state, status);
  }

  // Finishes if the call is in `state`.
  void finish(State state, const absl::Status& status) {
    {
      absl::MutexLock lock(&mutex_);
      if (state_ != state) return;
      state_ = State::kFinished;
    }
    this->Finish(to_grpc(status));
  }

  void watch_silence() ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    if (state_ != State::kReading) return;
    ++owners_;
    // A new one: to set an alarm again would end the function that it runs.
    silence_.emplace();
    silence_->Set(absl::ToChronoTime(last_read_ + services_.limits.max_upload_silence), [this](bool) { at_alarm(); });
  }

  void at_alarm() {
    const absl::Duration allowed = services_.limits.max_upload_silence;
    bool silent = false;
    {
      absl::MutexLock lock(&mutex_);
      silent = absl::Now() - last_read_ >= allowed;
    }
    if (silent) {
      finish(State::kReading,
             absl::DeadlineExceededError(fmt::format("no chunk for {} s", absl::ToDoubleSeconds(allowed))));
    }
    watch_silence();
    leave();
  }

  // The call and a pending alarm each own the reactor; the last to leave deletes it.
  void leave() {
    if (--owners_ == 0) delete this;
  }

  const UploadServices services_;
  grpc::CallbackServerContext* const context_;
  typename Upload::Response* const response_;

  // Of the reading thread, then of the worker.
  std::unique_ptr<Upload> upload_;
  typename Upload::Request request_;
  std::optional<ReplyMemory::Call> call_;
  std::optional<Payload> payload_;
  bool answered_before_ = false;

  std::atomic<int> owners_{1};
  absl::Mutex mutex_;
  State state_ ABSL_GUARDED_BY(mutex_) = State::kReading;
  absl::Time last_read_ ABSL_GUARDED_BY(mutex_) = absl::Now();
  std::optional<grpc::Alarm> silence_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace diaphane::service
