// What new positions of a deforming mesh take on the way, by form: bytes at 30 a second, and the time to make and read
// them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "diaphane/framing.h"
#include "diaphane/readers.h"
#include "meshoptimizer.h"
#include "nlohmann/json.hpp"

namespace diaphane {
namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<unsigned char>;

constexpr double kRate = 30;
constexpr float kReach = 0.1f;  // of a wave, in heights of the body

struct Settings {
  std::vector<std::string> meshes = {"bunny_closed_72k.ply", "buddha_381k.ply"};
  std::string folder = "../shared/data/meshes";
  int frames = 12;
  bool spatial_order = false;
  std::string json_path;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// A wave through all of the body, along every axis; lengths in heights of it, `frame` at kRate.
std::vector<Vec3> displacements_of(const MeshData& mesh, const Bounds& bounds, int frame) {
  const float height = bounds.highest.y - bounds.lowest.y;
  const float reach = kReach * height, time = 0.1f * static_cast<float>(frame);
  std::vector<Vec3> displacements;
  displacements.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) {
    const float x = p.x / height, y = p.y / height, z = p.z / height;
    displacements.push_back({reach * std::sin(time + 2.1f * y + 0.7f * z), reach * std::sin(1.3f * time + 2.9f * x),
                             reach * std::sin(0.8f * time + 2.6f * y - 1.1f * x)});
  }
  return displacements;
}

void sort_in_space(std::vector<Vec3>& positions) {
  std::vector<unsigned int> remap(positions.size());
  meshopt_spatialSortRemap(remap.data(), &positions.front().x, positions.size(), sizeof(Vec3));
  meshopt_remapVertexBuffer(positions.data(), positions.data(), positions.size(), sizeof(Vec3), remap.data());
}

/// Four numbers a vertex, the last 0.
std::vector<uint16_t> quantized(const std::vector<Vec3>& positions, const Bounds& box) {
  std::vector<uint16_t> steps;
  steps.reserve(4 * positions.size());
  const auto step = [&](float value, float low, float high) {
    steps.push_back(static_cast<uint16_t>(std::lround(65535 * std::clamp((value - low) / (high - low), 0.f, 1.f))));
  };
  for (const Vec3& p : positions) {
    step(p.x, box.lowest.x, box.highest.x);
    step(p.y, box.lowest.y, box.highest.y);
    step(p.z, box.lowest.z, box.highest.z);
    steps.push_back(0);
  }
  return steps;
}

struct Form {
  const char* name;
  double bytes = 0;  ///< of one frame, mean
  std::vector<double> encode_ms, decode_ms;
};

template <typename T>
void code(const std::vector<T>& values, size_t count, Form* form) {
  const size_t each = values.size() * sizeof(T) / count;
  const Clock::time_point begin = Clock::now();
  Bytes bytes(meshopt_encodeVertexBufferBound(count, each));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), count, each));
  const Clock::time_point encoded = Clock::now();
  std::vector<T> back(values.size());
  if (meshopt_decodeVertexBuffer(back.data(), count, each, bytes.data(), bytes.size()) != 0) std::abort();
  const Clock::time_point decoded = Clock::now();
  form->bytes += static_cast<double>(bytes.size());
  form->encode_ms.push_back(std::chrono::duration<double, std::milli>(encoded - begin).count());
  form->decode_ms.push_back(std::chrono::duration<double, std::milli>(decoded - encoded).count());
}

