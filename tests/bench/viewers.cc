// Who watches a deforming scene, and what that costs: many viewers, a slow one, and two scenes.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "CLI/CLI.hpp"
#include "diaphane/client.h"
#include "diaphane/framing.h"
#include "diaphane/private_server.h"
#include "diaphane/readers.h"
#include "nlohmann/json.hpp"

namespace diaphane {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;

struct Settings {
  std::string folder = "../shared/data/meshes";
  std::string mesh = "bunny_closed_72k.ply", light = "hand_7k7.ply", heavy = "buddha_381k.ply";
  std::vector<int> viewers = {1, 2, 4, 8, 16};
  int rounds = 12;
  double slow_seconds = 20;
  double share_seconds = 8;
  std::string json_path;
};

double ms_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// A body in a scene of its own.
struct Stage {
  MeshData mesh;
  Bounds bounds;
  std::optional<Scene> scene;
  MeshHandle body;
  std::vector<std::vector<Vec3>> poses;

  static absl::StatusOr<Stage> make(const Client& client, const std::string& path) {
    absl::StatusOr<LoadedFile> file = read_mesh_file(path);
    if (!file.ok()) return file.status();
    Stage stage;
    stage.bounds = *bounds_of(file->meshes);
    stage.mesh = std::move(file->meshes.front());
    const auto& [low, high] = stage.bounds;
    absl::StatusOr<Scene> scene = client.create_scene({.millimetres_per_unit = 50 / (high.y - low.y)});
    if (!scene.ok()) return scene.status();
    stage.scene = *std::move(scene);
    const auto material = stage.scene->add_material({"marble"});
    const auto body = stage.scene->add_mesh(stage.mesh, {.material = material.value_or(MaterialHandle{})});
    if (!body.ok()) return body.status();
    stage.body = *body;
    const Vec3 eye = frame_camera(stage.bounds).eye;
    const auto light = stage.scene->add_light(PointLight{{eye.x + 1, eye.y + 1, eye.z}, {20000, 20000, 20000}});
    if (!light.ok()) return light.status();
    for (int i = 0; i < 8; ++i) {
      const float lean = 0.1f * std::sin(0.8f * static_cast<float>(i));
      std::vector<Vec3> positions = stage.mesh.positions;
      for (Vec3& p : positions) p.x += lean * (p.y - low.y);
      stage.poses.push_back(std::move(positions));
    }
    return stage;
  }

  StreamOptions view(float angle, uint32_t frames_in_flight) const {
    StreamOptions options;
    options.view.size = {512, 512};
    options.view.camera = frame_camera(bounds, {.aspect = 1});
    const Vec3 c = options.view.camera.target, e = options.view.camera.eye;
    const float x = e.x - c.x, z = e.z - c.z;
    options.view.camera.eye = {c.x + std::cos(angle) * x + std::sin(angle) * z, e.y,
                               c.z - std::sin(angle) * x + std::cos(angle) * z};
    options.view.lossless_at_rest = false;
    options.frames_in_flight = frames_in_flight;
    return options;
  }
};

/// What the frames of one revision cost the server, whoever they are for.
struct Round {
  int frames = 0;
  double update_ms = 0;  ///< stages that they share
  int updates = 0;       ///< how often those ran
  std::vector<double> each_ms;
  Clock::time_point last;
};

/// Viewers with a camera each, on threads of their own.
class Audience {
 public:
  Audience(const Stage& stage, int count) {
    for (int i = 0; i < count; ++i) {
      streams_.push_back(
          stage.scene->stream(stage.view(6.2832f * static_cast<float>(i) / static_cast<float>(count), 2)));
    }
    for (FrameStream& stream : streams_) {
      threads_.emplace_back([this, &stream] {
        while (true) {
          const absl::StatusOr<StreamedFrame> frame = stream.next();
          if (!frame.ok()) return;
          take(*frame);
        }
      });
    }
  }
  ~Audience() {
    for (FrameStream& stream : streams_) stream.close();
    for (std::thread& thread : threads_) thread.join();
  }
  Audience(const Audience&) = delete;
  Audience& operator=(const Audience&) = delete;

