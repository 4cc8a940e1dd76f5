#include "tests/support/shared_meshes.h"

#include <algorithm>
#include <fstream>
#include <glm/common.hpp>
#include <sstream>
namespace diaphane::tests {
std::optional<LoadedMesh> load_shared_mesh(const std::string& name, float extent_mm) {
  std::ifstream f(std::string(DIAPHANE_SOURCE_DIR) + "/../shared/data/meshes/" + name, std::ios::binary);
  if (!f) return {};
  std::string line;
  size_t v = 0, t = 0;
  while (std::getline(f, line) && line != "end_header") {
    std::istringstream s(line);
    std::string a, b;
    size_t n;
    s >> a >> b >> n;
    if (a == "element") {
      (b == "vertex" ? v : t) = n;
    }
  }
  LoadedMesh m;
  m.positions.resize(v);
  m.triangles.resize(t);
  f.read((char*)m.positions.data(), v * 12);
  for (auto& x : m.triangles) {
    char c;
    f.read(&c, 1);
    f.read((char*)&x, 12);
  }
  glm::vec3 lo = m.positions[0], hi = lo;
  for (auto& p : m.positions) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  glm::vec3 e = hi - lo;
  float s = extent_mm / std::max({e.x, e.y, e.z});
  for (auto& p : m.positions) p *= s;
  return m;
}
}  // namespace diaphane::tests
