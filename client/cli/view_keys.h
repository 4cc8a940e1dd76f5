// What keys mean to diaphane view.
#pragma once

#include <string_view>

#include "absl/functional/function_ref.h"

namespace diaphane::cli {

enum class ViewKey { kLeft, kRight, kUp, kDown, kNearer, kFarther, kBack, kPause, kEnd };

/// Of what a terminal sent, in its order; what means nothing is passed over.
void for_each_key(std::string_view typed, absl::FunctionRef<void(ViewKey)> take);

}  // namespace diaphane::cli
