// What changes from frame to frame of a sequence.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "absl/status/statusor.h"
#include "diaphane/animation.h"
#include "diaphane/framing.h"
#include "diaphane/mesh_data.h"
#include "diaphane/values.h"

namespace diaphane::cli {

struct MotionArguments {
  std::optional<uint32_t> turntable_frames;
  std::optional<uint32_t> morph_frames;
  std::optional<std::string> animation;  ///< a name, or a number from 0
  double frames_per_second = 24;
};

/// What a stream shows over and over: the morph to the sphere and back, or an animation.
struct LoopArguments {
  std::optional<std::string> morph;  ///< "sphere"
  std::optional<std::string> animation;
  double edits_per_second = 30;

  bool any() const { return morph || animation; }
};

/// Declares --morph, --animation and --fps on `command`; `arguments` must live as long.
void add_loop_options(CLI::App& command, LoopArguments& arguments);

/// `seconds`: of the way to the sphere and back.
MotionArguments motion_of(const LoopArguments& arguments, double seconds);

/// Where the camera and the bodies are, frame by frame. One thread at a time.
class Motion {
 public:
  virtual ~Motion() = default;

  /// At least 1.
  virtual uint32_t frame_count() const = 0;

  /// Of all bodies in all frames, scene units.
  virtual absl::StatusOr<Bounds> bounds() const = 0;

  /// Where the camera of a frame stands, given that of the first.
  virtual Camera camera(uint32_t, const Camera& first) const { return first; }

  /// The bodies of a frame, as many as the meshes; none where they do not move.
  virtual absl::StatusOr<std::vector<MeshPose>> poses(uint32_t) const { return std::vector<MeshPose>(); }
};

/// The camera goes once round the upright axis through its target.
std::unique_ptr<Motion> make_turntable(std::span<const MeshData> meshes, uint32_t frames);

/// The meshes become the sphere about the middle of their bounds that holds them (the paper's §4.5); takes their
/// transforms into their positions.
absl::StatusOr<std::unique_ptr<Motion>> make_sphere_morph(std::vector<MeshData>& meshes, uint32_t frames);

/// An animation of a file, from its start on. Errors: kExitUsage there is none of that name.
absl::StatusOr<std::unique_ptr<Motion>> make_animation(std::shared_ptr<const AnimatedFile> file,
                                                       const std::string& animation, double frames_per_second);

}  // namespace diaphane::cli
