#include "worlds/plants/vine_organs.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "worlds/plants/leaf_outline.h"
#include "worlds/plants/vine_shoot.h"

namespace vinerow::worlds {
namespace {

using Eigen::Vector3d;

const Vector3d kUp = Vector3d::UnitZ();

// Chosen, where nothing else is stated. The turn of blades was adjusted to the measured midribs and
// to 20 to 40 % of gaps across the row (docs/models/vines.md).
constexpr double kOpenBuds = 0.95;     ///< share of buds that open
constexpr double kYoungVigour = 0.45;  ///< of a vine in its second year
constexpr double kTip_m = 0.02;        ///< beyond the last unfolded leaf
constexpr int kFirstBunch = 2;         ///< the third node (Barbera, growers' catalogue)
constexpr double kTrimmedFrom = 70.0;  ///< stage at which shoots are first trimmed: fruit set
constexpr double kUntrimmed_m = 0.5;   ///< how far free tips reach above the trellis before that
constexpr double kStalk = 0.75;        ///< of a leaf, per length of its blade; 8 cm in HydroShoot
constexpr int kMaxLaterals = 3;        ///< leaves of a node's lateral shoot
constexpr double kLateralArea = 0.35;  ///< of one of them, per area of the main leaf
constexpr double kRoofBelowTop_m = 0.25;  ///< of a pergola's wires

// Linear RGB, chosen.
const Vector3d kYoungLeaf(0.16, 0.26, 0.05), kOldLeaf(0.055, 0.135, 0.032);
const Vector3d kYellowLeaf(0.46, 0.32, 0.035), kRedLeaf(0.3, 0.045, 0.03);

double cut(double normal) {
  return std::clamp(normal, -2.0, 2.0);
}

struct LeafDraws {
  explicit LeafDraws(RandomStream& random) {
    for (double& value : turn) value = cut(random.normal());
    order = random.uniform();
    shade = random.uniform();
  }
  Vector3d turn;
  double order;  ///< in which leaves turn and fall
  double shade;
};

/// Random numbers of a node; all are drawn, whatever grows there.
struct NodeDraws {
  explicit NodeDraws(RandomStream& random)
      : wander_along(cut(random.normal())),
        wander_across(cut(random.normal())),
        azimuth(cut(random.normal())),
        laterals(random.uniform()),
        reach(random.uniform()),
        leaves{LeafDraws(random), LeafDraws(random), LeafDraws(random), LeafDraws(random)},
        bunch_lean_x(cut(random.normal())),
        bunch_lean_y(cut(random.normal())),
        bunch_length(cut(random.normal())),
        berries(random.uniform()),
        bunch_seed(random.next_u64()) {}
  double wander_along, wander_across, azimuth;
  double laterals, reach;
  std::array<LeafDraws, 1 + kMaxLaterals> leaves;  ///< the main one first
  double bunch_lean_x, bunch_lean_y, bunch_length, berries;
  std::uint64_t bunch_seed;
};

/// A node that trimming has left.
struct PlacedNode {
  Vector3d p;
  Vector3d dir;  ///< of the shoot below it
  NodeDraws draws;
};

/// A leaf before its own random turn.
struct LeafPlace {
  Vector3d node;
  Vector3d dir;  ///< of the shoot
  double azimuth;
  double area_m2;
  double droop;     ///< 0: a young leaf that stands up, 1: its blade hangs
  double age;       ///< 0: unfolds, 1: of full size
  double position;  ///< in the trimmed shoot, 0 at its base
};

/// Share of sums 0.45 a + 0.55 b of two uniform numbers that are below x.
double share_below(double x) {
  constexpr double a = 0.45, b = 0.55;
  if (x <= a) return x * x / (2 * a * b);
  if (x <= b) return (x - 0.5 * a) / b;
  return 1.0 - (1.0 - x) * (1.0 - x) / (2 * a * b);
}

/// Where a shoot starts, and the way it takes.
struct ShootStart {
  Vector3d p;
  Vector3d dir;
  double side = 1.0;  ///< of a pergola: +1 left, -1 right
};

class VineGrower {
 public:
  VineGrower(const VineGrowth& growth, const VineSpace& space, std::uint64_t seed, std::string name)
      : growth_(growth),
        space_(space),
        stage_(vine_stage(growth.variety, growth.bbch)),
        seed_(seed),
        name_(std::move(name)) {}

