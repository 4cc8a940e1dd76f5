#include "diffusion/kernel_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace diaphane::diffusion {
namespace {

using std::numbers::pi;

/// Beyond the last r with r²·Rd above this share of its peak, the kernel is left to decay as it will.
constexpr double kNegligible = 1e-4;
/// From the tables' first v² to their last.
constexpr double kTableSpan = 65536;

/// One term of a profile as a function of r², and its derivatives.
KernelValue term_kernel(const optics::ProfileTerm& term, double distance2) {
  const double height2 = term.height_mm * term.height_mm;
  const double d = std::sqrt(std::max(distance2 + height2, 1e-3 * height2));
  const double s = term.transport_mm * d, e = std::exp(-s), d2 = d * d;
  // (1 + σd) e^(−σd)/d³, then e^(−σd)/d.
  const double flux = term.flux_mm * e / (d * d2), fluence = term.fluence_mm * e / d;
  return {flux * (1 + s) + fluence, -0.5 / d2 * (flux * (3 + s * (3 + s)) + fluence * (1 + s)),
          0.25 / (d2 * d2) * (flux * (15 + s * (15 + s * (6 + s))) + fluence * (3 + s * (3 + s)))};
}

KernelValue profile_kernel(const optics::ChannelProfile& profile, double distance2) {
  KernelValue sum;
  for (const optics::ProfileTerm& term : profile.terms) {
    const KernelValue k = term_kernel(term, distance2);
    sum.value += k.value;
    sum.first += k.first;
    sum.second += k.second;
  }
  return sum;
}

/// Whether Rd is infinite at r = 0.
bool is_singular(const optics::ChannelProfile& profile) { return profile.terms[0].height_mm == 0; }

/// The cubic through four points, as coefficients of powers of t.
std::array<double, 4> interpolate_cubic(const std::array<double, 4>& t, const std::array<double, 4>& values) {
  std::array<double, 4> divided = values;
  for (size_t order = 1; order < 4; ++order) {
    for (size_t i = 3; i >= order; --i) divided[i] = (divided[i] - divided[i - 1]) / (t[i] - t[i - order]);
  }
  std::array<double, 4> coefficients{divided[3], 0, 0, 0};
  for (int i = 2; i >= 0; --i) {
    for (size_t power = 3; power > 0; --power)
      coefficients[power] = coefficients[power - 1] - t[static_cast<size_t>(i)] * coefficients[power];
    coefficients[0] = divided[static_cast<size_t>(i)] - t[static_cast<size_t>(i)] * coefficients[0];
  }
  return coefficients;
}

/// Fills one channel of `table` with kernel(r²).
template <class Kernel>
void tabulate(const KernelDomain& domain, int channel, const Kernel& kernel, KernelTable& table) {
  std::array<double, 4> nodes;
  for (size_t i = 0; i < 4; ++i) nodes[i] = 1.5 - 0.5 * std::cos(pi * (static_cast<double>(i) + 0.5) / 4);
  double start = KernelDomain::kSmallest;
  for (int segment = 0; segment < KernelTable::kSegments; ++segment, start *= 2) {
    std::array<double, 4> values[3];
    for (size_t i = 0; i < 4; ++i) {
      const double v = start * nodes[i], v2 = v * v;
      const KernelValue k = kernel((v2 - KernelDomain::kSmallest * KernelDomain::kSmallest) / domain.scale);
      values[0][i] = k.value * v * v2;
      values[1][i] = k.first * v * v2 * v2;
      values[2][i] = k.second * v * v2 * v2 * v2;
    }
    for (int derivative = 0; derivative < 3; ++derivative) {
      const std::array<double, 4> cubic = interpolate_cubic(nodes, values[derivative]);
      double unit = 1;
      for (size_t power = 0; power < 4; ++power, unit /= start) {
        table.coefficient[derivative][channel][power][segment] = static_cast<float>(cubic[power] * unit);
      }
    }
  }
}

/// The last of log-spaced r with r²·Rd above a share of its peak, over all channels, mm.
double effective_range(const optics::ReflectanceProfile& profile, double diameter) {
  double range = 0;
  for (const optics::ChannelProfile& channel : profile) {
    double peak = 0;
    const double first = 0.1 * channel.smooth_mm;
    for (double r = first; r < diameter; r *= 1.1) peak = std::max(peak, r * r * profile_kernel(channel, r * r).value);
    double last = first;
    for (double r = first; r < diameter; r *= 1.1) {
      if (r * r * profile_kernel(channel, r * r).value > kNegligible * peak) last = r;
    }
    range = std::max(range, 1.1 * last);
  }
  return std::min(range, diameter);
}

/// What the Gaussians miss of Rd counts as so wide, in z: a vertex further from its neighbours would see of it only its
/// value at r = 0, times an area that grows without bound.
constexpr double kMissedDeviation = 1.5;

/// How much of a Gaussian of deviation σ the vertices at this spacing can carry.
double carried_share(double deviation, double spacing) {
  const double t = std::clamp((deviation / spacing - 0.48) / 0.24, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

GaussianSum log_spaced(double narrowest_mm, size_t count, double ratio) {
  GaussianSum sum{std::vector<double>(count), std::vector<double>(count, 0.0)};
  for (size_t k = 0; k < count; ++k) sum.deviation_mm[k] = narrowest_mm * std::pow(ratio, static_cast<double>(k));
  return sum;
}

/// Near enough to each other that the trapezoid rule holds where e^(−ar)/r is next to nothing too.
constexpr size_t kMixtureTerms = 22;
constexpr double kMixtureRatio = 1.3;

/// e^(−ar)/r = (2/√π) ∫ e^(−r²x² − a²/4x²) dx with x = 1/√2σ, by the trapezoid rule in ln σ.
void add_mixture(const optics::ProfileTerm& term, GaussianSum& sum) {
  for (size_t k = 0; k < sum.weight.size(); ++k) {
    const double x = 1 / (std::sqrt(2.0) * sum.deviation_mm[k]);
    const double depth = term.transport_mm / (2 * x);
    sum.weight[k] += term.fluence_mm * 2 / std::sqrt(pi) * x * std::exp(-depth * depth) * std::log(kMixtureRatio);
  }
}

}  // namespace

KernelValue GaussianSum::at(double distance2_mm2) const {
  KernelValue sum;
  for (size_t k = 0; k < weight.size(); ++k) {
    const double rate = 0.5 / (deviation_mm[k] * deviation_mm[k]);
    const double gaussian = weight[k] * std::exp(-rate * distance2_mm2);
    sum.value += gaussian;
    sum.first -= rate * gaussian;
    sum.second += rate * rate * gaussian;
  }
  return sum;
}

double GaussianSum::total() const {
  double sum = 0;
  for (size_t k = 0; k < weight.size(); ++k) sum += weight[k] * 2 * pi * deviation_mm[k] * deviation_mm[k];
  return sum;
}

KernelValue carried_kernel(const optics::ChannelProfile& profile, const GaussianSum& gaussians, double distance2_mm2) {
  return is_singular(profile) ? gaussians.at(distance2_mm2) : profile_kernel(profile, distance2_mm2);
}

glm::vec3 smooth_distance_mm(const optics::ReflectanceProfile& profile) {
  return {profile[0].smooth_mm, profile[1].smooth_mm, profile[2].smooth_mm};
}

GaussianSum fit_gaussians(const optics::ChannelProfile& profile) {
  constexpr int kTerms = 12;
  const double z = profile.smooth_mm;
  if (is_singular(profile)) {
    GaussianSum mixture = log_spaced(0.4 * z, kMixtureTerms, kMixtureRatio);
    for (const optics::ProfileTerm& term : profile.terms) add_mixture(term, mixture);
    return mixture;
  }

  GaussianSum sum = log_spaced(0.4 * z, kTerms, std::sqrt(3.0));
  const double zr = profile.terms[0].height_mm;

  // Normal equations of the weighted least squares.
  double matrix[kTerms][kTerms] = {}, right[kTerms] = {};
  constexpr int kSamples = 160;
  for (int i = 0; i < kSamples; ++i) {
    const double r = 0.03 * z * std::pow(4000.0, static_cast<double>(i) / (kSamples - 1));
    const double rd = profile_kernel(profile, r * r).value;
    // ∫ Rd dA weighs the tail.
    const double weight = 1 / (rd + 0.01 * profile.total / (pi * (r * r + zr * zr)));
    double row[kTerms];
    for (int k = 0; k < kTerms; ++k)
      row[k] = weight * std::exp(-0.5 * r * r / (sum.deviation_mm[k] * sum.deviation_mm[k]));
    for (int a = 0; a < kTerms; ++a) {
      for (int b = 0; b < kTerms; ++b) matrix[a][b] += row[a] * row[b];
      right[a] += row[a] * weight * rd;
    }
  }
  // Coordinate descent on the non-negative orthant; the matrix is small and well enough conditioned.
  for (int sweep = 0; sweep < 1000; ++sweep) {
    for (int a = 0; a < kTerms; ++a) {
      double residual = right[a];
      for (int b = 0; b < kTerms; ++b) residual -= matrix[a][b] * sum.weight[b];
      sum.weight[a] = std::max(0.0, sum.weight[a] + residual / matrix[a][a]);
    }
  }
  return sum;
}

void KernelSet::set_material(const optics::Coefficients& material) {
  profile_ = optics::make_profile(material);
  const glm::vec3 smooth = smooth_distance_mm(profile_);
  smooth_mm_ = std::min({smooth.x, smooth.y, smooth.z});
  for (int c = 0; c < 3; ++c) {
    gaussians_[c] = fit_gaussians(profile_[c]);
    narrow_response_[c] =
        is_singular(profile_[c]) ? static_cast<float>(profile_[c].total - gaussians_[c].total()) : 0.0f;
  }
  diameter_mm_ = 0;
}

void KernelSet::prepare(float diameter_mm, const std::vector<float>& spacing2_mm2) {
  // In steps of two, so that a deforming body keeps its tables.
  const float diameter = std::exp2(std::ceil(std::log2(std::clamp(diameter_mm, 1e-6f, 1e18f))));
  if (diameter != diameter_mm_) {
    diameter_mm_ = diameter;
    const double range = effective_range(profile_, diameter);
    // What v² is at r = 0, mm². Never wider than the kernel's own peak: beyond the tables the kernel falls off by r⁻³,
    // as it does where nothing is absorbed; near the peak nothing would help.
    const double peak2 = smooth_mm_ * smooth_mm_;
    const double first2 = std::clamp(range * range / (0.9 * kTableSpan), 0.3 * peak2, peak2);
    domain_.scale = static_cast<float>(KernelDomain::kSmallest * KernelDomain::kSmallest / first2);
    for (int c = 0; c < 3; ++c) {
      const auto far = [&](double distance2) { return carried_kernel(profile_[c], gaussians_[c], distance2); };
      tabulate(domain_, c, far, far_);
    }
    near_.fill(nullptr);
  }
  for (const float spacing2 : spacing2_mm2) {
    const uint32_t step = locate_spacing(spacing2).step;
    if (!near_[step]) build(step);
    if (!near_[step + 1]) build(step + 1);
  }
}

void KernelSet::build(uint32_t step) {
  const double spacing = spacing_of_step(step);
  bool whole = true;
  for (const GaussianSum& sum : gaussians_) whole = whole && carried_share(sum.deviation_mm[0], spacing) == 1;
  local_response_[step] = narrow_response_;
  if (whole) {
    near_[step] = &far_;
    return;
  }
  if (!built_[step]) built_[step] = std::make_unique<KernelTable>();
  for (int c = 0; c < 3; ++c) {
    const GaussianSum& gaussians = gaussians_[c];
    std::vector<double> rate(gaussians.weight.size()), left_out(gaussians.weight.size());
    double response = 0;
    for (size_t k = 0; k < left_out.size(); ++k) {
      const double variance = gaussians.deviation_mm[k] * gaussians.deviation_mm[k];
      rate[k] = 0.5 / variance;
      left_out[k] = gaussians.weight[k] * (1 - carried_share(gaussians.deviation_mm[k], spacing));
      response += left_out[k] * 2 * pi * variance;
    }
    const double missed_left_out =
        is_singular(profile_[c]) ? 0 : 1 - carried_share(kMissedDeviation * profile_[c].smooth_mm, spacing);
    response += missed_left_out * (profile_[c].total - gaussians.total());
    local_response_[step][c] += static_cast<float>(response);
    const auto near = [&](double distance2) {
      KernelValue k = carried_kernel(profile_[c], gaussians_[c], distance2);
      if (missed_left_out > 0) {
        const KernelValue fit = gaussians_[c].at(distance2);
        k.value -= missed_left_out * (k.value - fit.value);
        k.first -= missed_left_out * (k.first - fit.first);
        k.second -= missed_left_out * (k.second - fit.second);
      }
      for (size_t i = 0; i < left_out.size(); ++i) {
        if (left_out[i] == 0) continue;
        const double gaussian = left_out[i] * std::exp(-rate[i] * distance2);
        k.value -= gaussian;
        k.first += rate[i] * gaussian;
        k.second -= rate[i] * rate[i] * gaussian;
      }
      return k;
    };
    tabulate(domain_, c, near, *built_[step]);
  }
  near_[step] = built_[step].get();
}

}  // namespace diaphane::diffusion
