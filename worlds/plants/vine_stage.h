#pragma once
/// Growth stage of grapevines on the BBCH scale (Lorenz et al., Aust. J. Grape Wine Res. 1, 1995).
///
/// The scale counts leaves (11 to 19) and inflorescences (53 to 57) that grow at the same time. A
/// stage is therefore taken as a time: degree days above 10 C since bud burst (09). Up to 57 it
/// follows from the number of leaves, then from a table with straight lines between its points,
/// which comes later for varieties whose leaves come slowly.
/// Veraison, leaf fall and the growth of berries are shares by stage.

#include "worlds/plants/vine_variety.h"

namespace vinerow::worlds {

struct VineStage {
  double bbch = 75.0;
  double thermal_time_Cd = 0.0;    ///< since bud burst; negative before
  double bunch_length = 0.0;       ///< of inflorescence and bunch, per final length
  double berry_diameter = 0.0;     ///< of flower buds and berries, per final diameter
  double ripe_share = 0.0;         ///< of the berries that have changed colour
  double discoloured_share = 0.0;  ///< of the leaves, in autumn
  double fallen_share = 0.0;       ///< of the leaves
  bool has_bunches = false;        ///< inflorescences and bunches, not yet harvested
  bool are_shoots_brown = false;   ///< lignified
  bool is_pruned = false;          ///< last year's shoots are cut
};

/// The scale's range: grapevines have no stages from 20 to 52. @returns "" or the fault
const char* find_fault_in_bbch(double bbch);

/// @pre find_fault_in_bbch(bbch) is ""
VineStage vine_stage(const VineVariety& variety, double bbch);

}  // namespace vinerow::worlds
