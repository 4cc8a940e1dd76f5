// Tells ThreadSanitizer what abseil's mutexes do. Debian's abseil is built without it, and its mutexes are atomics and
// futexes, which ThreadSanitizer does not see from outside: everything that they guard would look like a race. These
// functions stand before the library's own, for gRPC too, and call those. Only in builds with -fsanitize=thread.
#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>

#include "absl/synchronization/mutex.h"

namespace absl {
ABSL_NAMESPACE_BEGIN
namespace {

// Of these functions on this thread: the library's call each other, and only the outermost is told of.
thread_local int depth = 0;

class Locking {
 public:
  Locking(const void* mutex, unsigned flags) : mutex_(const_cast<void*>(mutex)), flags_(flags), tells_(depth++ == 0) {
    if (tells_) __tsan_mutex_pre_lock(mutex_, flags_);
  }
  ~Locking() {
    if (tells_) __tsan_mutex_post_lock(mutex_, flags_, 0);
    --depth;
  }
  bool tried(bool locked) {
    if (!locked) flags_ |= __tsan_mutex_try_lock_failed;
    return locked;
  }

 private:
  void* mutex_;
  unsigned flags_;
  bool tells_;
};

class Unlocking {
 public:
  Unlocking(const void* mutex, unsigned flags) : mutex_(const_cast<void*>(mutex)), flags_(flags), tells_(depth++ == 0) {
    if (tells_) __tsan_mutex_pre_unlock(mutex_, flags_);
  }
  ~Unlocking() {
    if (tells_) __tsan_mutex_post_unlock(mutex_, flags_);
    --depth;
  }

 private:
  void* mutex_;
  unsigned flags_;
  bool tells_;
};

// A wait gives the mutex back and takes it again.
class Waiting {
 public:
  explicit Waiting(const void* mutex) : mutex_(const_cast<void*>(mutex)), tells_(depth++ == 0) {
    if (!tells_) return;
    __tsan_mutex_pre_unlock(mutex_, 0);
    __tsan_mutex_post_unlock(mutex_, 0);
    __tsan_mutex_pre_lock(mutex_, 0);
  }
  ~Waiting() {
    if (tells_) __tsan_mutex_post_lock(mutex_, 0, 0);
    --depth;
  }

 private:
  void* mutex_;
  bool tells_;
};

constexpr unsigned kRead = __tsan_mutex_read_lock;
constexpr unsigned kTry = __tsan_mutex_try_lock;

template <typename Function>
Function* library(const char* symbol) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, symbol));
}

}  // namespace

// The library's function of the same mangled name.
#define LIBRARY(name, ...) static auto* const real = library<__VA_ARGS__>("_ZN4absl7debian3" name)

void Mutex::Lock() {
  LIBRARY("5Mutex4LockEv", void(Mutex*));
  const Locking locking(this, 0);
  real(this);
}

void Mutex::Unlock() {
  LIBRARY("5Mutex6UnlockEv", void(Mutex*));
  const Unlocking unlocking(this, 0);
  real(this);
}

bool Mutex::TryLock() {
  LIBRARY("5Mutex7TryLockEv", bool(Mutex*));
  Locking locking(this, kTry);
  return locking.tried(real(this));
}

void Mutex::ReaderLock() {
  LIBRARY("5Mutex10ReaderLockEv", void(Mutex*));
  const Locking locking(this, kRead);
  real(this);
}

void Mutex::ReaderUnlock() {
  LIBRARY("5Mutex12ReaderUnlockEv", void(Mutex*));
  const Unlocking unlocking(this, kRead);
  real(this);
}

void Mutex::LockWhen(const Condition& condition) {
  LIBRARY("5Mutex8LockWhenERKNS0_9ConditionE", void(Mutex*, const Condition&));
  const Locking locking(this, 0);
  real(this, condition);
}

bool Mutex::LockWhenWithDeadline(const Condition& condition, Time deadline) {
  LIBRARY("5Mutex20LockWhenWithDeadlineERKNS0_9ConditionENS0_4TimeE", bool(Mutex*, const Condition&, Time));
  const Locking locking(this, 0);
  return real(this, condition, deadline);
}

void Mutex::Await(const Condition& condition) {
  LIBRARY("5Mutex5AwaitERKNS0_9ConditionE", void(Mutex*, const Condition&));
  const Waiting waiting(this);
  real(this, condition);
}

bool Mutex::AwaitWithDeadline(const Condition& condition, Time deadline) {
  LIBRARY("5Mutex17AwaitWithDeadlineERKNS0_9ConditionENS0_4TimeE", bool(Mutex*, const Condition&, Time));
  const Waiting waiting(this);
  return real(this, condition, deadline);
}

void CondVar::Wait(Mutex* mutex) {
  LIBRARY("7CondVar4WaitEPNS0_5MutexE", void(CondVar*, Mutex*));
  const Waiting waiting(mutex);
  real(this, mutex);
}

bool CondVar::WaitWithDeadline(Mutex* mutex, Time deadline) {
  LIBRARY("7CondVar16WaitWithDeadlineEPNS0_5MutexENS0_4TimeE", bool(CondVar*, Mutex*, Time));
  const Waiting waiting(mutex);
  return real(this, mutex, deadline);
}

bool CondVar::WaitWithTimeout(Mutex* mutex, Duration timeout) {
  LIBRARY("7CondVar15WaitWithTimeoutEPNS0_5MutexENS0_8DurationE", bool(CondVar*, Mutex*, Duration));
  const Waiting waiting(mutex);
  return real(this, mutex, timeout);
}

ABSL_NAMESPACE_END
}  // namespace absl
