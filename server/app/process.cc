#include "app/process.h"

#include <malloc.h>
#include <sys/resource.h>

#include <string>

#include "base/log.h"
#include "google/protobuf/stubs/logging.h"
#include "grpc/support/log.h"

namespace diaphane::app {
namespace {

void log_grpc_message(gpr_log_func_args* args) {
  switch (args->severity) {
    case GPR_LOG_SEVERITY_ERROR:
      return spdlog::warn("grpc: {}", args->message);
    case GPR_LOG_SEVERITY_INFO:
      return spdlog::info("grpc: {}", args->message);
    case GPR_LOG_SEVERITY_DEBUG:
      return spdlog::debug("grpc: {}", args->message);
  }
}

void log_protobuf_message(google::protobuf::LogLevel, const char*, int, const std::string& message) {
  spdlog::debug("protobuf: {}", message);
}

}  // namespace

void raise_file_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  if (setrlimit(RLIMIT_NOFILE, &limit) != 0) spdlog::warn("open files stay limited limit={}", limit.rlim_cur);
}

void keep_freed_memory() {
  constexpr int kLargestKept = 64 << 20, kMostKept = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargestKept);
  mallopt(M_TRIM_THRESHOLD, kMostKept);
}

void log_library_messages() {
  gpr_set_log_function(log_grpc_message);
  google::protobuf::SetLogHandler(log_protobuf_message);
}

}  // namespace diaphane::app
