#pragma once
/// Meshes of a row without leaves: trunks with their arms, posts, wires.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::worlds {

struct TrellisParams {
  bool posts = true;                              ///< false: no posts and wires
  double post_spacing_m = 5.4;                    ///< between posts if the survey lacks them
  double post_height_m = 2.1;                     ///< above ground
  double post_radius_m = 0.03;                    ///< steel, between
  double end_post_radius_m = 0.06;                ///< wood, at the ends
  double end_post_lean_rad = rad_from_deg(12.0);  ///< outward
  double trunk_radius_m = 0.028;
  std::optional<double> arm_height_m;  ///< absent: 0.75 m, of a pergola just below its roof

  /// Of the horizontal arms (cordon) and the first wire.
  double arm_m() const { return arm_height_m.value_or(0.75); }
};

/// `posts`, `post_spacing_m`, `post_height_m`, `end_post_lean_deg`, `trunk_radius_m`,
/// `arm_height_m`.
const ParameterTable<TrellisParams>& trellis_table();

/// Trunks of neighbouring vines in W: a crooked tapering stem to the arm height, and at level 0 two
/// arms along the row.
/// @param level  0 near (5 sides), 1 far (3 sides, no arms)
TriangleMesh make_trunks(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                         const std::vector<double>& vine_s_m, double vine_spacing_m,
                         const TrellisParams& params, int level, RandomStream random);

/// Posts between the ends, in W.
TriangleMesh make_line_posts(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                             const std::vector<double>& post_s_m, const TrellisParams& params);

/// The two leaning end posts, each with the stub of an anchor wire, in W.
/// @param start_m,end_m  arc length of their feet; they lean outward
TriangleMesh make_end_posts(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                            double start_m, double end_m, const TrellisParams& params);

/// Four wires from end to end, in W.
TriangleMesh make_wires(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                        double start_m, double end_m, const TrellisParams& params);

/// Roof of a pergola, half of its width to each side: wires along the row at most 0.5 m apart, and
/// beams across above the posts.
struct RoofParams {
  double height_m = 1.85;  ///< above ground
  double width_m = 2.5;
};
TriangleMesh make_roof_wires(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                             double start_m, double end_m, const TrellisParams& params,
                             const RoofParams& roof);
TriangleMesh make_roof_beams(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                             const std::vector<double>& post_s_m, const RoofParams& roof);

/// Arc lengths of posts: both ends, and evenly between them at most the spacing apart.
std::vector<double> spread_posts(double start_m, double end_m, double spacing_m);

}  // namespace vinerow::worlds