  /// Waits until each has `revision`.
  Round wait_for(uint64_t revision) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return rounds_[revision].frames == static_cast<int>(streams_.size()); });
    return rounds_[revision];
  }

 private:
  void take(const StreamedFrame& frame) {
    const std::lock_guard lock(mutex_);
    Round& round = rounds_[frame.frame.scene_revision];
    double each = 0;
    for (const StageTime& time : frame.frame.stages) {
      const bool own = time.stage == "draw" || time.stage == "raster" || time.stage == "shade" ||
                       time.stage == "read_back" || time.stage == "encode";
      if (own) each += time.milliseconds;
      if (!own && time.stage != "queue") round.update_ms += time.milliseconds;
      if (time.stage == "gather" && time.ran) ++round.updates;
    }
    round.each_ms.push_back(each);
    round.last = Clock::now();
    ++round.frames;
    changed_.notify_all();
  }

  std::vector<FrameStream> streams_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<uint64_t, Round> rounds_;
};

/// One edit, then every viewer's frame of it, and so on.
absl::Status measure_viewers(const Client& client, const Settings& settings, Json* rows) {
  std::printf("%s, 512x512 JPEG, each viewer with a camera of its own, one edit at a time; medians of %d, ms.\n",
              settings.mesh.c_str(), settings.rounds);
  std::printf("%8s | %8s | %8s | %9s %9s | %s\n", "viewers", "all have", "bound", "update", "each", "updates an edit");
  for (const int count : settings.viewers) {
    absl::StatusOr<Stage> stage = Stage::make(client, settings.folder + "/" + settings.mesh);
    if (!stage.ok()) return stage.status();
    std::vector<double> round_ms, update_ms, each_ms;
    double updates = 0;
    {
      Audience audience(*stage, count);
      Deformer deformer = stage->scene->deform();
      const absl::StatusOr<SceneDescription> before = stage->scene->describe();
      if (!before.ok()) return before.status();
      audience.wait_for(before->scene.revision);
      for (int round = -2; round < settings.rounds; ++round) {
        const Clock::time_point begin = Clock::now();
        absl::Status sent = deformer.set_positions(stage->body, stage->poses[static_cast<size_t>(round + 2) % 8]);
        if (!sent.ok()) return sent;
        const Round had = audience.wait_for(before->scene.revision + static_cast<uint64_t>(round + 3));
        if (const auto flushed = deformer.flush(); !flushed.ok()) return flushed.status();
        if (round < 0) continue;
        round_ms.push_back(ms_between(begin, had.last));
        update_ms.push_back(had.update_ms);
        each_ms.insert(each_ms.end(), had.each_ms.begin(), had.each_ms.end());
        updates += had.updates;
      }
    }
    const double bound = count * median(each_ms) + median(update_ms);
    std::printf("%8d | %8.2f | %8.2f | %9.2f %9.2f | %.2f\n", count, median(round_ms), bound, median(update_ms),
                median(each_ms), updates / settings.rounds);
    std::fflush(stdout);
    rows->push_back({{"viewers", count},
                     {"all_have_ms", median(round_ms)},
                     {"bound_ms", bound},
                     {"update_ms", median(update_ms)},
                     {"each_ms", median(each_ms)},
                     {"updates_per_edit", updates / settings.rounds}});
    if (absl::Status removed = stage->scene->remove(); !removed.ok()) return removed;
  }
  return absl::OkStatus();
}

/// Resident memory of this process's diaphane-server, MiB.
double server_mib() {
  const std::string parent = std::to_string(getpid());
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "status");
    std::map<std::string, std::string> fields;
    for (std::string key, rest; file >> key && std::getline(file >> std::ws, rest);) fields[key] = rest;
    if (fields["PPid:"] == parent && fields["Name:"].starts_with("diaphane-server")) {
      return std::stod(fields["VmRSS:"]) / 1024;
    }
  }
  return 0;
}

