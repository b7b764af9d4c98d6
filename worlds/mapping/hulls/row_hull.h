#pragma once
/// Closed meshes of few triangles around the canopy points of plant rows.
///
/// Source: paper A, section 3.2 (Mammarella et al., Biosystems Engineering 223, 2022), after Comba
/// et al., Biosystems Engineering 197 (2020): slices across the row, polygons of c corners, lofted
/// to a low-complexity mesh, split at gaps. The solution is our own (docs/models/row_meshes.md):
/// the sides of all polygons of a row share the same c directions, so that corners match without
/// twist, every side face is plane, and c comparisons decide whether a point is inside. The faces
/// minimise the volume with no more points outside than allowed.
///
/// Cost: linear in the points; all cores. The result has the same bits for any number of them.

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/mesh.h"
#include "worlds/mapping/hulls/hull_chain.h"
#include "worlds/mapping/hulls/hull_fit.h"
#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/rows/row_canopy.h"

namespace vinerow::mapping {

struct RowHullOptions {
  int corners = 8;        ///< of each section, 5 to 16
  double slice_m = 0.14;  ///< initial distance between sections; longer if points are few
  double cell_m = 0.08;   ///< across the row, for dropping sparse cells
  double gap_m = 0.5;     ///< a longer stretch without canopy ends a mesh
  /// Minimum share of a row's points inside or within tolerance_m. Pictures show low leaves badly:
  /// 0.98 would lose more volume at low leaves than noise adds.
  double containment = 0.985;
  double tolerance_m = 0.01;
  double simplify_m = 0.001;  ///< sections that move the surface less than this are left out
  /// Bytes of all rows' meshes as binary PLY without headers, and the same per metre of mesh. More
  /// sections are left out, the least important first, until both are met. 0: no budget.
  double budget_bytes = 0.0;
  double budget_bytes_per_m = 1300.0;

  // Thresholds, all chosen.
  /// Depth of points considered while sections are removed: if the row is wider between two
  /// remaining sections, the straight side between them is that far inside the former one.
  double removal_reach_m = 0.15;
  double straight_m = 0.01;  ///< that a row's line may leave the mesh's between two sections
  double unseen = 0.2;       ///< of the densest side's points per area: a side that was not seen
  // Price of a point in units of area per point: with noise of 1.5 cm it leaves 2 % outside.
  double first_price_m = 0.3, low_price_m = 0.12, high_price_m = 3.0;
  RowSliceThresholds slices = {};
  HullFitOptions fit = {};
};

/// Hulls of one row.
struct RowHulls {
  int row = 0;
  std::vector<HullChain> chains;       ///< along the row's line, in order
  std::vector<TriangleMesh> meshes_W;  ///< one per chain, watertight, outside counter-clockwise
  /// All figures except spacing_m. The volume is that of the meshes.
  MappedRowFigures figures;
  /// Volume of the meshes without the shell between their sides and the mean of the points' scatter
  /// about them: an estimate of the canopy's volume without the bias of noise.
  double canopy_volume_m3 = 0.0;
  double noise_m = 0.0;  ///< 1 sigma of the points across the side faces
  double simplify_error_m = 0;  ///< largest mean movement of the surface by leaving out one section
  std::int64_t dropped = 0;     ///< points in sparse cells, still counted in the containment
  std::int64_t mesh_bytes = 0;  ///< as binary PLY without headers
  std::vector<std::string> notes;  ///< whole sentences for the user
};

/// @param rows    points that are not finite are left out, with a note
/// @param ground  height of the ground in W; called from many threads at once
/// @returns one per row, in order; a row of too few points has no mesh and a note
/// @throws ConfigError if an option is out of range
std::vector<RowHulls> make_row_hulls(std::span<const RowCanopy> rows, const GroundHeight& ground,
                                     const RowHullOptions& options = {});

}  // namespace vinerow::mapping