  void grow(double length_m, int vine_count) {
    const bool is_cordon = growth_.pruning == Pruning::kCordon;
    const double spacing_m = length_m / vine_count;
    const double buds_per_vine = growth_.shoots_per_m * spacing_m / kOpenBuds;
    for (int vine = 0; vine < vine_count; ++vine) {
      RandomStream random = stream(fmt::format("vine_{}", vine));
      const bool is_young = random.uniform() < growth_.young_share;
      const double own_vigour = 1.0 + 0.5 * growth_.vigour_std * cut(random.normal());
      // Whole buds whose sum over the vines is right.
      const auto buds = static_cast<int>(std::lround((vine + 1) * buds_per_vine) -
                                         std::lround(vine * buds_per_vine));
      for (int bud = 0; bud < buds; ++bud) {
        // All is drawn, whatever grows, so that each bud has numbers of its own. A cordon's shoots
        // grow in pairs from its spurs.
        const int place = is_cordon ? bud / 2 * 2 : bud;
        const double along_m = (vine + (place + random.uniform(0.25, 0.75)) / buds) * spacing_m;
        const double vigour =
            own_vigour * std::max(0.3, 1.0 + growth_.vigour_std * cut(random.normal()));
        const double lean_along = 0.22 * cut(random.normal());
        const double lean_across = 0.16 * cut(random.normal());
        const bool is_open = random.uniform() < kOpenBuds;
        if (stage_.is_pruned) {
          // Canes are part of the trunks' meshes, as the cordon's arms.
          if (is_cordon && !is_young && bud % 2 == 0) {
            add_spur(along_m, Vector3d(lean_along, lean_across, 1.0), vigour);
          }
          continue;
        }
        if (!is_open || (is_young && bud != buds / 2)) continue;
        grow_shoot_at(start_of(along_m, lean_along, lean_across, bud % 2 == 0 ? 1.0 : -1.0),
                      is_young ? kYoungVigour * vigour : vigour,
                      stream(fmt::format("vine_{}.shoot_{}", vine, bud)));
      }
    }
  }

  VineOrgans organs;

 private:
  ShootStart start_of(double along_m, double lean_along, double lean_across, double side) const {
    ShootStart start;
    start.p = {along_m, 0.0, space_.arm_height_m + 0.02};
    const bool is_pergola = growth_.pruning == Pruning::kPergola;
    start.dir = is_pergola ? Vector3d(lean_along, side, 0.35 + lean_across)
                           : Vector3d(lean_along, lean_across, 1.0);
    start.dir.normalize();
    start.side = side;
    return start;
  }

  RandomStream stream(const std::string& part) const {
    return RandomStream(seed_, "", name_ + "." + part);
  }

  /// Stump of last year's cane, with two buds.
  void add_spur(double along_m, const Vector3d& dir, double vigour) {
    constexpr double kLength_m = 0.055, kRadius_m = 0.0055;
    ShootOrgan spur;
    const Vector3d base(along_m, 0.0, space_.arm_height_m);
    spur.points = {base, base + kLength_m * dir.normalized()};
    spur.radius_m = kRadius_m * std::sqrt(vigour);
    spur.is_brown = true;
    organs.shoots.push_back(std::move(spur));
  }

  void grow_shoot_at(const ShootStart& start, double vigour, RandomStream random) {
    const std::vector<ShootNode> nodes = grow_shoot(growth_.variety, stage_, vigour);
    if (nodes.empty()) return;
    const double plane_rad = 0.5 * kPi + 0.6 * cut(random.normal());  // of its leaves, from x
    const double top_m = space_.top_m + 0.05 * cut(random.normal());
    const double bunch_draw = random.uniform();
    const int bunches = static_cast<int>(growth_.variety.bunches_per_shoot + bunch_draw);
    ShootOrgan shoot;
    shoot.points.push_back(start.p);
    shoot.radius_m =
        0.0045 * std::sqrt(vigour) * std::clamp(shoot_length_m(nodes) / 1.0, 0.35, 1.0);
    shoot.is_brown = stage_.are_shoots_brown;
    Vector3d p = start.p, dir = start.dir;
    const auto count = static_cast<int>(nodes.size());
    std::vector<PlacedNode> placed;
    for (int k = 0; k < count; ++k) {
      const NodeDraws draws(random);
      p += nodes[k].internode_m * dir;
      if (is_beyond(p, top_m)) break;  // trimmed
      shoot.points.push_back(p);
      placed.push_back({p, dir, draws});
      dir = turn(dir, p, start, draws);
    }
    for (int k = 0; k < static_cast<int>(placed.size()); ++k) {
      const double position = (k + 0.5) / static_cast<double>(placed.size());
      add_leaves(nodes[k], k, count, position, placed[k], plane_rad);
      const bool bears = stage_.has_bunches && k >= kFirstBunch && k - kFirstBunch < bunches;
      if (bears) add_bunch(placed[k].p, plane_rad, k, placed[k].draws);
    }
    // The tip, whose leaves are not unfolded yet.
    const bool is_growing = static_cast<int>(shoot.points.size()) == count + 1;
    if (is_growing) shoot.points.push_back(p + kTip_m * dir);
    if (shoot.points.size() >= 2) organs.shoots.push_back(std::move(shoot));
  }

