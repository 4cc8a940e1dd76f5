#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "openssl/evp.h"

namespace diaphane::service {

/// SHA-256 of bytes that come in pieces. One thread at a time.
class Sha256 {
 public:
  static constexpr size_t kBytes = 32;

  Sha256();
  void update(std::string_view bytes);
  /// The hash of everything so far, kBytes long. Once, and last.
  std::string finish();

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

std::string sha256(std::string_view bytes);

/// Lower-case hexadecimal.
std::string hex(std::string_view bytes);

}  // namespace diaphane::service
