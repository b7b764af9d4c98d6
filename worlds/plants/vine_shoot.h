#pragma once
/// Growth of one shoot: its nodes with internodes and leaves, by thermal time.
///
/// Leaf k unfolds at leaf_time_Cd(k) after bud burst. Internode k and leaf k grow to their final
/// sizes along s(x) = x^2 (3 - 2 x), x = (age + head start) / duration: the internode for 130 C d
/// with a head start of 30, the leaf for 280 C d (some 40 days) with a head start of 75, since it
/// has grown in the bud. Both are smaller at the base of a shoot: internode 1 has 0.25 and leaf 1
/// 0.5 of the full size, which node 6 reaches.
/// Sources of the orders of magnitude: Vasconcelos and Castagnoli 2001 (40 days), Louarn et al.,
/// Ann. Bot. 101, 2008 (sizes along the shoot). tests/worlds/plants compares lengths and areas with
/// published ones.

#include <vector>

#include "worlds/plants/vine_stage.h"
#include "worlds/plants/vine_variety.h"

namespace vinerow::worlds {

struct ShootNode {
  double internode_m = 0.0;   ///< below the node
  double leaf_area_m2 = 0.0;  ///< also of a leaf that has fallen
  double leaf_age = 0.0;      ///< 0: unfolds, 1: full size and older
};

constexpr int kMaxShootNodes = 40;

/// Nodes with an unfolded leaf, from the base; without topping.
/// @param vigour  1: as the variety's figures; scales internodes and leaves
std::vector<ShootNode> grow_shoot(const VineVariety& variety, const VineStage& stage,
                                  double vigour);

double shoot_length_m(const std::vector<ShootNode>& nodes);

}  // namespace vinerow::worlds
