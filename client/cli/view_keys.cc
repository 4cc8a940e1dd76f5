#include "view_keys.h"

#include <algorithm>
#include <iterator>

namespace diaphane::cli {
namespace {

struct Meaning {
  std::string_view text;
  ViewKey key;
};

// Arrows as terminals send them in either of their modes; the longer before what they begin with.
constexpr Meaning kMeanings[] = {
    {"\x1b[A", ViewKey::kUp},    {"\x1b[B", ViewKey::kDown}, {"\x1b[C", ViewKey::kRight},
    {"\x1b[D", ViewKey::kLeft},  {"\x1bOA", ViewKey::kUp},   {"\x1bOB", ViewKey::kDown},
    {"\x1bOC", ViewKey::kRight}, {"\x1bOD", ViewKey::kLeft}, {"k", ViewKey::kUp},
    {"j", ViewKey::kDown},       {"l", ViewKey::kRight},     {"h", ViewKey::kLeft},
    {"+", ViewKey::kNearer},     {"=", ViewKey::kNearer},    {"-", ViewKey::kFarther},
    {"_", ViewKey::kFarther},    {"0", ViewKey::kBack},      {" ", ViewKey::kPause},
    {"q", ViewKey::kEnd},        {"Q", ViewKey::kEnd},       {"\x04" /* Ctrl-D */, ViewKey::kEnd}};

/// Of a control sequence that means nothing here.
size_t length_of_sequence(std::string_view typed) {
  if (typed.size() < 2 || typed[1] != '[') return 1;
  const auto is_final = [](char c) { return c >= '@' && c <= '~'; };
  const auto end = std::find_if(typed.begin() + 2, typed.end(), is_final);
  return static_cast<size_t>(end - typed.begin()) + (end != typed.end() ? 1 : 0);
}

}  // namespace

void for_each_key(std::string_view typed, absl::FunctionRef<void(ViewKey)> take) {
  while (!typed.empty()) {
    const auto* found = std::find_if(std::begin(kMeanings), std::end(kMeanings),
                                     [&](const Meaning& known) { return typed.starts_with(known.text); });
    if (found != std::end(kMeanings)) {
      take(found->key);
      typed.remove_prefix(found->text.size());
      continue;
    }
    typed.remove_prefix(typed.front() == '\x1b' ? length_of_sequence(typed) : 1);
  }
}

}  // namespace diaphane::cli
