#include "moving_plan.h"

#include <utility>

#include "status.h"

namespace diaphane::cli {
namespace {

absl::StatusOr<std::unique_ptr<Motion>> make_motion(const MotionArguments& arguments,
                                                    std::shared_ptr<const AnimatedFile> animated, RenderPlan& plan) {
  if (arguments.turntable_frames) return make_turntable(plan.meshes, *arguments.turntable_frames);
  if (arguments.morph_frames) return make_sphere_morph(plan.meshes, *arguments.morph_frames);
  return make_animation(std::move(animated), *arguments.animation, arguments.frames_per_second);
}

}  // namespace

absl::StatusOr<MovingPlan> plan_motion(const RenderArguments& render, const MotionArguments& arguments) {
  if (render.meshes.empty() && render.scene_file.empty()) {
    return usage_error("MESH", "give at least one mesh file, or --scene");
  }
  PlanSource source;
  std::shared_ptr<const AnimatedFile> animated;
  if (arguments.animation) {
    if (render.meshes.size() != 1) return usage_error("--animation", "goes with one mesh file");
    absl::StatusOr<AnimatedFile> file = AnimatedFile::read(render.meshes.front());
    if (!file.ok()) return with_exit_code(file.status(), kExitFile);
    animated = std::make_shared<const AnimatedFile>(*std::move(file));
    source.file = animated->rest();
  } else if (!arguments.turntable_frames && !arguments.morph_frames) {
    return usage_error("MOTION", "give one of --turntable N, --morph sphere N, --animation NAME");
  }
  MovingPlan moving;
  source.bounds = [&](RenderPlan& plan) -> absl::StatusOr<Bounds> {
    absl::StatusOr<std::unique_ptr<Motion>> motion = make_motion(arguments, animated, plan);
    if (!motion.ok()) return motion.status();
    moving.motion = *std::move(motion);
    absl::StatusOr<Bounds> bounds = moving.motion->bounds();
    if (!bounds.ok()) return with_exit_code(bounds.status(), kExitFile);
    return bounds;
  };
  absl::StatusOr<RenderPlan> plan = plan_render(render, std::move(source));
  if (!plan.ok()) return plan.status();
  moving.plan = *std::move(plan);
  return moving;
}

}  // namespace diaphane::cli
