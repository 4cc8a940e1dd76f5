// The sixteen vertices of a leaf: the expansion that came down, near nodes by moments or point by point, the local
// term.
#if defined(DIAPHANE_DIFFUSION_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef DIAPHANE_DIFFUSION_LEAF_INL_H_
#undef DIAPHANE_DIFFUSION_LEAF_INL_H_
#else
#define DIAPHANE_DIFFUSION_LEAF_INL_H_
#endif

#include "diffusion/far_field-inl.h"
#include "diffusion/four.h"

HWY_BEFORE_NAMESPACE();
namespace diaphane::diffusion::HWY_NAMESPACE {

/// A vector of the leaf's vertices, and what has reached them.
struct LeafVector {
  V x, y, z;
  V radiosity[3];
};

HWY_INLINE Displacement displacement(const LeafVector& at, const float* x, const float* y, const float* z) {
  const Tag d;
  Displacement way{hn::Sub(at.x, hn::Set(d, *x)), hn::Sub(at.y, hn::Set(d, *y)), hn::Sub(at.z, hn::Set(d, *z)),
                   hn::Zero(d)};
  way.squared = hn::MulAdd(way.x, way.x, hn::MulAdd(way.y, way.y, hn::Mul(way.z, way.z)));
  return way;
}

/// Adds a node's moments; field f of the node is column[f·stride].
template <bool kColoured>
HWY_INLINE void add_moments(const KernelDomain& domain, const KernelTable& table, const float* column, size_t stride,
                            LeafVector& leaf) {
  const Tag d;
  const auto field = [&](uint32_t f) HWY_ATTR { return hn::Set(d, column[f * stride]); };
  const Displacement way =
      displacement(leaf, column + kFluxX * stride, column + kFluxY * stride, column + kFluxZ * stride);
  const TablePosition at = locate(domain, way.squared);
  const V trace = hn::Set(d, column[kCovXX * stride] + column[kCovYY * stride] + column[kCovZZ * stride]);
  V along = covariance_along(way, field(kCovXX), field(kCovYY), field(kCovZZ), field(kCov2XY), field(kCov2XZ),
                             field(kCov2YZ));
  along = hn::Add(along, along);
  // Factors of f′v⁵ and f″v⁷ next to fv³. f″v⁷ = ½ scale ((f′v⁵)′v − 5f′v⁵): a table less to look up.
  const V second_weight = hn::Mul(hn::Mul(along, hn::Set(d, 0.5f * domain.scale)), hn::Mul(at.inverse2, at.inverse2));
  const V first_weight = hn::NegMulAdd(hn::Set(d, 5.0f), second_weight, hn::Mul(trace, at.inverse2));
  const V slope_weight = hn::Mul(second_weight, at.v);
  for_channels([&](uint32_t c) HWY_ATTR {
    const CubicSlope f1 = cubic_slope(table.coefficient[1][c], at);
    V sum = hn::MulAdd(slope_weight, f1.slope, cubic(table.coefficient[0][c], at));
    sum = hn::Mul(hn::MulAdd(first_weight, f1.value, sum), field(kFluxR + c));
    if constexpr (kColoured) {
      const V dot =
          hn::MulAdd(field(kDipole + 3 * c), way.x,
                     hn::MulAdd(field(kDipole + 3 * c + 1), way.y, hn::Mul(field(kDipole + 3 * c + 2), way.z)));
      sum = hn::NegMulAdd(hn::Mul(hn::Add(dot, dot), at.inverse2), f1.value, sum);
    }
    leaf.radiosity[c] = hn::MulAdd(sum, at.inverse3, leaf.radiosity[c]);
  });
}

HWY_INLINE void add_point(const KernelDomain& domain, const KernelTable& table, const Source& source,
                          LeafVector& leaf) {
  const Tag d;
  const Displacement way = displacement(leaf, &source.position_mm.x, &source.position_mm.y, &source.position_mm.z);
  const TablePosition at = locate(domain, way.squared);
  for_channels([&](int c) HWY_ATTR {
    const V weight = hn::Mul(at.inverse3, hn::Set(d, source.flux_w[c]));
    leaf.radiosity[c] = hn::MulAdd(cubic(table.coefficient[0][c], at), weight, leaf.radiosity[c]);
  });
}

/// value + g·h + ½hᵀHh at the vertices.
HWY_INLINE void add_expansion(const Expansion& expansion, LeafVector& leaf) {
  const Tag d;
  const V x = hn::Sub(leaf.x, hn::Set(d, expansion.centre_mm.x));
  const V y = hn::Sub(leaf.y, hn::Set(d, expansion.centre_mm.y));
  const V z = hn::Sub(leaf.z, hn::Set(d, expansion.centre_mm.z));
  const V half = hn::Set(d, 0.5f);
  for (int c = 0; c < 3; ++c) {
    const auto hessian = [&](int m) HWY_ATTR { return hn::Set(d, expansion.hessian[c][m]); };
    const auto gradient = [&](int a) HWY_ATTR { return hn::Set(d, expansion.gradient[c][a]); };
    const V along_x =
        hn::MulAdd(hn::Mul(half, hessian(0)), x, hn::MulAdd(hessian(3), y, hn::MulAdd(hessian(4), z, gradient(0))));
    const V along_y = hn::MulAdd(hn::Mul(half, hessian(1)), y, hn::MulAdd(hessian(5), z, gradient(1)));
    const V along_z = hn::MulAdd(hn::Mul(half, hessian(2)), z, gradient(2));
    leaf.radiosity[c] =
        hn::Add(leaf.radiosity[c],
                hn::MulAdd(along_x, x, hn::MulAdd(along_y, y, hn::MulAdd(along_z, z, hn::Set(d, expansion.value[c])))));
  }
}

/// Lists those of four siblings that are in `taken`: by moments or vertex by vertex. Always writes, and counts what is
/// taken: a branch for each would be guessed wrong too often.
HWY_INLINE void list_siblings(const float* block, uint32_t first_slot, uint32_t taken, uint32_t by_moments,
                              LeafSources& side) {
  const uint32_t moments = taken & by_moments, fours = taken & ~by_moments;
  const float** moments_to = side.moments.data();
  uint32_t* fours_to = side.fours.data();
  for (uint32_t k = 0; k < 4; ++k) {
    moments_to[side.moment_count] = block + k;
    side.moment_count += moments >> k & 1;
    fours_to[side.four_count] = first_slot + 4 * k;
    side.four_count += fours >> k & 1;
  }
}

/// Sorts the children of the nodes to be opened into moments and points of either side; four siblings at a time.
HWY_INLINE void open_nodes(const GatherInput& input, const Receiver& receiver, const uint32_t* nodes, size_t node_count,
                           GatherScratch& scratch) {
  for (LeafSources& side : scratch.sides) {
    side.moment_count = side.four_count = 0;
    // One more than can be taken: what is not is written there.
    if (side.fours.size() > 4 * node_count) continue;
    side.fours.resize(8 * node_count + 1);
    side.moments.resize(8 * node_count + 1);
  }
  const glm::vec3& facing = receiver.facing;
  const float z2 = input.kernels->smooth_mm() * input.kernels->smooth_mm();
  const float opening2 = input.settings.leaf_opening * input.settings.leaf_opening;
  const float cosine_area = kOppositeCosine * receiver.area;
  const float depth2_area2 = kOppositeDepth * kOppositeDepth * receiver.area * receiver.area;
  const float own_spacing2 = receiver.spacing * receiver.spacing;
  const Four zero{};
  for (size_t i = 0; i < node_count; ++i) {
    const float* block = input.tree->block(1, nodes[i]);
    const auto row = [&](uint32_t field) HWY_ATTR { return load4(block + 4 * field); };
    const uint32_t lit = bits_of(row(kFluxR) + row(kFluxG) + row(kFluxB) > zero);
    const Four dx = row(kCentreX) - receiver.centre_mm.x, dy = row(kCentreY) - receiver.centre_mm.y;
    const Four dz = row(kCentreZ) - receiver.centre_mm.z;
    const Four area = row(kArea), radius = row(kRadius);
    const Four turn = facing.x * row(kFacingX) + facing.y * row(kFacingY) + facing.z * row(kFacingZ);
    const Four depth = facing.x * dx + facing.y * dy + facing.z * dz;
    const Four spacing2 = max4(zero + own_spacing2, 0.25f * area);
    const uint32_t opposite = bits_of((turn < cosine_area * area) & (depth * depth > depth2_area2 * spacing2));
    const Four gap = max4(zero, sqrt4(dx * dx + dy * dy + dz * dz) - receiver.radius);
    const Four gap2 = gap * gap + z2;
    const uint32_t by_moments = bits_of((row(kSpread2) < opening2 * gap2) & (radius * radius < 1.2f * gap2));
    const uint32_t behind = lit & opposite;
    list_siblings(block, 16 * nodes[i], lit & ~opposite, by_moments, scratch.sides[kSame]);
    if (behind != 0) list_siblings(block, 16 * nodes[i], behind, by_moments, scratch.sides[kOpposite]);
  }
}

template <bool kColoured>
HWY_INLINE void add_side(const GatherInput& input, const KernelTable& table, const Pack& pack, const LeafSources& side,
                         LeafVector& into) {
  const KernelDomain domain = input.kernels->domain();
  LeafVector leaf = into;
  for (size_t m = 0; m < side.wide_moment_count; ++m) {
    add_moments<kColoured>(domain, table, pack.rows + side.wide_moments[m], pack.stride, leaf);
  }
  for (size_t m = 0; m < side.moment_count; ++m) add_moments<kColoured>(domain, table, side.moments[m], 4, leaf);
  for (size_t f = 0; f < side.four_count; ++f) {
    const Source* four = &input.tree->sources[side.fours[f]];
    for (int k = 0; k < 4; ++k) add_point(domain, table, four[k], leaf);
  }
  into = leaf;
}

/// The table at a leaf's spacing: a step's own, or a mix of two in `blended`.
HWY_INLINE const KernelTable& blend_tables(const KernelSet& kernels, const SpacingPosition& at, KernelTable& blended) {
  const KernelTable& low = kernels.near_table(at.step);
  const KernelTable& high = kernels.near_table(at.step + 1u);
  if (&low == &high) return low;
  constexpr size_t kFloats = sizeof(KernelTable) / sizeof(float);
  const Tag d;
  const V share = hn::Set(d, at.share);
  const auto* from = reinterpret_cast<const float*>(&low);
  const auto* to = reinterpret_cast<const float*>(&high);
  for (size_t i = 0; i < kFloats; i += hn::Lanes(d)) {
    const V a = hn::Load(d, from + i);
    hn::Store(hn::MulAdd(share, hn::Sub(hn::Load(d, to + i), a), a), d, reinterpret_cast<float*>(&blended) + i);
  }
  return blended;
}

template <bool kColoured>
HWY_INLINE void gather_leaf(const GatherInput& input, uint32_t leaf_node, const Receiver& receiver,
                            const Expansion& expansion, const Pack& pack, const uint32_t* open, size_t open_count,
                            GatherScratch& scratch) {
  const Tag d;
  const SpacingPosition spacing = locate_spacing(input.tree->spacing2_mm2[leaf_node]);
  const KernelTable& table = blend_tables(*input.kernels, spacing, scratch.blended);
  const glm::vec3 local = input.kernels->local_response(spacing);
  open_nodes(input, receiver, open, open_count, scratch);
  alignas(64) float place[3][NodeTree::kLeafSlots];
  alignas(64) float result[3][NodeTree::kLeafSlots];
  const uint32_t first = NodeTree::kLeafSlots * leaf_node;
  for (uint32_t i = 0; i < NodeTree::kLeafSlots; i += 4) {
    const auto row = [&](uint32_t k) HWY_ATTR { return load4(&input.tree->places[first + i + k].position_mm.x); };
    Four rows[4] = {row(0), row(1), row(2), row(3)};
    transpose4(rows[0], rows[1], rows[2], rows[3]);
    for (int a = 0; a < 3; ++a) store4(place[a] + i, rows[a]);
  }
  for (size_t i = 0; i < NodeTree::kLeafSlots; i += hn::Lanes(d)) {
    LeafVector leaf{hn::Load(d, place[0] + i), hn::Load(d, place[1] + i), hn::Load(d, place[2] + i), {}};
    for (V& radiosity : leaf.radiosity) radiosity = hn::Zero(d);
    add_side<kColoured>(input, table, pack, scratch.sides[kSame], leaf);
    // What is left out near a vertex is given back for the surface around it, not for what lies behind.
    add_side<kColoured>(input, input.kernels->far_table(), pack, scratch.sides[kOpposite], leaf);
    add_expansion(expansion, leaf);
    for (int c = 0; c < 3; ++c) hn::Store(leaf.radiosity[c], d, result[c] + i);
  }
  const uint32_t end = std::min(first + NodeTree::kLeafSlots, input.tree->slot_count());
  const Four local4{local.x, local.y, local.z, 0};
  for (uint32_t i = 0; i < NodeTree::kLeafSlots; i += 4) {
    Four rows[4] = {load4(result[0] + i), load4(result[1] + i), load4(result[2] + i), Four{}};
    transpose4(rows[0], rows[1], rows[2], rows[3]);
    for (uint32_t k = 0; k < 4 && first + i + k < end; ++k) {
      const uint32_t slot = first + i + k;
      store3(&input.radiosity[input.vertex_of_slot[slot]].x, rows[k] + local4 * load3(&input.irradiance[slot].x));
    }
  }
}

}  // namespace diaphane::diffusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
