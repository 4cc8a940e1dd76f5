// Between two nodes of a level: which pairs may stand for each other, and what the far ones give.
#if defined(DIAPHANE_DIFFUSION_FAR_FIELD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DIAPHANE_DIFFUSION_FAR_FIELD_INL_H_
#undef DIAPHANE_DIFFUSION_FAR_FIELD_INL_H_
#else
#define DIAPHANE_DIFFUSION_FAR_FIELD_INL_H_
#endif

#include "diffusion/gather.h"
#include "diffusion/kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {

/// Children of near nodes side by side: row f begins at rows + f·stride.
struct Pack {
  const float* rows;
  const uint32_t* nodes;
  size_t stride;
  size_t count;
};

/// Copies the four children of each node in `near` (nodes of level + 1), padded to whole vectors without flux.
HWY_INLINE Pack pack_children(const NodeTree& tree, uint32_t level, const uint32_t* near, size_t near_count,
                              bool coloured, GatherScratch::Level& scratch) {
  const size_t lanes = hn::Lanes(Tag());
  const size_t count = 4 * near_count;
  const size_t stride = (count + lanes - 1) / lanes * lanes;
  const uint32_t fields = coloured ? kNodeFields : uint32_t{kDipole};
  // A compressing store may write a whole vector past its end.
  if (scratch.near.size() < stride + lanes) {
    const size_t columns = 2 * (stride + lanes);
    scratch.near.resize(columns);
    scratch.pack_nodes.resize(columns);
    scratch.pack.resize(columns * kNodeFields);
  }
  float* rows = scratch.pack.data();
  for (size_t i = 0; i < near_count; ++i) {
    const float* block = tree.block(level, near[i]);
    for (uint32_t f = 0; f < fields; ++f) std::memcpy(rows + f * stride + 4 * i, block + 4 * f, 4 * sizeof(float));
    for (uint32_t k = 0; k < 4; ++k) scratch.pack_nodes[4 * i + k] = 4 * near[i] + k;
  }
  for (uint32_t f = 0; f < fields; ++f) std::fill(rows + f * stride + count, rows + (f + 1) * stride, 0.0f);
  return {rows, scratch.pack_nodes.data(), stride, count};
}

struct Receiver {
  glm::vec3 centre_mm;
  float spread2;
  float radius;
};

/// ΔᵀCΔ and the like of a block of sources or receivers.
struct Displacement {
  V x, y, z, squared;
};

HWY_INLINE V covariance_along(const Displacement& way, V xx, V yy, V zz, V xy2, V xz2, V yz2) {
  const V along_x = hn::MulAdd(xx, way.x, hn::MulAdd(xy2, way.y, hn::Mul(xz2, way.z)));
  const V along_y = hn::MulAdd(yy, way.y, hn::Mul(yz2, way.z));
  return hn::MulAdd(along_x, way.x, hn::MulAdd(along_y, way.y, hn::Mul(hn::Mul(zz, way.z), way.z)));
}

/// What the accepted sources give, summed lane by lane.
template <bool kColoured>
struct FarField {
  V value[3], gradient[3][3], hessian[3][6];

  HWY_INLINE FarField() {
    const V zero = hn::Zero(Tag());
    for (int c = 0; c < 3; ++c) {
      value[c] = zero;
      for (V& g : gradient[c]) g = zero;
      for (V& h : hessian[c]) h = zero;
    }
  }

