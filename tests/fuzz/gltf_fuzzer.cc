#include "readers/gltf.h"
#include "readers/gltf_animation.h"
#include "tests/fuzz/reader_fuzzer.h"

namespace {

using namespace diaphane;

/// Every animation in the middle of its time: the same meshes with other positions, or a refusal.
void check_animations(const readers::GltfFile& gltf) {
  const auto rest = readers::read_gltf_model(gltf, gltf.model, readers::GltfUse::kRest);
  fuzz::check_promises(rest, gltf.source.limits);
  if (!rest.ok()) return;
  std::vector<std::string> warnings;
  readers::GltfAccessors accessors(gltf.model, gltf.document.extensions, gltf.buffers, gltf.source);
  const auto animations =
      readers::read_gltf_animations(gltf.document.animations, gltf.model, accessors, gltf.source, warnings);
  if (!animations.ok()) {
    fuzz::require(animations.status().message().substr(0, 6) == "fuzzed", "a message that names the file");
    return;
  }
  constexpr size_t kMost = 4;  // a file may hold a thousand
  for (size_t i = 0; i < std::min(kMost, animations->size()); ++i) {
    tinygltf::Model posed = gltf.model;
    (*animations)[i].apply((*animations)[i].duration_s / 2, posed);
    const auto pose = readers::read_gltf_model(gltf, posed, readers::GltfUse::kPose);
    fuzz::check_promises(pose, gltf.source.limits);
    if (!pose.ok()) continue;
    fuzz::require(pose->meshes.size() == rest->meshes.size(), "the meshes of the rest pose");
    for (size_t m = 0; m < pose->meshes.size(); ++m) {
      fuzz::require(pose->meshes[m].positions.size() == rest->meshes[m].positions.size(), "as many positions");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto source = fuzz::fuzzed_source();
  const auto bytes = std::string(reinterpret_cast<const char*>(data), size);
  fuzz::check_promises(readers::read_gltf(bytes, source), source.limits);
  if (const auto gltf = readers::open_gltf(bytes, source); gltf.ok()) check_animations(**gltf);
  return 0;
}