  /// Summer trimming cuts what grows beyond the trellis, from fruit set on.
  bool is_beyond(const Vector3d& p, double top_m) const {
    if (growth_.bbch < kTrimmedFrom) return p.z() > top_m + kUntrimmed_m;
    if (growth_.pruning == Pruning::kPergola) return std::abs(p.y()) > 0.5 * space_.width_m;
    return p.z() > top_m;
  }

  /// Shoots grow up and wander; catch wires hold them near the row's plane, those of a pergola lie
  /// on its roof.
  Vector3d turn(const Vector3d& dir, const Vector3d& p, const ShootStart& start,
                const NodeDraws& draws) const {
    Vector3d next = dir + 0.17 * Vector3d(draws.wander_along, draws.wander_across, 0.0);
    if (growth_.pruning == Pruning::kPergola) {
      const double roof_m = roof_height_m(space_);
      next += Vector3d(0.0, 0.25 * start.side, 0.8 * (roof_m - p.z()) - 0.5 * dir.z());
    } else {
      const double catch_m = 0.22 * space_.width_m;
      const double out_m = std::abs(p.y()) - catch_m;
      next += 0.22 * kUp;
      if (out_m > 0.0) next.y() -= std::copysign(std::min(0.6, 4.0 * out_m), p.y());
      // Free tips bend over.
      if (p.z() > space_.top_m) next.z() -= 1.2 * (p.z() - space_.top_m);
    }
    return next.normalized();
  }

  /// @param count     nodes of the shoot if it were not trimmed
  /// @param position  of the node in the trimmed shoot, 0 to 1
  void add_leaves(const ShootNode& node, int k, int count, double position, const PlacedNode& at,
                  double plane_rad) {
    const NodeDraws& draws = at.draws;
    // Two ranks of leaves on opposite sides of the shoot.
    const double azimuth = plane_rad + (k % 2 == 0 ? 0.0 : kPi) + 0.45 * draws.azimuth;
    const int from_tip = count - 1 - k;
    add_leaf({at.p, at.dir, azimuth, node.leaf_area_m2, from_tip < 4 ? 0.35 : 1.0, node.leaf_age,
              position},
             draws.leaves[0]);
    // Lateral shoots fill up from the eighth leaf below the tip on.
    const double grown = std::clamp((from_tip - 8.0) / 10.0, 0.0, 1.0);
    const double mean = grown * growth_.variety.lateral_share / kLateralArea;
    const int laterals = std::min(kMaxLaterals, static_cast<int>(mean + draws.laterals));
    for (int i = 0; i < laterals; ++i) {
      const double own_azimuth = azimuth + 0.7 + 1.9 * i;
      const double reach_m = 0.03 + 0.03 * i + 0.04 * draws.reach;
      const Vector3d out(std::cos(own_azimuth), std::sin(own_azimuth), 0.5);
      add_leaf({at.p + reach_m * out, at.dir, own_azimuth, kLateralArea * node.leaf_area_m2, 0.8,
                0.8 * node.leaf_age, position},
               draws.leaves[1 + i]);
    }
  }

  void add_leaf(const LeafPlace& place, const LeafDraws& draws) {
    constexpr double kSmallest_m2 = 1e-5;
    // The oldest leaves turn and fall first, with scatter.
    const double order = share_below(0.45 * place.position + 0.55 * draws.order);
    if (order < stage_.fallen_share || place.area_m2 < kSmallest_m2) return;
    LeafOrgan leaf;
    leaf.area_m2 = place.area_m2;
    leaf.node = place.node;
    const double length_m = leaf_length_m(LeafKind::kGrapevine, place.area_m2);
    const Vector3d out(std::cos(place.azimuth), std::sin(place.azimuth), 0.0);
    const Vector3d stalk = (out + 0.55 * place.dir + 0.12 * draws.turn.x() * kUp).normalized();
    leaf.junction = place.node + kStalk * length_m * stalk;
    keep_inside(leaf.junction);
    // Blades face outward and up to the light.
    const Vector3d away = towards_light(leaf.junction, out);
    leaf.normal = (0.42 * away + 0.5 * kUp + 0.5 * draws.turn).normalized();
    Vector3d along = 0.6 * out + 0.2 * place.dir - 1.1 * place.droop * kUp;
    along -= along.dot(leaf.normal) * leaf.normal;
    if (along.norm() < 0.1) along = leaf.normal.unitOrthogonal();
    leaf.along = along.normalized();
    leaf.colour = leaf_colour(place.age, order, draws.shade).cast<float>();
    organs.leaves.push_back(leaf);
  }