  /// Adds the pack's vector at `i` where `accepted`. Value Φ(f + tr C f′ + 2f″ΔᵀCΔ) − 2f′Δ·D, gradient 2Φf′Δ − 2f′D −
  /// 4f″(Δ·D)Δ, Hessian Φ(2f′I + 4f″ΔΔᵀ), Δ from the flux centroid to the receiver's centre, derivatives in r².
  HWY_INLINE void add(const KernelDomain& domain, const KernelTable& table, const Pack& pack, size_t i,
                      const Receiver& receiver, hn::Mask<Tag> accepted) {
    const Tag d;
    const auto row = [&](uint32_t field) HWY_ATTR { return hn::Load(d, pack.rows + field * pack.stride + i); };
    Displacement way;
    way.x = hn::Sub(hn::Set(d, receiver.centre_mm.x), row(kFluxX));
    way.y = hn::Sub(hn::Set(d, receiver.centre_mm.y), row(kFluxY));
    way.z = hn::Sub(hn::Set(d, receiver.centre_mm.z), row(kFluxZ));
    const V xx = hn::Mul(way.x, way.x), yy = hn::Mul(way.y, way.y), zz = hn::Mul(way.z, way.z);
    TablePosition at = locate(domain, hn::Add(xx, hn::Add(yy, zz)));
    // No weight, no contribution.
    at.inverse = hn::IfThenElseZero(accepted, at.inverse);
    const V inverse2 = hn::Mul(at.inverse, at.inverse);
    const V inverse3 = hn::Mul(inverse2, at.inverse);
    const V inverse4 = hn::Mul(inverse2, inverse2);
    const V cov_xx = row(kCovXX), cov_yy = row(kCovYY), cov_zz = row(kCovZZ);
    const V trace = hn::Add(cov_xx, hn::Add(cov_yy, cov_zz));
    V along = covariance_along(way, cov_xx, cov_yy, cov_zz, row(kCov2XY), row(kCov2XZ), row(kCov2YZ));
    along = hn::Add(along, along);
    const V xy = hn::Mul(way.x, way.y), xz = hn::Mul(way.x, way.z), yz = hn::Mul(way.y, way.z);
    const V two = hn::Set(d, 2.0f);
    for (int c = 0; c < 3; ++c) {
      const V flux = row(kFluxR + static_cast<uint32_t>(c));
      const V f = hn::Mul(cubic(table.coefficient[0][c], at), inverse2);
      const V f1 = hn::Mul(cubic(table.coefficient[1][c], at), inverse3);
      const V f2 = hn::Mul(cubic(table.coefficient[2][c], at), inverse4);
      value[c] = hn::MulAdd(flux, hn::MulAdd(trace, f1, hn::MulAdd(along, f2, f)), value[c]);
      const V slope = hn::Mul(two, hn::Mul(flux, f1));
      const V bend = hn::Mul(hn::Set(d, 4.0f), hn::Mul(flux, f2));
      V pull = slope;
      if constexpr (kColoured) {
        const uint32_t field = kDipole + 3 * static_cast<uint32_t>(c);
        const V dx = row(field), dy = row(field + 1), dz = row(field + 2);
        const V dot = hn::MulAdd(dx, way.x, hn::MulAdd(dy, way.y, hn::Mul(dz, way.z)));
        const V twice = hn::Mul(two, f1);
        value[c] = hn::NegMulAdd(twice, dot, value[c]);
        gradient[c][0] = hn::NegMulAdd(twice, dx, gradient[c][0]);
        gradient[c][1] = hn::NegMulAdd(twice, dy, gradient[c][1]);
        gradient[c][2] = hn::NegMulAdd(twice, dz, gradient[c][2]);
        pull = hn::NegMulAdd(hn::Mul(hn::Set(d, 4.0f), f2), dot, slope);
      }
      gradient[c][0] = hn::MulAdd(pull, way.x, gradient[c][0]);
      gradient[c][1] = hn::MulAdd(pull, way.y, gradient[c][1]);
      gradient[c][2] = hn::MulAdd(pull, way.z, gradient[c][2]);
      hessian[c][0] = hn::Add(hessian[c][0], hn::MulAdd(bend, xx, slope));
      hessian[c][1] = hn::Add(hessian[c][1], hn::MulAdd(bend, yy, slope));
      hessian[c][2] = hn::Add(hessian[c][2], hn::MulAdd(bend, zz, slope));
      hessian[c][3] = hn::MulAdd(bend, xy, hessian[c][3]);
      hessian[c][4] = hn::MulAdd(bend, xz, hessian[c][4]);
      hessian[c][5] = hn::MulAdd(bend, yz, hessian[c][5]);
    }
  }

