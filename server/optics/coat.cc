#include "optics/coat.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "glm/common.hpp"
#include "glm/geometric.hpp"
#include "optics/dipole.h"

namespace diaphane::optics {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kSmoothest = 0.001f;
constexpr int kRounds = 16;
constexpr int kSide = 48;  ///< of the grid of draws at a node

/// Smith's Λ.
float lambda(const glm::vec3& w, float alpha) {
  const float cosine2 = w.z * w.z;
  const float tangent2 = std::max(0.0f, 1 - cosine2) / std::max(cosine2, 1e-12f);
  return 0.5f * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
}

float ggx(const glm::vec3& h, float alpha) {
  const float alpha2 = alpha * alpha;
  // h.z² (α² − 1) + 1, without its cancellation near the normal.
  const float d = alpha2 * h.z * h.z + h.x * h.x + h.y * h.y;
  return alpha2 / (kPi * d * d);
}

glm::vec3 visible_normal(const glm::vec3& to_eye, float alpha, const glm::vec2& random) {
  const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * to_eye.x, alpha * to_eye.y, to_eye.z));
  const float length2 = stretched.x * stretched.x + stretched.y * stretched.y;
  const glm::vec3 across =
      length2 > 0 ? glm::vec3(-stretched.y, stretched.x, 0) / std::sqrt(length2) : glm::vec3(1, 0, 0);
  const glm::vec3 upwards = glm::cross(stretched, across);
  const float radius = std::sqrt(random.x), angle = 2 * kPi * random.y;
  const float a = radius * std::cos(angle);
  const float share = 0.5f * (1 + stretched.z);
  const float b = glm::mix(std::sqrt(std::max(0.0f, 1 - a * a)), radius * std::sin(angle), share);
  const glm::vec3 n = a * across + b * upwards + std::sqrt(std::max(0.0f, 1 - a * a - b * b)) * stretched;
  return glm::normalize(glm::vec3(alpha * n.x, alpha * n.y, std::max(n.z, 1e-7f)));
}

struct Bounce {
  glm::vec3 to_light{0};
  float weight = 0;   ///< F·G₂/G₁
  float density = 0;  ///< sr⁻¹
};

Bounce bounce(const glm::vec3& to_eye, float alpha, float refractive_index, const glm::vec2& random) {
  const glm::vec3 h = visible_normal(to_eye, alpha, random);
  const float along = glm::dot(to_eye, h);
  const glm::vec3 to_light = 2 * along * h - to_eye;
  if (to_light.z <= 0) return {};
  const float of_eye = lambda(to_eye, alpha);
  const float fresnel = 1 - fresnel_transmittance(refractive_index, along);
  return {to_light, fresnel * (1 + of_eye) / (1 + of_eye + lambda(to_light, alpha)),
          ggx(h, alpha) / ((1 + of_eye) * 4 * to_eye.z)};
}

/// Of a node; the first is grazing.
float node_cosine(size_t node, size_t count) {
  const float root = (static_cast<float>(node) + 0.5f) / static_cast<float>(count);
  return root * root;
}

}  // namespace

BalancedCoat::BalancedCoat(const Coat& coat, float refractive_index)
    : alpha_(std::max(coat.roughness, kSmoothest)), refractive_index_(refractive_index) {
  balance_.fill(1);
  struct Draw {
    float cosine, weight;
  };
  std::array<std::vector<Draw>, kNodes> draws;
  for (size_t node = 0; node < kNodes; ++node) {
    const float cosine = node_cosine(node, kNodes);
    const glm::vec3 to_eye(std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine);
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const glm::vec2 random = (glm::vec2(i, j) + 0.5f) / static_cast<float>(kSide);
        const Bounce drawn = bounce(to_eye, alpha_, refractive_index_, random);
        if (drawn.weight > 0) draws[node].push_back({drawn.to_light.z, drawn.weight});
      }
    }
  }
  // Both ends of a path have the factor, so each round takes the root (Sinkhorn's balancing of a symmetric kernel).
  for (int round = 0; round < kRounds; ++round) {
    const std::array<float, kNodes> before = balance_;
    std::array<float, kNodes> after;
    for (size_t node = 0; node < kNodes; ++node) {
      double sum = 0;
      for (const Draw& draw : draws[node]) sum += static_cast<double>(draw.weight) * balance(draw.cosine);
      const float reflected = before[node] * static_cast<float>(sum / (kSide * kSide));
      const float wanted = albedo(node_cosine(node, kNodes));
      after[node] = reflected > 0 ? before[node] * std::sqrt(wanted / reflected) : 1.0f;
    }
    balance_ = after;
  }
}

float BalancedCoat::balance(float cosine) const {
  const float at = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * kNodes - 0.5f;
  const float below = std::clamp(std::floor(at), 0.0f, static_cast<float>(kNodes - 2));
  const auto node = static_cast<size_t>(below);
  return glm::mix(balance_[node], balance_[node + 1], std::clamp(at - below, 0.0f, 1.0f));
}

float BalancedCoat::albedo(float cosine) const { return 1 - fresnel_transmittance(refractive_index_, cosine); }

BalancedCoat::Arrival BalancedCoat::arrival(const glm::vec3& to_eye, const glm::vec2& random) const {
  const Bounce drawn = bounce(to_eye, alpha_, refractive_index_, random);
  return {drawn.to_light, drawn.weight * balance(to_eye.z) * balance(drawn.to_light.z), drawn.density};
}

float BalancedCoat::reflectance(const glm::vec3& to_light, const glm::vec3& to_eye) const {
  if (!(to_light.z > 0 && to_eye.z > 0)) return 0;
  const glm::vec3 h = glm::normalize(to_light + to_eye);
  const float fresnel = 1 - fresnel_transmittance(refractive_index_, glm::dot(to_eye, h));
  const float shadowing = 1 / (1 + lambda(to_light, alpha_) + lambda(to_eye, alpha_));
  return fresnel * ggx(h, alpha_) * shadowing / (4 * to_light.z * to_eye.z) * balance(to_light.z) * balance(to_eye.z);
}

}  // namespace diaphane::optics