absl::Status run(const Settings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  std::printf("New positions of every vertex, %.0f times a second; medians of %d frames; codec: meshoptimizer's.\n",
              kRate, settings.frames);
  std::printf("%-22s %-33s | %8s | %9s | %6s %6s\n", "mesh", "form", "MB/s", "of float32", "coding", "decod.");
  for (const std::string& name : settings.meshes) {
    const absl::StatusOr<LoadedFile> file = read_mesh_file(settings.folder + "/" + name);
    if (!file.ok()) return file.status();
    MeshData mesh = file->meshes.front();
    if (settings.spatial_order) sort_in_space(mesh.positions);
    const Bounds bounds = *bounds_of(file->meshes);
    const float reach = kReach * (bounds.highest.y - bounds.lowest.y);
    const Vec3 size = {bounds.highest.x - bounds.lowest.x + 2 * reach, bounds.highest.y - bounds.lowest.y + 2 * reach,
                       bounds.highest.z - bounds.lowest.z + 2 * reach};
    const Bounds of_poses = {{bounds.lowest.x - reach, bounds.lowest.y - reach, bounds.lowest.z - reach},
                             {bounds.highest.x + reach, bounds.highest.y + reach, bounds.highest.z + reach}};
    const Bounds of_displacements = {{-reach, -reach, -reach}, {reach, reach, reach}};
    // As long as the box of poses, so that both have the same step.
    const Bounds same_step = {{-size.x / 2, -size.y / 2, -size.z / 2}, {size.x / 2, size.y / 2, size.z / 2}};
    const size_t count = mesh.positions.size();
    Form forms[] = {{"float32"},
                    {"float32, compressed"},
                    {"16 bit"},
                    {"16 bit, compressed"},
                    {"displacements, 16 bit, compressed"},
                    {"the same in steps of the third"}};
    for (int i = 0; i < settings.frames; ++i) {
      const std::vector<Vec3> displacements = displacements_of(mesh, bounds, i);
      std::vector<Vec3> positions = mesh.positions;
      for (size_t v = 0; v < count; ++v) {
        positions[v].x += displacements[v].x;
        positions[v].y += displacements[v].y;
        positions[v].z += displacements[v].z;
      }
      forms[0].bytes += 12.0 * static_cast<double>(count);
      forms[2].bytes += 6.0 * static_cast<double>(count);
      code(positions, count, &forms[1]);
      code(quantized(positions, of_poses), count, &forms[3]);
      code(quantized(displacements, of_displacements), count, &forms[4]);
      code(quantized(displacements, same_step), count, &forms[5]);
    }
    for (const Form& form : forms) {
      const double bytes = form.bytes / settings.frames;
      const double encode = form.encode_ms.empty() ? 0 : median(form.encode_ms);
      const double decode = form.decode_ms.empty() ? 0 : median(form.decode_ms);
      std::printf("%-22s %-33s | %8.2f | %8.0f %% | %6.2f %6.2f\n", name.c_str(), form.name, bytes * kRate / 1e6,
                  100 * bytes / (12.0 * static_cast<double>(count)), encode, decode);
      rows.push_back({{"mesh", name},
                      {"form", form.name},
                      {"bytes_per_second", bytes * kRate},
                      {"encode_ms", encode},
                      {"decode_ms", decode}});
    }
  }
  if (!settings.json_path.empty()) std::ofstream(settings.json_path) << nlohmann::json{{"rows", rows}}.dump(1) << "\n";
  return absl::OkStatus();
}

}  // namespace
}  // namespace diaphane

int main(int argc, char** argv) {
  diaphane::Settings settings;
  CLI::App app("Bytes of streamed positions");
  app.add_option("--meshes", settings.meshes, "files of --folder")->delimiter(',');
  app.add_option("--folder", settings.folder, "with mesh files");
  app.add_option("--frames", settings.frames)->check(CLI::Range(1, 10000));
  app.add_flag("--spatial-order", settings.spatial_order, "vertices sorted by meshoptimizer, neighbours together");
  app.add_option("--json", settings.json_path, "file for the table");
  CLI11_PARSE(app, argc, argv);
  const absl::Status status = diaphane::run(settings);
  if (!status.ok()) std::fprintf(stderr, "bench_deltas: %s\n", std::string(status.message()).c_str());
  return status.ok() ? 0 : 1;
}
