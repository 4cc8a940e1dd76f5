// Tells ThreadSanitizer that what comes back from gRPC comes after what was handed to it. Debian's gRPC is built
// without it and passes work between threads by atomics that it does not see. These functions stand before the
// library's own. Only in builds with -fsanitize=thread.
#include <dlfcn.h>
#include <grpc/grpc.h>
#include <grpc/slice.h>
#include <grpcpp/support/server_callback.h>
#include <sanitizer/tsan_interface.h>

namespace {

template <typename Function>
Function* library(const char* symbol) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, symbol));
}

/// Who frees a slice's bytes, whichever thread the library does it on.
struct SliceOwner {
  void (*destroy)(void*);
  void* user_data;
};

void destroy_slice(void* of) {
  __tsan_acquire(of);
  auto* const owner = static_cast<SliceOwner*>(of);
  owner->destroy(owner->user_data);
  delete owner;
}

}  // namespace

extern "C" {

grpc_slice grpc_slice_new_with_user_data(void* bytes, size_t count, void (*destroy)(void*), void* user_data) {
  static auto* const real = library<decltype(grpc_slice_new_with_user_data)>("grpc_slice_new_with_user_data");
  auto* const owner = new SliceOwner{destroy, user_data};
  __tsan_release(owner);
  return real(bytes, count, destroy_slice, owner);
}

grpc_call_error grpc_call_start_batch(grpc_call* call, const grpc_op* ops, size_t count, void* tag, void* reserved) {
  static auto* const real = library<decltype(grpc_call_start_batch)>("grpc_call_start_batch");
  __tsan_release(tag);
  return real(call, ops, count, tag, reserved);
}

grpc_event grpc_completion_queue_next(grpc_completion_queue* queue, gpr_timespec deadline, void* reserved) {
  static auto* const real = library<decltype(grpc_completion_queue_next)>("grpc_completion_queue_next");
  const grpc_event event = real(queue, deadline, reserved);
  if (event.type == GRPC_OP_COMPLETE) __tsan_acquire(event.tag);
  return event;
}

grpc_event grpc_completion_queue_pluck(grpc_completion_queue* queue, void* tag, gpr_timespec deadline, void* reserved) {
  static auto* const real = library<decltype(grpc_completion_queue_pluck)>("grpc_completion_queue_pluck");
  const grpc_event event = real(queue, tag, deadline, reserved);
  if (event.type == GRPC_OP_COMPLETE) __tsan_acquire(tag);
  return event;
}

}  // extern "C"

namespace grpc::internal {

// The last to count a call's callbacks down may be the library, which then has seen the end of all others.
void ServerCallbackCall::ScheduleOnDone(bool inline_ondone) {
  static auto* const real =
      library<void(ServerCallbackCall*, bool)>("_ZN4grpc8internal18ServerCallbackCall14ScheduleOnDoneEb");
  __tsan_acquire(&callbacks_outstanding_);
  real(this, inline_ondone);
}

}  // namespace grpc::internal
