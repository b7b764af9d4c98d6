#pragma once
/// Chain of cross-sections of a row's canopy, and the closed hull of few triangles made from it.
/// Source: papers A, section 3.2, and C, section 2.2 (low-complexity georeferenced maps).

#include <vector>

#include "engine/api/mesh.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Cross-section at s: half widths to both sides at levels between base and top.
struct CanopyCut {
  double s_m = 0.0;     ///< along the row's line
  double base_m = 0.0;  ///< above the ground on the row's line
  double top_m = 0.0;
  std::vector<double> left_m, right_m;  ///< from the row's line, at each level, left + right > 0
};

/// Canopy without a gap: >= 2 cuts, s rising.
using SectionChain = std::vector<CanopyCut>;

/// Shorter stretches of canopy are left out.
inline constexpr double kMinStretch_m = 0.3;

/// Levels between base (0) and top (1), `count` >= 2, spaced as a cosine and so denser near base
/// and top, where the canopy is rounded. With four levels on Parcel F the error is 28 mm rms; with
/// even steps it is 31 mm.
std::vector<double> level_shares(int count);

/// Cut at s by linear interpolation; beyond the ends the end's cut. @pre the chain is not empty
CanopyCut cut_at(const SectionChain& chain, double s_m);

/// Enforces widths and heights of every cut with which the hull does not turn inside out:
/// left + right >= 4 cm, top - base >= 10 cm.
void keep_open(SectionChain& chain);

/// Closed hull in W, outward, 4 triangles per level and section and the two ends.
TriangleMesh make_chain_hull(const SectionChain& chain, const RowCurve& row,
                             const GroundHeight& ground);

}  // namespace vinerow::mapping
