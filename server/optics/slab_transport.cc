#include "optics/slab_transport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "glm/common.hpp"
#include "glm/exponential.hpp"
#include "optics/dipole.h"

namespace diaphane::optics {
namespace {

constexpr size_t kHalf = 8;          // directions below and above the critical angle
constexpr size_t kBeam = 2 * kHalf;  // and the one along the normal, into which nothing scatters
constexpr size_t kStreams = 2 * kHalf + 1;
constexpr size_t kChains = 4;       // thicknesses between one and its double
constexpr double kThinnest = 0.02;  // mean free paths that are told apart; ln is linear below
constexpr size_t kDoublings = 17;   // up to 2600 of them
constexpr int kSingleLayer = 14;    // doublings of the layer in which light scatters once, up to kThinnest
constexpr double kLeast = 1e-12;    // so that nothing has a logarithm

using Vector = std::array<double, kStreams>;
using Matrix = std::array<Vector, kStreams>;  // [to][from], of fluxes

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (size_t i = 0; i < kStreams; ++i) {
    for (size_t k = 0; k < kStreams; ++k) {
      for (size_t j = 0; j < kStreams; ++j) product[i][j] += a[i][k] * b[k][j];
    }
  }
  return product;
}

Matrix operator+(Matrix a, const Matrix& b) {
  for (size_t i = 0; i < kStreams; ++i) {
    for (size_t j = 0; j < kStreams; ++j) a[i][j] += b[i][j];
  }
  return a;
}

/// (1 − a)⁻¹ b for a whose columns sum up to less than 1: the diagonal leads, no pivoting.
Matrix solve(const Matrix& a, Matrix b) {
  Matrix left;
  for (size_t i = 0; i < kStreams; ++i) {
    for (size_t j = 0; j < kStreams; ++j) left[i][j] = (i == j ? 1.0 : 0.0) - a[i][j];
  }
  for (size_t k = 0; k < kStreams; ++k) {
    for (size_t i = 0; i < kStreams; ++i) {
      if (i == k) continue;
      const double factor = left[i][k] / left[k][k];
      for (size_t j = k; j < kStreams; ++j) left[i][j] -= factor * left[k][j];
      for (size_t j = 0; j < kStreams; ++j) b[i][j] -= factor * b[k][j];
    }
  }
  for (size_t i = 0; i < kStreams; ++i) {
    for (double& value : b[i]) value /= left[i][i];
  }
  return b;
}

/// Cosines inside, and the shares of evenly scattered light that each stands for.
struct Directions {
  Vector cosine{}, share{};
};

Directions directions_of(double refractive_index) {
  const double critical = std::sqrt(std::max(0.0, 1 - 1 / (refractive_index * refractive_index)));
  Directions directions;
  for (size_t i = 0; i < kHalf; ++i) {
    // A root of the Legendre polynomial, by Newton's method.
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (kHalf + 0.5)), slope = 1;
    for (int step = 0; step < 20; ++step) {
      double before = 1, value = x;
      for (size_t n = 2; n <= kHalf; ++n) {
        const auto order = static_cast<double>(n);
        before = std::exchange(value, ((2 * order - 1) * x * value - (order - 1) * before) / order);
      }
      slope = kHalf * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    const double weight = 1 / ((1 - x * x) * slope * slope);
    directions.cosine[i] = critical * 0.5 * (1 + x);
    directions.share[i] = critical * weight;
    directions.cosine[kHalf + i] = critical + (1 - critical) * 0.5 * (1 + x);
    directions.share[kHalf + i] = (1 - critical) * weight;
  }
  directions.cosine[kBeam] = 1;
  // Without a critical angle the lower directions stand for nothing; any cosine will do.
  for (double& cosine : directions.cosine) cosine = std::max(cosine, 1e-3);
  return directions;
}

/// What a layer sends back, and on.
struct Layer {
  Matrix reflected{}, transmitted{};
};

Layer single_layer(const Directions& directions, double albedo, double thickness) {
  Layer layer;
  for (size_t from = 0; from < kStreams; ++from) {
    const double met = -std::expm1(-thickness / directions.cosine[from]);
    for (size_t to = 0; to < kStreams; ++to) {
      layer.reflected[to][from] = 0.5 * albedo * met * directions.share[to];
      layer.transmitted[to][from] = layer.reflected[to][from] + (to == from ? 1 - met : 0.0);
    }
  }
  return layer;
}

Layer doubled(const Layer& layer) {
  const Matrix between = solve(layer.reflected * layer.reflected, layer.transmitted);
  return {layer.reflected + layer.transmitted * (layer.reflected * between), layer.transmitted * between};
}

/// Between boundaries that turn back `inside` of what meets them.
glm::dvec2 leaving(const Layer& layer, const Vector& inside) {
  glm::dvec2 shares(0);
  // What comes in by both faces alike, and by both with opposite signs.
  for (const double sign : {1.0, -1.0}) {
    Matrix turned, beam{};
    for (size_t i = 0; i < kStreams; ++i) {
      for (size_t j = 0; j < kStreams; ++j) {
        turned[i][j] = inside[i] * (layer.reflected[i][j] + sign * layer.transmitted[i][j]);
      }
    }
    beam[kBeam][0] = 1;
    const Matrix coming = solve(turned, beam);
    for (size_t i = 0; i < kBeam; ++i) {
      double met = 0;
      for (size_t j = 0; j < kStreams; ++j) {
        met += (layer.reflected[i][j] + sign * layer.transmitted[i][j]) * coming[j][0];
      }
      const double out = 0.5 * (1 - inside[i]) * met;
      shares += glm::dvec2(out, sign * out);
    }
  }
  return shares;
}

}  // namespace

