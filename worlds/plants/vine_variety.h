#pragma once
/// Figures of a grapevine variety: rate of growth and size of its organs. Sources: the files of
/// assets/vines.

#include <Eigen/Core>
#include <cstdint>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::worlds {

enum class LeafColour : std::uint8_t { kYellow, kRed };
enum class BerryColour : std::uint8_t { kBlack, kWhite };

struct VineVariety {
  double first_leaf_Cd = 20.0;             ///< degree days from bud burst to the first leaf
  double preformed_phyllochron_Cd = 15.0;  ///< from leaf to leaf, for the first six
  double phyllochron_Cd = 22.0;            ///< for those after them
  double internode_m = 0.062;              ///< final length in the middle of a shoot
  double leaf_area_m2 = 0.011;             ///< final area in the middle of a shoot
  double lateral_share = 0.4;  ///< leaf area of lateral shoots per area of main leaves, in summer
  double bunches_per_shoot = 1.1;
  double bunch_length_m = 0.2;
  int berries = 160;  ///< of a bunch
  double berry_diameter_m = 0.015;
  BerryColour berry_colour = BerryColour::kBlack;
  LeafColour autumn_colour = LeafColour::kYellow;
};

/// `first_leaf_Cd` to `autumn_colour`.
const ParameterTable<VineVariety>& variety_table();

/// Degree days from bud burst to the unfolding of main leaf `number`, from 1.
double leaf_time_Cd(const VineVariety& variety, double number);

}  // namespace vinerow::worlds
