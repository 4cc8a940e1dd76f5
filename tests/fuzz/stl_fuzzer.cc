#include "readers/stl.h"
#include "tests/fuzz/reader_fuzzer.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto source = diaphane::fuzz::fuzzed_source();
  const auto bytes = std::string_view(reinterpret_cast<const char*>(data), size);
  diaphane::fuzz::check_promises(diaphane::readers::read_stl(bytes, source), source.limits);
  return 0;
}