TransportSlab::TransportSlab(double albedo, double refractive_index) : logarithms_(kChains * kDoublings) {
  const Directions directions = directions_of(refractive_index);
  Vector inside;
  for (size_t i = 0; i < kStreams; ++i) {
    // Reflectance is the same from both sides of the boundary.
    const double sine = refractive_index * std::sqrt(1 - directions.cosine[i] * directions.cosine[i]);
    const double outside = std::sqrt(std::max(0.0, 1 - sine * sine));
    inside[i] =
        sine >= 1 ? 1 : 1 - fresnel_transmittance(static_cast<float>(refractive_index), static_cast<float>(outside));
  }
  for (size_t chain = 0; chain < kChains; ++chain) {
    const double first = kThinnest * std::exp2(static_cast<double>(chain) / kChains);
    Layer layer = single_layer(directions, albedo, std::ldexp(first, -kSingleLayer));
    for (int i = 0; i < kSingleLayer; ++i) layer = doubled(layer);
    for (size_t i = 0; i < kDoublings; ++i) {
      if (i > 0) layer = doubled(layer);
      logarithms_[kChains * i + chain] = glm::log(glm::max(leaving(layer, inside), kLeast));
    }
  }
}

glm::dvec2 TransportSlab::at(double thickness) const {
  if (!(thickness > 0)) return glm::dvec2(0);
  const double last = static_cast<double>(logarithms_.size() - 1);
  const double place = kChains * std::log2(thickness / kThinnest);
  // Thinner, both fall with the thickness; thicker, the one stays and the other falls.
  if (place <= 0) return glm::exp(logarithms_.front()) * (thickness / kThinnest);
  if (place >= last) return glm::exp(logarithms_.back()) * glm::dvec2(1, std::exp2((last - place) / kChains));
  // A cubic through the four nearest (Catmull-Rom), straight at the ends.
  const auto step = static_cast<size_t>(place);
  const double t = place - static_cast<double>(step);
  const glm::dvec2 &b = logarithms_[step], &c = logarithms_[step + 1];
  const glm::dvec2 a = step > 0 ? logarithms_[step - 1] : 2.0 * b - c;
  const glm::dvec2 d = step + 2 < logarithms_.size() ? logarithms_[step + 2] : 2.0 * c - b;
  const glm::dvec2 bend = t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
  return glm::exp(b + 0.5 * bend);
}

}  // namespace diaphane::optics