  Vector3d towards_light(const Vector3d& p, const Vector3d& out) const {
    if (growth_.pruning == Pruning::kPergola) return kUp;
    const Vector3d side(0.0, std::copysign(1.0, p.y()), 0.0);
    return (0.65 * side + 0.35 * out).normalized();
  }

  /// Trimmed sides.
  void keep_inside(Vector3d& p) const {
    if (growth_.pruning == Pruning::kPergola) return;
    const double half_m = std::max(0.0, 0.5 * space_.width_m - 0.03);
    p.y() = std::clamp(p.y(), -half_m, half_m);
  }

  Vector3d leaf_colour(double age, double order, double draw) const {
    Vector3d colour = (1.0 - age) * kYoungLeaf + age * kOldLeaf;
    if (order < stage_.discoloured_share) {
      // From yellow at the edge of green to the variety's own colour.
      const double turned = std::min(1.0, (stage_.discoloured_share - order) / 0.3);
      const bool is_red = growth_.variety.autumn_colour == LeafColour::kRed;
      colour = (1.0 - turned) * colour + turned * (is_red ? kRedLeaf : kYellowLeaf);
    }
    return (0.8 + 0.4 * draw) * colour;
  }

  void add_bunch(const Vector3d& p, double plane_rad, int k, const NodeDraws& draws) {
    BunchOrgan bunch;
    // Opposite to the leaf of its node.
    const double azimuth = plane_rad + (k % 2 == 0 ? kPi : 0.0);
    const Vector3d out(std::cos(azimuth), std::sin(azimuth), 0.0);
    constexpr double kStalkOfBunch_m = 0.035;
    bunch.stalk = p + kStalkOfBunch_m * out;
    // Inflorescences stand up, bunches hang by their weight.
    const double hang = std::clamp((growth_.bbch - 65.0) / 8.0, -0.6, 1.0);
    bunch.axis =
        (-hang * kUp + 0.25 * out + 0.06 * Vector3d(draws.bunch_lean_x, draws.bunch_lean_y, 0))
            .normalized();
    bunch.length_m =
        stage_.bunch_length * growth_.variety.bunch_length_m * (1.0 + 0.12 * draws.bunch_length);
    bunch.berries = std::max(
        1, static_cast<int>(std::lround(growth_.variety.berries * (0.75 + 0.5 * draws.berries))));
    bunch.berry_radius_m = 0.5 * stage_.berry_diameter * growth_.variety.berry_diameter_m;
    bunch.ripe_share = stage_.ripe_share;
    bunch.is_black = growth_.variety.berry_colour == BerryColour::kBlack;
    bunch.seed = draws.bunch_seed;
    organs.bunches.push_back(bunch);
  }

  const VineGrowth& growth_;
  const VineSpace& space_;
  VineStage stage_;
  std::uint64_t seed_;
  std::string name_;
};

std::string find_fault_in_growth(const VineGrowth& growth) {
  const std::string fault = find_fault_in_bbch(growth.bbch);
  return fault.empty() ? "" : fmt::format("bbch = {:g}: {}", growth.bbch, fault);
}

}  // namespace

const ParameterTable<VineGrowth>& growth_table() {
  using P = VineGrowth;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number(
              "bbch", "", &P::bbch, between(0.0, 99.0),
              "growth stage: 0 winter, 15 five leaves, 65 flowering, 75 berries of pea size, 85 "
              "ripening, 93 leaf fall begins, 97 it ends")
          .choice("pruning", &P::pruning,
                  {{"guyot", Pruning::kGuyot},
                   {"cordon", Pruning::kCordon},
                   {"pergola", Pruning::kPergola}},
                  "shoots from a cane, in pairs from spurs, or under a roof of wires")
          .number("shoots_per_m", "1/m", &P::shoots_per_m, between(1.0, 60.0),
                  "shoots per metre of row")
          .number("vigour_std", "", &P::vigour_std, between(0.0, 0.5),
                  "standard deviation of shoot length and leaf size, as a share")
          .number("young_vine_share", "", &P::young_share, between(0.0, 1.0),
                  "share of vines in their second year")
          .include(&P::variety, variety_table())
          .rule(find_fault_in_growth);
  return table;
}

double roof_height_m(const VineSpace& space) {
  return space.top_m - kRoofBelowTop_m;
}

VineOrgans grow_vines(const VineGrowth& growth, const VineSpace& space, double length_m,
                      int vine_count, std::uint64_t seed, const std::string& name) {
  VineGrower grower(growth, space, seed, name);
  grower.grow(length_m, vine_count);
  return std::move(grower.organs);
}

}  // namespace vinerow::worlds
