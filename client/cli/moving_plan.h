// A plan whose bodies or camera move.
#pragma once

#include <memory>

#include "absl/status/statusor.h"
#include "motion.h"
#include "render_plan.h"

namespace diaphane::cli {

struct MovingPlan {
  RenderPlan plan;
  std::unique_ptr<Motion> motion;
};

/// plan_render() with camera and light for all of the motion. Errors: as plan_render's; kExitUsage no motion, or one
/// that does not go with what is rendered.
absl::StatusOr<MovingPlan> plan_motion(const RenderArguments& render, const MotionArguments& motion);

}  // namespace diaphane::cli
