#pragma once
/// A row's canopy as a chain of cross-sections, and the closed hull of few triangles they make.
/// Source: papers A, section 3.2, and C, section 2.2 (low-complexity georeferenced maps).

#include <vector>

#include "engine/api/mesh.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Across the row at s: half widths to both sides at levels between base and top.
struct CanopyCut {
  double s_m = 0.0;     ///< along the row's line
  double base_m = 0.0;  ///< above the ground on the row's line
  double top_m = 0.0;
  std::vector<double> left_m, right_m;  ///< from the row's line, at each level, left + right > 0
};

/// Canopy without a gap: >= 2 cuts, s rising.
using SectionChain = std::vector<CanopyCut>;

/// A stretch of canopy that is shorter is left out.
inline constexpr double kLeastStretch_m = 0.3;

/// Where the levels lie between base (0) and top (1): `count` >= 2, as a cosine, so closer together
/// where the canopy rounds off below and above. On Parcel F with four levels that leaves 28 mm rms
/// to the truth, even steps leave 31 mm.
std::vector<double> level_shares(int count);

/// The cut at s between those of a chain, linear. @pre not empty; the ends' cuts beyond them
CanopyCut cut_at(const SectionChain& chain, double s_m);

/// Keeps widths and heights of every cut large enough for a hull that does not turn inside out:
/// left + right >= 4 cm, top - base >= 10 cm.
void keep_open(SectionChain& chain);

/// Closed hull in W, outward, 4 triangles per level and section and the two ends.
TriangleMesh make_chain_hull(const SectionChain& chain, const RowCurve& row,
                             const GroundHeight& ground);

}  // namespace vinerow::mapping
