#pragma once
/// Growth stage of apple and olive trees on the BBCH scale (pome fruit: Meier et al.,
/// Nachrichtenbl. Deut. Pflanzenschutzd. 46, 1994; olives: Sanz-Cortes et al., Ann. Appl. Biol.
/// 140, 2002).
///
/// Apples drop their leaves, olives keep most of them for two years and more. Leaves of apples by
/// Forshey et al., HortScience 22, 1987: 10 % of the full leaf area at full bloom, 23 % at petal
/// fall, eight times that of bloom four weeks later. The rest is by the names of the stages, else
/// chosen.

#include <cstdint>

namespace vinerow::worlds {

enum class Crop : std::uint8_t { kApple, kOlive };

struct TreeStage {
  double leaf_area = 1.0;          ///< of leaves unfolded so far, per full leaf area
  double discoloured_share = 0.0;  ///< of the leaves, in autumn
  double fallen_share = 0.0;       ///< of the leaves
  double open_flowers = 0.0;       ///< share of the flowers
  double fruit_diameter = 1.0;     ///< per final diameter
  double ripe_share = 1.0;         ///< from green to the colour of ripe fruit
  bool has_fruit = true;           ///< set and not yet harvested
};

/// Stages 20 to 50 run beside others and are refused. @returns "" or the fault
const char* find_fault_in_tree_bbch(double bbch);

/// @pre find_fault_in_tree_bbch(bbch) is ""
TreeStage tree_stage(Crop crop, double bbch);

}  // namespace vinerow::worlds
