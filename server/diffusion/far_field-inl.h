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
  if (scratch.near.size() < stride) {
    const size_t columns = 2 * stride;
    scratch.near.resize(columns);
    scratch.pack_nodes.resize(columns);
    scratch.pack.resize(columns * kNodeFields);
  }
  float* rows = scratch.pack.data();
  for (size_t i = 0; i < near_count; ++i) {
    const float* block = tree.block(level, near[i]);
    float* to = rows + 4 * i;
    static_assert(kDipole % 3 == 0 && kNodeFields % 3 == 0);
    for (uint32_t f = 0; f < fields; f += 3, to += 3 * stride, block += 12) {
      std::memcpy(to, block, 4 * sizeof(float));
      std::memcpy(to + stride, block + 4, 4 * sizeof(float));
      std::memcpy(to + 2 * stride, block + 8, 4 * sizeof(float));
    }
    for (uint32_t k = 0; k < 4; ++k) scratch.pack_nodes[4 * i + k] = 4 * near[i] + k;
  }
  for (uint32_t f = 0; f < fields; ++f) std::fill(rows + f * stride + count, rows + (f + 1) * stride, 0.0f);
  return {rows, scratch.pack_nodes.data(), stride, count};
}

struct Receiver {
  glm::vec3 centre_mm;
  float spread2;
  float radius;
  float area;
  glm::vec3 facing;  ///< Σ area vectors
  float spacing;     ///< of its vertices, mm; leaves only
};

