#include "render_command.h"

#include <string>

#include "diaphane/client.h"
#include "fmt/format.h"
#include "json.h"
#include "output_file.h"
#include "progress.h"
#include "render_plan.h"
#include "scene_upload.h"
#include "session.h"
#include "status.h"

namespace diaphane::cli {
namespace {

absl::StatusOr<RenderedFrame> render_scene(const Scene& scene, const RenderPlan& plan, Progress& progress) {
  if (const auto meshes = fill_scene(scene, plan, progress); !meshes.ok()) return meshes.status();
  const std::string what = fmt::format("rendering {}x{}", plan.options.size.width_px, plan.options.size.height_px);
  progress.step(what);
  if (plan.options.settings.technique != Technique::kReference) return scene.render(plan.options);
  return scene.render(plan.options, [&](double share) { progress.bar(what, share); });
}

absl::StatusOr<RenderedFrame> make_frame(const Client& client, RenderPlan* plan, Progress& progress) {
  absl::StatusOr<TemporaryScene> scene = TemporaryScene::create(client, plan);
  if (!scene.ok()) return scene.status();
  absl::StatusOr<RenderedFrame> frame = render_scene(scene->scene(), *plan, progress);
  const absl::Status removed = scene->remove();
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

  progress.step(global.server.empty() ? "starting a server" : "connecting");
  const absl::StatusOr<Session> session = open_session(global);
  if (!session.ok()) return session.status();
  const absl::StatusOr<RenderedFrame> frame = make_frame(session->client, &*plan, progress);
  progress.clear();
  if (!frame.ok()) return frame.status();
  if (absl::Status status = write_file(arguments.output, frame->image); !status.ok()) return status;
  report(global, arguments, *plan, *frame);
  return absl::OkStatus();
}

}  // namespace diaphane::cli
