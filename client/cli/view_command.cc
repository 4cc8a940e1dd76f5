#include "view_command.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "animator.h"
#include "moving_plan.h"
#include "orbit.h"
#include "progress.h"
#include "scene_upload.h"
#include "status.h"
#include "terminal.h"
#include "view_keys.h"
#include "view_threads.h"

namespace diaphane::cli {
namespace {

constexpr double kSphereSeconds = 4;
constexpr double kTurn_deg = 6;
constexpr double kNearer = 0.9;
constexpr uint32_t kBlockSamples = 4;            // pixels of that size show their edges
constexpr std::chrono::milliseconds kLook{100};  // at the terminal's size, and for an end

void move_camera(ViewKey key, Orbit& orbit) {
  switch (key) {
    case ViewKey::kLeft:
      return orbit.turn(-kTurn_deg, 0);
    case ViewKey::kRight:
      return orbit.turn(kTurn_deg, 0);
    case ViewKey::kUp:
      return orbit.turn(0, kTurn_deg);
    case ViewKey::kDown:
      return orbit.turn(0, -kTurn_deg);
    case ViewKey::kNearer:
      return orbit.move_away(kNearer);
    case ViewKey::kFarther:
      return orbit.move_away(1 / kNearer);
    case ViewKey::kBack:
      return orbit.reset();
    case ViewKey::kPause:
    case ViewKey::kEnd:
      return;
  }
}

absl::StatusOr<MovingPlan> plan_view(const ViewArguments& arguments, const RenderArguments& render) {
  if (arguments.loop.any()) return plan_motion(render, motion_of(arguments.loop, kSphereSeconds));
  absl::StatusOr<RenderPlan> plan = plan_render(render);
  if (!plan.ok()) return plan.status();
  return MovingPlan{*std::move(plan), nullptr};
}

/// Until somebody ends it, or something does.
absl::Status look(Terminal& terminal, const std::stop_token& stop, PictureProtocol protocol, StreamView view,
                  FrameStream& stream, Mover* mover, const Outcome& outcome) {
  Orbit orbit(view.camera);
  TerminalExtent extent = terminal.extent();
  while (!stop.stop_requested() && !outcome.ended()) {
    const absl::StatusOr<std::string> typed = terminal.keys(kLook);
    if (!typed.ok()) return typed.status();
    bool ends = false;
    for_each_key(*typed, [&](ViewKey key) {
      ends |= key == ViewKey::kEnd;
      if (key == ViewKey::kPause && mover != nullptr) mover->pause_or_go_on();
      move_camera(key, orbit);
    });
    if (ends) break;
    const TerminalExtent now = terminal.extent();
    if (typed->empty() && now == extent) continue;
    extent = now;
    view.camera = orbit.camera();
    view.size = picture_size(protocol, extent);
    stream.set_view(view);
  }
  return outcome.status();
}

}  // namespace

absl::Status run_view(const GlobalOptions& global, const ViewArguments& arguments) {
  if (arguments.render.size) return usage_error("--size", "does not go with view, which fills the terminal");
  const PictureProtocol protocol = arguments.protocol.value_or(found_picture_protocol(&std::getenv));
  RenderArguments render = arguments.render;
  const absl::StatusOr<TerminalExtent> extent = find_terminal();
  if (!extent.ok()) return extent.status();
  render.size = picture_size(protocol, *extent);
  Progress progress;
  progress.step("reading");
  absl::StatusOr<MovingPlan> moving = plan_view(arguments, render);
  progress.clear();
  if (!moving.ok()) return moving.status();
  for (const std::string& note : moving->plan.notes) print_note(note);
  absl::StatusOr<UploadedScene> uploaded = upload_plan(global, &moving->plan, progress);
  progress.clear();
  if (!uploaded.ok()) return uploaded.status();

  StreamOptions options;
  if (protocol == PictureProtocol::kBlocks && !render.samples) moving->plan.options.settings.samples = kBlockSamples;
  options.frames_in_flight = 1;  // a slow terminal gets the newest
  options.view = {.camera = moving->plan.options.camera,
                  .size = *render.size,
                  .settings = moving->plan.options.settings,
                  .moving = picture_format(protocol)};
  absl::Status status;
  {
    const absl::StatusOr<std::unique_ptr<Terminal>> terminal = Terminal::open();
    if (!terminal.ok()) return terminal.status();
    options.view.size = picture_size(protocol, (*terminal)->extent());
    Outcome outcome;
    FrameStream stream = uploaded->scene.scene().stream(options);
    std::optional<Animator> animator;
    std::optional<Mover> mover;
    const Screen screen(stream, **terminal, protocol, outcome);
    if (moving->motion != nullptr) {
      animator.emplace(*moving->motion, arguments.loop.morph.has_value(), uploaded->scene.scene(),
                       std::move(uploaded->meshes), DeformerOptions());
      mover.emplace(*animator, arguments.loop.edits_per_second, outcome);
    }
    status = look(**terminal, global.stop, protocol, options.view, stream, mover ? &*mover : nullptr, outcome);
  }
  if (!status.ok()) return status;
  return uploaded->scene.remove();
}

}  // namespace diaphane::cli
