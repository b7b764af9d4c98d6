#include "worlds/plants/vine_variety.h"

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::worlds {

const ParameterTable<VineVariety>& variety_table() {
  using P = VineVariety;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("first_leaf_Cd", "C d", &P::first_leaf_Cd, between(0.0, 200.0),
                  "degree days above 10 C from bud burst to the first unfolded leaf")
          .number("preformed_phyllochron_Cd", "C d", &P::preformed_phyllochron_Cd,
                  above(0.0, 100.0), "degree days from leaf to leaf, for the first six")
          .number("phyllochron_Cd", "C d", &P::phyllochron_Cd, above(0.0, 100.0),
                  "degree days from leaf to leaf after them")
          .number("internode_m", "m", &P::internode_m, above(0.0, 0.3),
                  "final length of an internode in the middle of a shoot")
          .number("leaf_area_m2", "m2", &P::leaf_area_m2, above(0.0, 0.1),
                  "final area of a leaf in the middle of a shoot")
          .number("lateral_share", "", &P::lateral_share, between(0.0, 1.0),
                  "leaf area of lateral shoots per area of main leaves, in summer")
          .number("bunches_per_shoot", "", &P::bunches_per_shoot, between(0.0, 4.0),
                  "mean number of bunches")
          .number("bunch_length_m", "m", &P::bunch_length_m, above(0.0, 1.0),
                  "length of a ripe bunch")
          .integer("berries", &P::berries, between(1, 1000), "mean number of a bunch's berries")
          .number("berry_diameter_m", "m", &P::berry_diameter_m, above(0.0, 0.1),
                  "diameter of a ripe berry")
          .choice("berry_colour", &P::berry_colour,
                  {{"black", BerryColour::kBlack}, {"white", BerryColour::kWhite}},
                  "colour of ripe berries")
          .choice("autumn_colour", &P::autumn_colour,
                  {{"yellow", LeafColour::kYellow}, {"red", LeafColour::kRed}},
                  "colour of leaves before they fall");
  return table;
}

double leaf_time_Cd(const VineVariety& variety, double number) {
  constexpr double kPreformed = 6.0;
  return variety.first_leaf_Cd +
         variety.preformed_phyllochron_Cd * (std::min(number, kPreformed) - 1.0) +
         variety.phyllochron_Cd * std::max(0.0, number - kPreformed);
}

}  // namespace vinerow::worlds