/// Deforms a scene thirty times a second, and knows when each revision came to be.
class Program {
 public:
  Program(Stage& stage, double edits_per_second)
      : thread_([this, &stage, edits_per_second] { run(stage, edits_per_second); }) {}
  ~Program() { stop(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void stop() {
    done_ = true;
    if (thread_.joinable()) thread_.join();
  }
  /// When `revision` was no longer the newest; now, where it still is.
  Clock::time_point superseded(uint64_t revision) {
    const std::lock_guard lock(mutex_);
    const auto next = applied_.upper_bound(revision);
    return next == applied_.end() ? Clock::now() : next->second;
  }
  size_t edits() {
    const std::lock_guard lock(mutex_);
    return applied_.size();
  }

 private:
  void run(Stage& stage, double edits_per_second) {
    Deformer deformer = stage.scene->deform();
    const Clock::time_point begin = Clock::now();
    for (size_t i = 0; !done_; ++i) {
      if (edits_per_second > 0) {
        std::this_thread::sleep_until(
            begin + std::chrono::microseconds(static_cast<int64_t>(1e6 * static_cast<double>(i) / edits_per_second)));
      }
      if (!deformer.set_positions(stage.body, stage.poses[i % stage.poses.size()]).ok()) return;
      const absl::StatusOr<uint64_t> revision = deformer.flush();
      if (!revision.ok()) return;
      const std::lock_guard lock(mutex_);
      applied_[*revision] = Clock::now();
    }
  }

  std::mutex mutex_;
  std::map<uint64_t, Clock::time_point> applied_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

/// A viewer that takes a frame a second from a scene that changes thirty times as often.
absl::Status measure_slow_viewer(const Client& client, const Settings& settings, Json* out) {
  absl::StatusOr<Stage> stage = Stage::make(client, settings.folder + "/" + settings.mesh);
  if (!stage.ok()) return stage.status();
  FrameStream stream = stage->scene->stream(stage->view(0, 0));
  Program program(*stage, 30);
  std::vector<double> age_ms, render_ms;
  double first_mib = 0;
  const Clock::time_point begin = Clock::now();
  while (ms_between(begin, Clock::now()) < 1000 * settings.slow_seconds) {
    const absl::StatusOr<StreamedFrame> frame = stream.next();
    if (!frame.ok()) return frame.status();
    const Clock::time_point now = Clock::now();
    double render = 0;
    for (const StageTime& time : frame->frame.stages) render += time.stage == "queue" ? 0 : time.milliseconds;
    if (ms_between(begin, now) > 3000) {  // warm
      age_ms.push_back(std::max(0.0, ms_between(program.superseded(frame->frame.scene_revision), now)));
      render_ms.push_back(render);
      if (first_mib == 0) first_mib = server_mib();
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  program.stop();
  const double last_mib = server_mib(), worst = *std::max_element(age_ms.begin(), age_ms.end());
  std::printf(
      "\nOne frame a second of %s at 30 edits a second, %.0f s: a frame is behind the newest by at most %.1f ms\n"
      "(median %.1f), %.2f of the %.1f ms that it takes to render; server's memory %.0f MiB at first, %.0f at last.\n",
      settings.mesh.c_str(), settings.slow_seconds, worst, median(age_ms), worst / median(render_ms), median(render_ms),
      first_mib, last_mib);
  *out = {{"seconds", settings.slow_seconds},   {"frames", age_ms.size()},        {"worst_age_ms", worst},
          {"median_age_ms", median(age_ms)},    {"render_ms", median(render_ms)}, {"edits", program.edits()},
          {"server_mib", {first_mib, last_mib}}};
  return stage->scene->remove();
}

/// Frames a second of a scene that changes before each.
absl::StatusOr<double> rate_of(Stage& stage, double seconds) {
  FrameStream stream = stage.scene->stream(stage.view(0, 2));
  Program program(stage, 0);
  for (int i = 0; i < 4; ++i) {
    if (const auto frame = stream.next(); !frame.ok()) return frame.status();
  }
  const Clock::time_point begin = Clock::now();
  int frames = 0;
  for (; ms_between(begin, Clock::now()) < 1000 * seconds; ++frames) {
    if (const auto frame = stream.next(); !frame.ok()) return frame.status();
  }
  return frames / (ms_between(begin, Clock::now()) / 1000);
}

absl::Status measure_shares(const Client& client, const Settings& settings, Json* out) {
  absl::StatusOr<Stage> light = Stage::make(client, settings.folder + "/" + settings.light);
  if (!light.ok()) return light.status();
  absl::StatusOr<Stage> heavy = Stage::make(client, settings.folder + "/" + settings.heavy);
  if (!heavy.ok()) return heavy.status();
  const absl::StatusOr<double> alone = rate_of(*light, settings.share_seconds);
  if (!alone.ok()) return alone.status();
  auto beside = std::async(std::launch::async, [&] { return rate_of(*heavy, settings.share_seconds + 2); });
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const absl::StatusOr<double> together = rate_of(*light, settings.share_seconds);
  const absl::StatusOr<double> of_heavy = beside.get();
  if (!together.ok()) return together.status();
  if (!of_heavy.ok()) return of_heavy.status();
  std::printf("\n%s alone %.1f frames/s; beside %s (%.1f frames/s) %.1f: %.0f %% of that.\n", settings.light.c_str(),
              *alone, settings.heavy.c_str(), *of_heavy, *together, 100 * *together / *alone);
  *out = {{"light_alone_fps", *alone}, {"light_fps", *together}, {"heavy_fps", *of_heavy}};
  return absl::OkStatus();
}

absl::Status run(const Settings& settings) {
  const absl::StatusOr<PrivateServer> server = PrivateServer::start();
  if (!server.ok()) return server.status();
  const absl::StatusOr<Client> client = Client::connect(server->address());
  if (!client.ok()) return client.status();
  Json json{{"rows", Json::array()}};
  absl::Status status = measure_viewers(*client, settings, &json["rows"]);
  if (status.ok() && settings.slow_seconds > 0) status = measure_slow_viewer(*client, settings, &json["slow_viewer"]);
  if (status.ok() && settings.share_seconds > 0) status = measure_shares(*client, settings, &json["two_scenes"]);
  if (status.ok() && !settings.json_path.empty()) std::ofstream(settings.json_path) << json.dump(1) << "\n";
  return status;
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("Viewers of deforming scenes over loopback");
  app.add_option("--folder", settings.folder, "with mesh files");
  app.add_option("--mesh", settings.mesh, "that is watched");
  app.add_option("--light", settings.light, "mesh of the light scene of two");
  app.add_option("--heavy", settings.heavy, "and of the heavy one");
  app.add_option("--viewers", settings.viewers, "how many")->delimiter(',');
  app.add_option("--rounds", settings.rounds)->check(CLI::Range(1, 10000));
  app.add_option("--slow-seconds", settings.slow_seconds, "of the slow viewer; 0: none")
      ->check(CLI::Range(0.0, 86400.0));
  app.add_option("--share-seconds", settings.share_seconds, "of the two scenes; 0: none")
      ->check(CLI::Range(0.0, 3600.0));
  app.add_option("--json", settings.json_path, "file for the tables");
  CLI11_PARSE(app, argc, argv);
  const absl::Status status = diaphane::run(settings);
  if (!status.ok()) std::fprintf(stderr, "bench_viewers: %s\n", std::string(status.message()).c_str());
  return status.ok() ? 0 : 1;
}
