#pragma once
/// Organs of grapevines in a stretch of row, in space: shoots, leaves and bunches.
///
/// Frame of the stretch: x along the row from its start, y to the left, z above ground; m. Every
/// random number belongs to a vine, a shoot and a node, whatever the stage: the same plants grow
/// through the season.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "worlds/plants/leaf_mesh.h"
#include "worlds/plants/vine_stage.h"
#include "worlds/plants/vine_variety.h"

namespace vinerow::worlds {

/// Green shoot or brown cane.
struct ShootOrgan {
  std::vector<Eigen::Vector3d> points;  ///< >= 2: its base, its nodes, and the tip unless trimmed
  double radius_m = 0.004;              ///< at its base
  bool is_brown = false;                ///< lignified
};

struct BunchOrgan {
  Eigen::Vector3d stalk;  ///< where it leaves the shoot
  Eigen::Vector3d axis;   ///< unit, from its shoulders to its tip
  double length_m = 0.0;
  int berries = 0;
  double berry_radius_m = 0.0;
  double ripe_share = 0.0;
  bool is_black = true;    ///< when ripe
  std::uint64_t seed = 0;  ///< of its berries
};

struct VineOrgans {
  std::vector<ShootOrgan> shoots;
  std::vector<LeafOrgan> leaves;
  std::vector<BunchOrgan> bunches;
};

enum class Pruning { kGuyot, kCordon, kPergola };

/// Parameters of vines that grow organ by organ.
struct VineGrowth {
  VineVariety variety;
  double bbch = 75.0;
  Pruning pruning = Pruning::kGuyot;
  double shoots_per_m = 12.0;  ///< of row
  double vigour_std = 0.15;    ///< from shoot to shoot
  double young_share = 0.0;    ///< of vines in their second year
};

/// variety_table(), `bbch` to `young_share`.
const ParameterTable<VineGrowth>& growth_table();

/// Space in which shoots are kept by wires and trimming.
struct VineSpace {
  double arm_height_m = 0.75;  ///< of cane or cordon
  double width_m = 0.55;
  double top_m = 2.0;
};

/// Of the wires of a pergola's roof, above the ground.
double roof_height_m(const VineSpace& space);

/// @param length_m  of the stretch; its vines are spread evenly
VineOrgans grow_vines(const VineGrowth& growth, const VineSpace& space, double length_m,
                      int vine_count, std::uint64_t seed, const std::string& name);

}  // namespace vinerow::worlds
