// Transforms of glTF nodes, as plain 4×4 matrices.
#pragma once

#include <array>
#include <span>

namespace diaphane::readers {

using Matrix = std::array<double, 16>;  ///< column-major

inline constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix multiply(const Matrix& a, const Matrix& b);

/// Of the linear part.
double determinant(const Matrix& m);

/// Translation · rotation · scale, glTF 2.0 section 3.5.3. The rotation is a quaternion x, y, z, w of any length but 0.
Matrix compose(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
               const std::array<double, 3>& scale);

/// What turns normals: the cofactors of the linear part, column-major 3×3, times the sign of its determinant.
std::array<double, 9> normal_matrix(const Matrix& m);

bool fits_float(std::span<const double> values);

}  // namespace diaphane::readers
