#include "motion.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "fmt/format.h"
#include "status.h"

namespace diaphane::cli {
namespace {

constexpr double kMostFrames = 100'000;

struct Double3 {
  double x = 0, y = 0, z = 0;
};

Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Scene units in place of mesh units; triangles turned outward again where that mirrors. Drops normals.
void take_transform(MeshData& mesh) {
  const auto& m = mesh.scene_from_mesh;
  for (Vec3& p : mesh.positions) {
    p = {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
         m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
  }
  const Double3 x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
  if (dot(cross(x, y), z) < 0) {
    for (size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
  }
  mesh.normals.clear();
  mesh.scene_from_mesh = MeshData().scene_from_mesh;
}

class Turntable : public Motion {
 public:
  Turntable(absl::StatusOr<Bounds> bounds, uint32_t frames) : bounds_(std::move(bounds)), frames_(frames) {}

  uint32_t frame_count() const override { return frames_; }
  absl::StatusOr<Bounds> bounds() const override { return bounds_; }

  Camera camera(uint32_t frame, const Camera& first) const override {
    const double angle = 2 * M_PI * frame / frames_;
    const double length = std::hypot(first.up.x, first.up.y, first.up.z);
    const Double3 axis{first.up.x / length, first.up.y / length, first.up.z / length};
    const Double3 arm{double{first.eye.x} - first.target.x, double{first.eye.y} - first.target.y,
                      double{first.eye.z} - first.target.z};
    // Rodrigues' rotation.
    const Double3 across = cross(axis, arm);
    const double c = std::cos(angle), s = std::sin(angle), along = dot(axis, arm) * (1 - c);
    Camera camera = first;
    camera.eye = {static_cast<float>(first.target.x + c * arm.x + s * across.x + along * axis.x),
                  static_cast<float>(first.target.y + c * arm.y + s * across.y + along * axis.y),
                  static_cast<float>(first.target.z + c * arm.z + s * across.z + along * axis.z)};
    return camera;
  }

 private:
  const absl::StatusOr<Bounds> bounds_;
  const uint32_t frames_;
};

class SphereMorph : public Motion {
 public:
  SphereMorph(std::vector<MeshPose> rest, const Vec3& centre, float radius, uint32_t frames)
      : rest_(std::move(rest)), centre_(centre), radius_(radius), frames_(frames) {}

  uint32_t frame_count() const override { return frames_; }

  absl::StatusOr<Bounds> bounds() const override {
    return Bounds{{centre_.x - radius_, centre_.y - radius_, centre_.z - radius_},
                  {centre_.x + radius_, centre_.y + radius_, centre_.z + radius_}};
  }

  absl::StatusOr<std::vector<MeshPose>> poses(uint32_t frame) const override {
    const float t = frames_ > 1 ? static_cast<float>(frame) / static_cast<float>(frames_ - 1) : 0;
    std::vector<MeshPose> poses = rest_;
    for (MeshPose& pose : poses) {
      for (Vec3& p : pose.positions) {
        const Vec3 arm{p.x - centre_.x, p.y - centre_.y, p.z - centre_.z};
        const float length = std::hypot(arm.x, arm.y, arm.z);
        const float scale = length > 0 ? 1 + t * (radius_ / length - 1) : 1;
        p = {centre_.x + scale * arm.x, centre_.y + scale * arm.y, centre_.z + scale * arm.z};
      }
    }
    return poses;
  }

 private:
  const std::vector<MeshPose> rest_;
  const Vec3 centre_;
  const float radius_;
  const uint32_t frames_;
};

class FileAnimation : public Motion {
 public:
  FileAnimation(std::shared_ptr<const AnimatedFile> file, size_t index, double frames_per_second)
      : file_(std::move(file)), index_(index), frames_per_second_(frames_per_second) {
    const double frames = file_->animations()[index].duration_s * frames_per_second;
    frames_ = static_cast<uint32_t>(std::clamp(std::round(frames), 1.0, kMostFrames));
  }

  uint32_t frame_count() const override { return frames_; }

  absl::StatusOr<Bounds> bounds() const override {
    std::vector<MeshData> all;
    for (uint32_t frame = 0; frame < frames_; frame += std::max(1u, frames_ / kSamples)) {
      absl::StatusOr<std::vector<MeshPose>> posed = poses(frame);
      if (!posed.ok()) return posed.status();
      for (MeshPose& pose : *posed) all.emplace_back().positions = extremes(pose.positions);
    }
    return bounds_of(all);
  }

  absl::StatusOr<std::vector<MeshPose>> poses(uint32_t frame) const override {
    return file_->pose(index_, frame / frames_per_second_);
  }

 private:
  static constexpr uint32_t kSamples = 48;

  // Two corners in place of all, so that what is kept of a pose is small.
  static std::vector<Vec3> extremes(const std::vector<Vec3>& positions) {
    if (positions.empty()) return {};
    Vec3 low = positions.front(), high = low;
    for (const Vec3& p : positions) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return {low, high};
  }

  const std::shared_ptr<const AnimatedFile> file_;
  const size_t index_;
  const double frames_per_second_;
  uint32_t frames_ = 1;
};

}  // namespace

void add_loop_options(CLI::App& command, LoopArguments& arguments) {
  auto* morph = command.add_option("--morph", arguments.morph, "The meshes become their bounding sphere, and back");
  auto* animation = command.add_option("--animation", arguments.animation,
                                       "An animation of a glTF file: its name, or its number from 0");
  morph->type_name("sphere")->check(CLI::IsMember({"sphere"}))->excludes(animation);
  animation->type_name("NAME");
  command.add_option("--fps", arguments.edits_per_second, "Edits a second (default: 30)")
      ->type_name("F")
      ->check(CLI::Range(0.1, 240.0));
}

MotionArguments motion_of(const LoopArguments& arguments, double seconds) {
  MotionArguments motion;
  motion.frames_per_second = arguments.edits_per_second;
  motion.animation = arguments.animation;
  if (arguments.morph) {
    motion.morph_frames = static_cast<uint32_t>(std::max(1.0, std::round(seconds * arguments.edits_per_second)));
  }
  return motion;
}

std::unique_ptr<Motion> make_turntable(std::span<const MeshData> meshes, uint32_t frames) {
  return std::make_unique<Turntable>(bounds_of(meshes), frames);
}

absl::StatusOr<std::unique_ptr<Motion>> make_sphere_morph(std::vector<MeshData>& meshes, uint32_t frames) {
  for (MeshData& mesh : meshes) take_transform(mesh);
  const absl::StatusOr<Bounds> bounds = bounds_of(meshes);
  if (!bounds.ok()) return bounds.status();
  const auto& [low, high] = *bounds;
  const Vec3 centre{(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
  float radius = 0;
  std::vector<MeshPose> rest;
  for (const MeshData& mesh : meshes) {
    for (const Vec3& p : mesh.positions) {
      radius = std::max(radius, std::hypot(p.x - centre.x, p.y - centre.y, p.z - centre.z));
    }
    rest.push_back({mesh.positions, {}});
  }
  return std::make_unique<SphereMorph>(std::move(rest), centre, radius, frames);
}

absl::StatusOr<std::unique_ptr<Motion>> make_animation(std::shared_ptr<const AnimatedFile> file,
                                                       const std::string& animation, double frames_per_second) {
  const std::span<const AnimationInfo> all = file->animations();
  size_t index = 0;
  while (index < all.size() && all[index].name != animation) ++index;
  if (index == all.size()) {
    const auto [end, error] = std::from_chars(animation.data(), animation.data() + animation.size(), index);
    const bool is_number = error == std::errc() && end == animation.data() + animation.size();
    if (!is_number) index = all.size();
  }
  if (index < all.size()) return std::make_unique<FileAnimation>(std::move(file), index, frames_per_second);
  std::string names;
  for (const AnimationInfo& info : all) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", info.name);
  return usage_error("--animation", fmt::format("'{}' is none of the file's: {}", animation,
                                                names.empty() ? "it has no animation" : names));
}

}  // namespace diaphane::cli
