#pragma once
/// Weeds in the strip under the rows: tufts of grass, rosettes like the dandelion's, and upright
/// herbs like fat hen. Cameras and 3D scanners see them; wheels, distances and range sensors do
/// not.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/mesh.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"
#include "worlds/mapping/model/row_curve.h"
#include "worlds/parts/mesh_store.h"

namespace vinerow::worlds {

struct WeedParams {
  double per_m2 = 6.0;         ///< plants on the strip
  double height_m = 0.15;      ///< of a mean upright plant; single ones 0.4 to 1.6 times as high
  double strip_width_m = 0.8;  ///< about the row's line
};

/// `per_m2`, `height_m`, `strip_width_m`.
const ParameterTable<WeedParams>& weed_table();
/// What the group `weeds` of a world is.
constexpr const char* kWeedsText =
    "weeds under the rows, for cameras and 3D scanners; absent: a bare strip";

struct Weed {
  Eigen::Vector3d root_W;
  double height_m;     ///< if it grows upright; blades and leaves of others are about as long
  std::uint64_t seed;  ///< of its kind and shape
};

/// Weeds of a stretch of row, their places independent of each other.
/// @param start_m,end_m  arc lengths
std::vector<Weed> place_weeds(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                              double start_m, double end_m, const WeedParams& params,
                              RandomStream random);

/// In W; each weed is one of the mesh's things at level 0.
/// @param level  0 near, 1, 2 far: fewer and larger leaves with the same area
TriangleMesh make_weed_mesh(std::span<const Weed> weeds, int level);

/// @throws ConfigError if there are more than a computer holds
void check_weeds(std::span<const mapping::RowCurve> rows, const WeedParams& params);

/// Appends the weeds of all rows: "weeds/row_03/chunk_07#lod0" to "#lod2".
void plant_weeds(WorldModel& world, std::span<const mapping::RowCurve> rows,
                 const mapping::GroundHeight& ground, const WeedParams& params, std::uint64_t seed,
                 MeshStore& store);

}  // namespace vinerow::worlds
