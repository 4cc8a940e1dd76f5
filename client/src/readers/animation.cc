#include "diaphane/animation.h"

#include <new>
#include <utility>

#include "fmt/format.h"
#include "readers/file.h"
#include "readers/format.h"
#include "readers/gltf.h"
#include "readers/gltf_animation.h"

namespace diaphane {

class AnimatedFile::Impl {
 public:
  static absl::StatusOr<std::unique_ptr<const Impl>> make(std::string bytes, const readers::Source& source) {
    auto impl = std::make_unique<Impl>();
    absl::StatusOr<std::unique_ptr<readers::GltfFile>> file = readers::open_gltf(std::move(bytes), source);
    if (!file.ok()) return file.status();
    impl->file_ = *std::move(file);
    const readers::GltfFile& gltf = *impl->file_;
    absl::StatusOr<LoadedFile> rest = readers::read_gltf_model(gltf, gltf.model, readers::GltfUse::kRest);
    if (!rest.ok()) return rest.status();
    impl->rest_ = *std::move(rest);
    readers::GltfAccessors accessors(gltf.model, gltf.document.extensions, gltf.buffers, gltf.source);
    absl::StatusOr<std::vector<readers::GltfAnimation>> animations = readers::read_gltf_animations(
        gltf.document.animations, gltf.model, accessors, gltf.source, impl->rest_.warnings);
    if (!animations.ok()) return animations.status();
    impl->animations_ = *std::move(animations);
    for (const readers::GltfAnimation& animation : impl->animations_) {
      impl->infos_.push_back({animation.name, animation.duration_s});
    }
    return impl;
  }

  const LoadedFile& rest() const { return rest_; }
  std::span<const AnimationInfo> infos() const { return infos_; }

  absl::StatusOr<std::vector<MeshPose>> pose(size_t animation, double seconds) const {
    if (animation >= animations_.size()) {
      return absl::OutOfRangeError(
          fmt::format("{}: animation {}, there are {}", file_->source.name, animation, animations_.size()));
    }
    tinygltf::Model posed = file_->model;
    animations_[animation].apply(seconds, posed);
    absl::StatusOr<LoadedFile> file = readers::read_gltf_model(*file_, posed, readers::GltfUse::kPose);
    if (!file.ok()) return file.status();
    std::vector<MeshPose> poses;
    for (MeshData& mesh : file->meshes) poses.push_back({std::move(mesh.positions), std::move(mesh.normals)});
    return poses;
  }

 private:
  std::unique_ptr<readers::GltfFile> file_;
  LoadedFile rest_;
  std::vector<readers::GltfAnimation> animations_;
  std::vector<AnimationInfo> infos_;
};

AnimatedFile::AnimatedFile(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
AnimatedFile::AnimatedFile(AnimatedFile&&) noexcept = default;
AnimatedFile& AnimatedFile::operator=(AnimatedFile&&) noexcept = default;
AnimatedFile::~AnimatedFile() = default;
const LoadedFile& AnimatedFile::rest() const { return impl_->rest(); }
std::span<const AnimationInfo> AnimatedFile::animations() const { return impl_->infos(); }

absl::StatusOr<std::vector<MeshPose>> AnimatedFile::pose(size_t animation, double seconds) const {
  return impl_->pose(animation, seconds);
}

absl::StatusOr<AnimatedFile> AnimatedFile::read(const std::filesystem::path& path, const ReadLimits& limits) {
  readers::Source source{path.string(), path.parent_path(), limits};
  if (source.folder.empty()) source.folder = ".";
  try {
    absl::StatusOr<std::string> bytes = readers::read_whole_file(path, limits.max_file_bytes, source);
    if (!bytes.ok()) return bytes.status();
    if (readers::tell_format(*bytes, path.extension().string()) != readers::MeshFormat::kGltf) {
      return source.malformed("has no animations", "", "must be glTF or GLB");
    }
    absl::StatusOr<std::unique_ptr<const Impl>> impl = Impl::make(*std::move(bytes), source);
    if (!impl.ok()) return impl.status();
    return AnimatedFile(*std::move(impl));
  } catch (const std::bad_alloc&) {
    return source.error(absl::StatusCode::kResourceExhausted, "memory ran out");
  }
}

}  // namespace diaphane