  HWY_INLINE void add_to(Expansion& expansion) const {
    const Tag d;
    const auto sum = [&](V v) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, v)); };
    for (int c = 0; c < 3; ++c) {
      expansion.value[c] += sum(value[c]);
      for (int a = 0; a < 3; ++a) expansion.gradient[c][a] += sum(gradient[c][a]);
      for (int m = 0; m < 6; ++m) expansion.hessian[c][m] += sum(hessian[c][m]);
    }
  }
};

/// How many entries of the lists are in use.
struct ListCounts {
  size_t near = 0;          ///< nodes to be opened
  size_t leaf_moments = 0;  ///< columns that the leaf takes as moments
};

/// Adds what is far from `receiver` to `expansion` and lists the rest; where the receiver is a leaf, those whose moments
/// suffice for its vertices apart. Nodes without flux are neither.
template <bool kColoured, bool kLeaf>
HWY_INLINE ListCounts far_field(const GatherInput& input, const Pack& pack, const Receiver& receiver,
                                GatherScratch& scratch, GatherScratch::Level& level, Expansion& expansion) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> du;
  const float z2 = input.kernels->smooth_mm() * input.kernels->smooth_mm();
  const V opening2 = hn::Set(d, input.settings.opening * input.settings.opening);
  const V leaf_opening2 = hn::Set(d, input.settings.leaf_opening * input.settings.leaf_opening);
  const V x = hn::Set(d, receiver.centre_mm.x), y = hn::Set(d, receiver.centre_mm.y);
  const V z = hn::Set(d, receiver.centre_mm.z);
  const V radius = hn::Set(d, receiver.radius), spread2 = hn::Set(d, receiver.spread2);
  FarField<kColoured> far;
  bool any = false;
  ListCounts counts;
  for (size_t i = 0; i < pack.count; i += hn::Lanes(d)) {
    const auto row = [&](uint32_t field) HWY_ATTR { return hn::Load(d, pack.rows + field * pack.stride + i); };
    const V dx = hn::Sub(x, row(kCentreX)), dy = hn::Sub(y, row(kCentreY)), dz = hn::Sub(z, row(kCentreZ));
    const V distance2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const V reach2 = hn::Add(distance2, hn::Set(d, z2));
    const V source_radius = row(kRadius), source_spread2 = row(kSpread2);
    const V radii = hn::Add(source_radius, radius);
    const auto lit = hn::Gt(hn::Add(row(kFluxR), hn::Add(row(kFluxG), row(kFluxB))), hn::Zero(d));
    const auto apart = hn::And(hn::Lt(hn::Add(source_spread2, spread2), hn::Mul(opening2, reach2)),
                               hn::And(hn::Lt(hn::Mul(radii, radii), hn::Mul(hn::Set(d, 1.2f), reach2)),
                                       hn::Lt(hn::Mul(radius, radius), hn::Mul(hn::Set(d, 0.3f), reach2))));
    const auto accepted = hn::And(lit, apart);
    if (!hn::AllFalse(d, accepted)) {
      far.add(input.kernels->domain(), input.kernels->far_table(), pack, i, receiver, accepted);
      any = true;
    }
    auto listed = hn::AndNot(apart, lit);
    if (hn::AllFalse(d, listed)) continue;
    if constexpr (kLeaf) {
      const V gap = hn::Max(hn::Sub(hn::Sqrt(distance2), radius), hn::Zero(d));
      const V gap2 = hn::MulAdd(gap, gap, hn::Set(d, z2));
      const auto by_moments = hn::And(listed, hn::And(hn::Lt(source_spread2, hn::Mul(leaf_opening2, gap2)),
                                                      hn::Lt(hn::Mul(source_radius, source_radius),
                                                             hn::Mul(hn::Set(d, 1.2f), gap2))));
      const auto columns = hn::Iota(du, static_cast<uint32_t>(i));
      counts.leaf_moments += hn::CompressStore(columns, hn::RebindMask(du, by_moments), du,
                                               scratch.leaf_moments.data() + counts.leaf_moments);
      listed = hn::AndNot(by_moments, listed);
    }
    counts.near += hn::CompressStore(hn::Load(du, pack.nodes + i), hn::RebindMask(du, listed), du,
                                     level.near.data() + counts.near);
  }
  if (any) far.add_to(expansion);
  return counts;
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
