#include "render_command.h"

#include <string>

#include "diaphane/client.h"
#include "fmt/format.h"
#include "json.h"
#include "output_file.h"
#include "progress.h"
#include "render_plan.h"
#include "scene_upload.h"
#include "status.h"

namespace diaphane::cli {
namespace {

absl::StatusOr<RenderedFrame> render_scene(const Scene& scene, const RenderPlan& plan, Progress& progress) {
  const std::string what = fmt::format("rendering {}x{}", plan.options.size.width_px, plan.options.size.height_px);
  progress.step(what);
  if (plan.options.settings.technique != Technique::kReference) return scene.render(plan.options);
  return scene.render(plan.options, [&](double share) { progress.bar(what, share); });
}

absl::StatusOr<RenderedFrame> make_frame(const GlobalOptions& global, RenderPlan* plan, Progress& progress) {
  absl::StatusOr<UploadedScene> uploaded = upload_plan(global, plan, progress);
  if (!uploaded.ok()) return uploaded.status();
  absl::StatusOr<RenderedFrame> frame = render_scene(uploaded->scene.scene(), *plan, progress);
  const absl::Status removed = uploaded->scene.remove();
  if (frame.ok() && !removed.ok()) return removed;
  return frame;
}

void report(const GlobalOptions& global, const RenderArguments& arguments, const RenderPlan& plan,
            const RenderedFrame& frame) {
  if (global.verbose) {
    for (const StageTime& stage : frame.stages) {
      print_note(fmt::format("{:<10} {:9.2f} ms{}", stage.stage, stage.milliseconds, stage.ran ? "" : "  (slept)"));
    }
  }
  if (!global.json) {
    fmt::print("{}\n", arguments.output);
    return;
  }
  Json json{{"output", arguments.output},
            {"content_type", frame.content_type},
            {"bytes", frame.image.size()},
            {"width_px", frame.size.width_px},
            {"height_px", frame.size.height_px},
            {"millimetres_per_unit", plan.millimetres_per_unit},
            {"camera", to_json(plan.options.camera)},
            {"path", frame.path},
            {"stages", Json::array()}};
  for (const StageTime& stage : frame.stages) json["stages"].push_back(to_json(stage));
  print_json(json);
}

}  // namespace

absl::Status run_render(const GlobalOptions& global, const RenderArguments& arguments) {
  if (arguments.meshes.empty() && arguments.scene_file.empty()) {
    return usage_error("MESH", "give at least one mesh file, or --scene");
  }
  if (arguments.channels && arguments.format != ImageFormat::kExr) {
    return usage_error("--aov", fmt::format("only an .exr has extra channels, got '{}'", arguments.output));
  }
  if (absl::Status status = check_writable(arguments.output); !status.ok()) return status;
  Progress progress;
  progress.step("reading");
  absl::StatusOr<RenderPlan> plan = plan_render(arguments);
  progress.clear();
  if (!plan.ok()) return plan.status();
  for (const std::string& note : plan->notes) print_note(note);

  const absl::StatusOr<RenderedFrame> frame = make_frame(global, &*plan, progress);
  progress.clear();
  if (!frame.ok()) return frame.status();
  if (absl::Status status = write_file(arguments.output, frame->image); !status.ok()) return status;
  report(global, arguments, *plan, *frame);
  return absl::OkStatus();
}

}  // namespace diaphane::cli
