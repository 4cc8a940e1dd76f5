#include "tests/support/reference_scenes.h"

#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace diaphane::testing {
namespace {

std::string read_gz(const std::string& path) {
  std::string bytes;
  gzFile file = gzopen(path.c_str(), "rb");
  char block[1 << 16];
  for (int count = 0; (count = gzread(file, block, sizeof block)) > 0;) bytes.append(block, static_cast<size_t>(count));
  gzclose(file);
  return bytes;
}

glm::vec3 vec3_of(const nlohmann::json& values) { return {values[0], values[1], values[2]}; }

nlohmann::json scenes() {
  std::ifstream file(shared_path("reference/scenes.json"));
  return file ? nlohmann::json::parse(file)["scenes"] : nlohmann::json();
}

}  // namespace

std::optional<ReferenceScene> load_reference_scene(const std::string& name) {
  const nlohmann::json all = scenes();
  if (all.is_null()) return std::nullopt;
  const nlohmann::json& scene = all[name];
  ReferenceScene loaded;
  loaded.mesh = *read_obj_gz(shared_path("reference/" + scene["mesh"].get<std::string>()));
  loaded.material = {vec3_of(scene["material"]["sigma_a_per_mm"]), vec3_of(scene["material"]["sigma_s_prime_per_mm"]),
                     scene["material"]["eta"]};
  loaded.light_position_mm = vec3_of(scene["light"]["position_mm"]);
  loaded.light_intensity_w_sr = scene["light"]["radiant_intensity_W_per_sr_each_channel"];
  const nlohmann::json& camera = scene["camera"];
  loaded.eye_mm = vec3_of(camera["eye_mm"]);
  loaded.target_mm = vec3_of(camera["look_at_mm"]);
  loaded.up = vec3_of(camera["up"]);
  loaded.fov_y_deg = camera["fov_deg_full_vertical_and_horizontal"];
  loaded.size_px = camera["pixels"][0];
  return loaded;
}

std::vector<glm::vec3> load_reference_image(const std::string& name, bool shadowed) {
  const std::string file = scenes()[name]["files"][shadowed ? "jmlh_shadowed" : "jmlh_unshadowed"];
  const std::string bytes = read_gz(shared_path("reference/" + file));
  // "PF\nWIDTH HEIGHT\n-1.0\n", then little-endian rows from the bottom.
  size_t header = 0;
  for (int line = 0; line < 3; ++line) header = bytes.find('\n', header) + 1;
  const size_t count = (bytes.size() - header) / sizeof(glm::vec3);
  const auto side = static_cast<size_t>(std::lround(std::sqrt(static_cast<double>(count))));
  std::vector<glm::vec3> pixels(count);
  for (size_t row = 0; row < side; ++row) {
    std::memcpy(&pixels[(side - 1 - row) * side], bytes.data() + header + row * side * sizeof(glm::vec3),
                side * sizeof(glm::vec3));
  }
  return pixels;
}

glm::vec3 relative_rms_inside(const std::vector<glm::vec3>& image, const std::vector<glm::vec3>& truth,
                              uint32_t size_px) {
  std::vector<glm::vec3> inside_image;
  std::vector<glm::vec3> inside_truth;
  for (size_t y = 1; y + 1 < size_px; ++y) {
    for (size_t x = 1; x + 1 < size_px; ++x) {
      bool inside = true;
      for (size_t ny = y - 1; ny <= y + 1; ++ny) {
        for (size_t nx = x - 1; nx <= x + 1; ++nx) inside = inside && truth[ny * size_px + nx] != glm::vec3(0);
      }
      if (!inside) continue;
      inside_image.push_back(image[y * size_px + x]);
      inside_truth.push_back(truth[y * size_px + x]);
    }
  }
  return relative_rms(inside_image, inside_truth);
}

}  // namespace diaphane::testing