/// A group is on the other side of a thin part when the mean normals (short where a group mixes directions) say so, and
/// deeper than so many vertex spacings, its own or the leaf's: nearer ones (around a rim, or coarse) cannot be resolved
/// and fade like the surface around.
constexpr float kOppositeCosine = -0.85f;
constexpr float kOppositeDepth = 1.3f;

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
  /// 4f″(Δ·D)Δ and what the quadrupole adds to it, Hessian Φ(2f′I + 4f″ΔΔᵀ), Δ from the flux centroid to the receiver's
  /// centre, derivatives in r².
  HWY_INLINE void add(const KernelDomain& domain, const KernelTable& table, const Pack& pack, size_t i,
                      const Receiver& receiver, hn::Mask<Tag> accepted) {
    const Tag d;
    const auto row = [&](uint32_t field) HWY_ATTR { return hn::Load(d, pack.rows + field * pack.stride + i); };
    Displacement way;
    way.x = hn::Sub(hn::Set(d, receiver.centre_mm.x), row(kFluxX));
    way.y = hn::Sub(hn::Set(d, receiver.centre_mm.y), row(kFluxY));
    way.z = hn::Sub(hn::Set(d, receiver.centre_mm.z), row(kFluxZ));
    const V xx = hn::Mul(way.x, way.x), yy = hn::Mul(way.y, way.y), zz = hn::Mul(way.z, way.z);
    const TablePosition at = locate(domain, hn::Add(xx, hn::Add(yy, zz)));
    // No weight, no contribution.
    const V inverse3 = hn::IfThenElseZero(accepted, at.inverse3);
    const V inverse5 = hn::Mul(inverse3, at.inverse2);
    const V inverse7 = hn::Mul(inverse5, at.inverse2);
    const V cov_xx = row(kCovXX), cov_yy = row(kCovYY), cov_zz = row(kCovZZ);
    const V trace = hn::Add(cov_xx, hn::Add(cov_yy, cov_zz));
    const V half = hn::Set(d, 0.5f);
    const V cov_xy = hn::Mul(half, row(kCov2XY)), cov_xz = hn::Mul(half, row(kCov2XZ)),
            cov_yz = hn::Mul(half, row(kCov2YZ));
    // CΔ and 2ΔᵀCΔ.
    const V turned_x = hn::MulAdd(cov_xx, way.x, hn::MulAdd(cov_xy, way.y, hn::Mul(cov_xz, way.z)));
    const V turned_y = hn::MulAdd(cov_xy, way.x, hn::MulAdd(cov_yy, way.y, hn::Mul(cov_yz, way.z)));
    const V turned_z = hn::MulAdd(cov_xz, way.x, hn::MulAdd(cov_yz, way.y, hn::Mul(cov_zz, way.z)));
    V along = hn::MulAdd(turned_x, way.x, hn::MulAdd(turned_y, way.y, hn::Mul(turned_z, way.z)));
    along = hn::Add(along, along);
    const V third_scale = hn::Mul(hn::Set(d, 0.5f * domain.scale), at.inverse2);
    const V xy = hn::Mul(way.x, way.y), xz = hn::Mul(way.x, way.z), yz = hn::Mul(way.y, way.z);
    const V two = hn::Set(d, 2.0f);
    for_channels([&](int c) HWY_ATTR {
      const V flux = row(kFluxR + static_cast<uint32_t>(c));
      const V f = hn::Mul(cubic(table.coefficient[0][c], at), inverse3);
      const V f1 = hn::Mul(cubic(table.coefficient[1][c], at), inverse5);
      // f‴ from the slope of the same cubic: d(v²)/d(r²) is the domain's scale.
      const CubicSlope second = cubic_slope(table.coefficient[2][c], at);
      const V f2 = hn::Mul(second.value, inverse7);
      const V f3 = hn::Mul(hn::Mul(third_scale, inverse7),
                           hn::NegMulAdd(hn::Set(d, 7.0f), second.value, hn::Mul(second.slope, at.v)));
      value[c] = hn::MulAdd(flux, hn::MulAdd(trace, f1, hn::MulAdd(along, f2, f)), value[c]);
      const V slope = hn::Mul(two, hn::Mul(flux, f1));
      const V bend = hn::Mul(hn::Set(d, 4.0f), hn::Mul(flux, f2));
      // 2Φ(tr C f″ + 2f‴ΔᵀCΔ)Δ + 4Φf″CΔ: how the quadrupole's share changes across the receiver.
      V pull = hn::MulAdd(hn::Mul(two, flux), hn::MulAdd(trace, f2, hn::Mul(along, f3)), slope);
      gradient[c][0] = hn::MulAdd(bend, turned_x, gradient[c][0]);
      gradient[c][1] = hn::MulAdd(bend, turned_y, gradient[c][1]);
      gradient[c][2] = hn::MulAdd(bend, turned_z, gradient[c][2]);
      if constexpr (kColoured) {
        const uint32_t field = kDipole + 3 * static_cast<uint32_t>(c);
        const V dx = row(field), dy = row(field + 1), dz = row(field + 2);
        const V dot = hn::MulAdd(dx, way.x, hn::MulAdd(dy, way.y, hn::Mul(dz, way.z)));
        const V twice = hn::Mul(two, f1);
        value[c] = hn::NegMulAdd(twice, dot, value[c]);
        gradient[c][0] = hn::NegMulAdd(twice, dx, gradient[c][0]);
        gradient[c][1] = hn::NegMulAdd(twice, dy, gradient[c][1]);
        gradient[c][2] = hn::NegMulAdd(twice, dz, gradient[c][2]);
        pull = hn::NegMulAdd(hn::Mul(hn::Set(d, 4.0f), f2), dot, pull);
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
    });
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

/// Appends entry(lane) for each lane of `mask`. (A compressing store copies its own table each time where there is no
/// such instruction.)
template <class Entry>
HWY_INLINE size_t append(hn::Mask<Tag> mask, const Entry& entry, uint32_t* list, size_t count) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(Tag(), mask, bytes);
  uint32_t bits;
  std::memcpy(&bits, bytes, sizeof(bits));
  for (; bits != 0; bits &= bits - 1) list[count++] = entry(static_cast<uint32_t>(std::countr_zero(bits)));
  return count;
}

/// Adds what is far from `receiver` to `expansion`; lists the rest, to be opened, in level.near, and gives their
/// number. Where the receiver is a leaf, those whose moments suffice for its vertices go to scratch.sides. Nodes
/// without flux are neither.
template <bool kColoured, bool kLeaf>
HWY_INLINE size_t far_field(const GatherInput& input, const Pack& pack, const Receiver& receiver,
                            GatherScratch& scratch, GatherScratch::Level& level, Expansion& expansion) {
  const Tag d;
  const float z2 = input.kernels->smooth_mm() * input.kernels->smooth_mm();
  const V opening2 = hn::Set(d, input.settings.opening * input.settings.opening);
  const V leaf_opening2 = hn::Set(d, input.settings.leaf_opening * input.settings.leaf_opening);
  const V x = hn::Set(d, receiver.centre_mm.x), y = hn::Set(d, receiver.centre_mm.y);
  const V z = hn::Set(d, receiver.centre_mm.z);
  const V radius = hn::Set(d, receiver.radius), spread2 = hn::Set(d, receiver.spread2);
  FarField<kColoured> far;
  bool any = false;
  size_t open = 0;
  for (LeafSources& side : scratch.sides) side.wide_moment_count = 0;
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
      const auto by_moments =
          hn::And(listed, hn::And(hn::Lt(source_spread2, hn::Mul(leaf_opening2, gap2)),
                                  hn::Lt(hn::Mul(source_radius, source_radius), hn::Mul(hn::Set(d, 1.2f), gap2))));
      // F·F′ < cosine·A·A′ and |F·(c − c′)| > depth·A·s, s² the larger of the leaf's and a sixteenth of the source's
      // area.
      const V turn = hn::MulAdd(hn::Set(d, receiver.facing.x), row(kFacingX),
                                hn::MulAdd(hn::Set(d, receiver.facing.y), row(kFacingY),
                                           hn::Mul(hn::Set(d, receiver.facing.z), row(kFacingZ))));
      const V depth =
          hn::MulAdd(hn::Set(d, receiver.facing.x), dx,
                     hn::MulAdd(hn::Set(d, receiver.facing.y), dy, hn::Mul(hn::Set(d, receiver.facing.z), dz)));
      const auto opposite =
          hn::And(hn::Lt(turn, hn::Mul(hn::Set(d, kOppositeCosine * receiver.area), row(kArea))),
                  hn::Gt(hn::Mul(depth, depth),
                         hn::Mul(hn::Set(d, kOppositeDepth * kOppositeDepth * receiver.area * receiver.area),
                                 hn::Max(hn::Set(d, receiver.spacing * receiver.spacing),
                                         hn::Mul(hn::Set(d, 1.0f / 16), row(kArea))))));
      const auto list = [&](LeafSources& side, hn::Mask<Tag> mask) HWY_ATTR {
        const auto column = [i](uint32_t lane) { return static_cast<uint32_t>(i) + lane; };
        side.wide_moment_count = append(mask, column, side.wide_moments.data(), side.wide_moment_count);
      };
      list(scratch.sides[kSame], hn::AndNot(opposite, by_moments));
      list(scratch.sides[kOpposite], hn::And(opposite, by_moments));
      listed = hn::AndNot(by_moments, listed);
    }
    open = append(
        listed, [&](uint32_t lane) { return pack.nodes[i + lane]; }, level.near.data(), open);
  }
  if (any) far.add_to(expansion);
  return open;
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
