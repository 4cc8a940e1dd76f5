#include "readers/gltf_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace diaphane::readers {

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 4; ++row) {
      for (size_t k = 0; k < 4; ++k) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return product;
}

double determinant(const Matrix& m) {
  return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) + m[8] * (m[1] * m[6] - m[5] * m[2]);
}

Matrix compose(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
               const std::array<double, 3>& scale) {
  const double length = std::hypot(std::hypot(rotation[0], rotation[1]), std::hypot(rotation[2], rotation[3]));
  const double x = rotation[0] / length, y = rotation[1] / length, z = rotation[2] / length, w = rotation[3] / length;
  Matrix m = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),     0,
              2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),     0,
              2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y), 0,
              translation[0],          translation[1],          translation[2],          1};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t row = 0; row < 3; ++row) m[4 * axis + row] *= scale[axis];
  }
  return m;
}

std::array<double, 9> normal_matrix(const Matrix& m) {
  const double sign = determinant(m) < 0 ? -1 : 1;
  std::array<double, 9> c{};
  for (size_t column = 0; column < 3; ++column) {
    for (size_t row = 0; row < 3; ++row) {
      const size_t c1 = (column + 1) % 3, c2 = (column + 2) % 3, r1 = (row + 1) % 3, r2 = (row + 2) % 3;
      c[3 * column + row] = sign * (m[4 * c1 + r1] * m[4 * c2 + r2] - m[4 * c2 + r1] * m[4 * c1 + r2]);
    }
  }
  return c;
}

bool fits_float(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::abs(value) <= std::numeric_limits<float>::max(); });
}

}  // namespace diaphane::readers
