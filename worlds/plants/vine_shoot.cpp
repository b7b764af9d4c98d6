#include "worlds/plants/vine_shoot.h"

#include <algorithm>

namespace vinerow::worlds {
namespace {

constexpr double kInternodeDuration_Cd = 130.0, kInternodeStart_Cd = 30.0;
constexpr double kLeafDuration_Cd = 280.0, kLeafStart_Cd = 75.0;
constexpr double kFullNode = 6.0;  // from here on organs are of full size

double smooth(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Share of the final size at a node, `first` at the first one.
double size_at(int node, double first) {
  return std::min(1.0, first + (1.0 - first) * (node - 1) / (kFullNode - 1.0));
}

}  // namespace

std::vector<ShootNode> grow_shoot(const VineVariety& variety, const VineStage& stage,
                                  double vigour) {
  std::vector<ShootNode> nodes;
  for (int k = 1; k <= kMaxShootNodes; ++k) {
    const double age_Cd = stage.thermal_time_Cd - leaf_time_Cd(variety, k);
    if (age_Cd < 0.0) break;
    ShootNode node;
    node.internode_m = vigour * variety.internode_m * size_at(k, 0.25) *
                       smooth((age_Cd + kInternodeStart_Cd) / kInternodeDuration_Cd);
    node.leaf_age = std::min(1.0, (age_Cd + kLeafStart_Cd) / kLeafDuration_Cd);
    node.leaf_area_m2 = vigour * variety.leaf_area_m2 * size_at(k, 0.5) * smooth(node.leaf_age);
    nodes.push_back(node);
  }
  return nodes;
}

double shoot_length_m(const std::vector<ShootNode>& nodes) {
  double length_m = 0.0;
  for (const ShootNode& node : nodes) length_m += node.internode_m;
  return length_m;
}

}  // namespace vinerow::worlds
