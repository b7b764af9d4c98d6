/// Growth of vines against published figures: leaf shape, shoots, leaf area, gaps, seasons.
/// Sources: docs/models/vines.md.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "engine/math/angles.h"
#include "worlds/plants/leaf_outline.h"
#include "worlds/plants/vine_meshes.h"
#include "worlds/plants/vine_organs.h"
#include "worlds/plants/vine_shoot.h"

namespace vinerow::worlds::vine_growth_test {
namespace {

constexpr double kLength_m = 36.0;
constexpr int kVines = 40;

VineOrgans grow(const VineGrowth& growth, const VineSpace& space = {}) {
  return grow_vines(growth, space, kLength_m, kVines, 1, "test");
}

VineOrgans grow_at(double bbch) {
  VineGrowth growth;
  growth.bbch = bbch;
  return grow(growth);
}

double leaf_area_m2(const VineOrgans& organs) {
  double area_m2 = 0.0;
  for (const LeafOrgan& leaf : organs.leaves) area_m2 += leaf.area_m2;
  return area_m2;
}

double length_m(const ShootOrgan& shoot) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < shoot.points.size(); ++i) {
    sum_m += (shoot.points[i] - shoot.points[i - 1]).norm();
  }
  return sum_m;
}

double mean_length_m(const VineOrgans& organs) {
  double sum_m = 0.0;
  for (const ShootOrgan& shoot : organs.shoots) sum_m += length_m(shoot);
  return sum_m / static_cast<double>(organs.shoots.size());
}

double mean_leaves(const VineOrgans& organs) {
  // Without the tip.
  double sum = 0.0;
  for (const ShootOrgan& shoot : organs.shoots) sum += static_cast<double>(shoot.points.size()) - 2;
  return sum / static_cast<double>(organs.shoots.size());
}

/// Share of the wall between two heights through which a horizontal view across the row passes,
/// from the blades' triangles drawn on a grid of 5 mm.
double gap_share(const VineOrgans& organs, double low_m, double high_m) {
  constexpr double kCell_m = 0.005, kMargin_m = 0.5;
  const int columns = static_cast<int>((kLength_m - 2 * kMargin_m) / kCell_m);
  const int rows = static_cast<int>((high_m - low_m) / kCell_m);
  std::vector<bool> covered(static_cast<std::size_t>(columns) * rows, false);
  const TriangleMesh mesh = make_leaf_mesh(organs.leaves, 0);
  for (const auto& triangle : mesh.triangles) {
    Eigen::Vector2d p[3];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f& v = mesh.vertices[triangle[k]];
      p[k] = {(v.x() - kMargin_m) / kCell_m, (v.z() - low_m) / kCell_m};
    }
    Eigen::AlignedBox2d box(p[0]);
    box.extend(p[1]).extend(p[2]);
    for (int j = std::max(0, static_cast<int>(box.min().y())); j <= box.max().y() && j < rows;
         ++j) {
      for (int i = std::max(0, static_cast<int>(box.min().x())); i <= box.max().x() && i < columns;
           ++i) {
        const Eigen::Vector2d c(i + 0.5, j + 0.5);
        double side[3];
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector2d along = p[(k + 1) % 3] - p[k], to = c - p[k];
          side[k] = along.x() * to.y() - along.y() * to.x();
        }
        const bool inside = (side[0] >= 0 && side[1] >= 0 && side[2] >= 0) ||
                            (side[0] <= 0 && side[1] <= 0 && side[2] <= 0);
        if (inside) covered[static_cast<std::size_t>(j) * columns + i] = true;
      }
    }
  }
  const auto open = std::count(covered.begin(), covered.end(), false);
  return static_cast<double>(open) / static_cast<double>(covered.size());
}

TEST(VineLeaf, HasTheAreaOfItsLengthAndWidth) {
  // Buttaro et al., Photosynthetica 53, 2015, 1630 leaves of nine varieties, cm:
  // A = -0.465 + 0.914 L W.
  double width = 0.0;
  for (const Eigen::Vector2d& p : leaf_outline(LeafKind::kGrapevine, 0))
    width = std::max(width, 2.0 * p.y());
  for (const double area_cm2 : {40.0, 100.0, 200.0}) {
    const double length_cm = 100.0 * leaf_length_m(LeafKind::kGrapevine, 1e-4 * area_cm2);
    const double published_cm2 = -0.465 + 0.914 * length_cm * width * length_cm;
    EXPECT_NEAR(area_cm2, published_cm2, 0.03 * published_cm2);
  }
}

TEST(VineLeaf, MeshesOfAllLevelsHaveTheLeavesArea) {
  // Seen along its normal, which the fold and the bend of the blade do not change.
  LeafOrgan leaf;
  leaf.node = leaf.junction = {0, 0, 1};  // no stalk
  leaf.along = Eigen::Vector3d::UnitX();
  leaf.normal = Eigen::Vector3d::UnitZ();
  leaf.area_m2 = 0.012;
  for (int level = 0; level < 3; ++level) {
    const std::vector<LeafOrgan> leaves(48, leaf);
    const TriangleMesh mesh = make_leaf_mesh(leaves, level);
    double area_m2 = 0.0;
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3f ab = mesh.vertices[t[1]] - mesh.vertices[t[0]];
      const Eigen::Vector3f ac = mesh.vertices[t[2]] - mesh.vertices[t[0]];
      area_m2 += 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
    }
    EXPECT_NEAR(area_m2, 48 * 0.012, 1e-5 * 48 * 0.012) << level;
  }
}

TEST(VineShoot, GrowsAsPublished) {
  struct Stage {
    double bbch, fewest, most, shortest_m, longest_m;
  };
  // Leaves by the stage's definition, "16-19" visible internodes at flowering (Pratt and Coombe),
  // shoots of 10 cm at five leaves (Coombe's modified stages), 60 to 90 cm at flowering.
  for (const Stage& stage :
       {Stage{11, 1, 1, 0.005, 0.04}, Stage{13, 3, 3, 0.02, 0.06}, Stage{15, 5, 5, 0.06, 0.12},
        Stage{19, 9, 9, 0.2, 0.4}, Stage{65, 16, 19, 0.6, 0.9}}) {
    const VineOrgans organs = grow_at(stage.bbch);
    const double leaves = mean_leaves(organs), mean_m = mean_length_m(organs);
    std::printf("BBCH %g: %.1f leaves on shoots of %.2f m\n", stage.bbch, leaves, mean_m);
    EXPECT_GE(leaves, stage.fewest) << stage.bbch;
    EXPECT_LE(leaves, stage.most) << stage.bbch;
    EXPECT_GE(mean_m, stage.shortest_m) << stage.bbch;
    EXPECT_LE(mean_m, stage.longest_m) << stage.bbch;
  }
}

/// Growth does not run backwards, whatever the variety: from stage to stage the thermal time and
/// with it leaves, their area and shoots never become less.
TEST(VineShoot, NeverShrinksFromStageToStage) {
  std::vector<double> stages;
  for (double bbch = 10.0; bbch <= 19.0; bbch += 0.25) stages.push_back(bbch);
  for (double bbch = 53.0; bbch <= 89.0; bbch += 0.25) stages.push_back(bbch);
  VineVariety variety;
  for (variety.first_leaf_Cd = 0.0; variety.first_leaf_Cd <= 200.0; variety.first_leaf_Cd += 20.0) {
    for (const double preformed_Cd : {0.5, 15.0, 40.0, 100.0}) {
      variety.preformed_phyllochron_Cd = preformed_Cd;
      for (const double later_Cd : {0.5, 10.0, 22.0, 29.0, 33.6, 33.7, 40.0, 60.0, 100.0}) {
        variety.phyllochron_Cd = later_Cd;
        double time_Cd = -1.0, area_m2 = 0.0, length_m = 0.0;
        std::size_t leaves = 0;
        for (const double bbch : stages) {
          const VineStage stage = vine_stage(variety, bbch);
          const std::vector<ShootNode> nodes = grow_shoot(variety, stage, 1.0);
          double area_now_m2 = 0.0;
          for (const ShootNode& node : nodes) area_now_m2 += node.leaf_area_m2;
          ASSERT_GE(stage.thermal_time_Cd, time_Cd) << later_Cd << " " << bbch;
          ASSERT_GE(nodes.size(), leaves) << later_Cd << " " << bbch;
          ASSERT_GE(area_now_m2, area_m2) << later_Cd << " " << bbch;
          ASSERT_GE(shoot_length_m(nodes), length_m) << later_Cd << " " << bbch;
          time_Cd = stage.thermal_time_Cd, area_m2 = area_now_m2;
          leaves = nodes.size(), length_m = shoot_length_m(nodes);
        }
      }
    }
  }
}

TEST(VineShoot, TrainedCabernetHasTheMeasuredLeaves) {
  // assets/vines/cabernet_sauvignon.yaml has the source: 14.0 shoots/m of 1.30 m with 24.0 nodes;
  // leaves of 2280 and 1050 cm2 a shoot, 4.72 m2/m.
  VineGrowth growth;
  growth.bbch = 81;
  growth.shoots_per_m = 14.0;
  growth.variety.lateral_share = 0.46;
  growth.variety.leaf_area_m2 = 0.0107;
  const VineOrgans organs = grow(growth, {0.9, 0.6, 2.2});
  const double shoots_per_m = static_cast<double>(organs.shoots.size()) / kLength_m;
  double nodes = 0.0;
  for (const ShootOrgan& shoot : organs.shoots) {
    nodes += static_cast<double>(shoot.points.size()) - 1;
  }
  nodes /= static_cast<double>(organs.shoots.size());
  std::printf("%.1f shoots/m of %.2f m with %.1f nodes, %.2f m2/m\n", shoots_per_m,
              mean_length_m(organs), nodes, leaf_area_m2(organs) / kLength_m);
  EXPECT_NEAR(shoots_per_m, 14.0, 0.3);
  EXPECT_NEAR(mean_length_m(organs), 1.3, 0.13);
  EXPECT_NEAR(nodes, 24.0, 2.4);
  EXPECT_NEAR(leaf_area_m2(organs) / kLength_m, 4.72, 0.15 * 4.72);
}

TEST(VineCanopy, AreaAndGapsAreThoseOfAGoodCanopy) {
  // Kliewer and Dokoozlian 2005: 2 to 5 m2/m for single canopies. Smart: 20 to 40 % gaps.
  for (const double bbch : {75.0, 81.0}) {
    const VineOrgans organs = grow_at(bbch);
    const double area = leaf_area_m2(organs) / kLength_m;
    const double gaps = gap_share(organs, 0.85, 1.95);
    std::printf("BBCH %g: %.2f m2/m, LAI %.2f at 2.5 m, gaps %.0f %%\n", bbch, area, area / 2.5,
                100 * gaps);
    EXPECT_GE(area, 2.0);
    EXPECT_LE(area, 5.0);
    EXPECT_GE(gaps, 0.2);
    EXPECT_LE(gaps, 0.4);
  }
  EXPECT_LT(leaf_area_m2(grow_at(15)), 0.1 * leaf_area_m2(grow_at(75)));
}

TEST(VineCanopy, BladesHangAsMeasured) {
  // Louarn et al., Ann. Bot. 101, 2008, as in their model's files: midribs 42.6 +- 21.3 deg (Syrah
  // on two wires) and 36.5 +- 17.3 deg (Grenache) below the horizontal.
  const VineOrgans organs = grow_at(75);
  double sum = 0.0, squares = 0.0;
  for (const LeafOrgan& leaf : organs.leaves) {
    const double below_deg = deg_from_rad(std::asin(-leaf.along.z()));
    sum += below_deg, squares += below_deg * below_deg;
    EXPECT_NEAR(leaf.along.norm(), 1.0, 1e-9);
    EXPECT_NEAR(leaf.along.dot(leaf.normal), 0.0, 1e-9);
  }
  const auto count = static_cast<double>(organs.leaves.size());
  const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
  std::printf("midribs %.1f +- %.1f deg below the horizontal\n", mean, deviation);
  EXPECT_GT(mean, 33.0);
  EXPECT_LT(mean, 46.0);
  EXPECT_GT(deviation, 15.0);
  EXPECT_LT(deviation, 25.0);
}

TEST(VineSeason, TheSamePlantsGrowThroughIt) {
  const VineOrgans early = grow_at(75), late = grow_at(79);
  ASSERT_EQ(early.shoots.size(), late.shoots.size());
  for (std::size_t i = 0; i < early.shoots.size(); ++i) {
    EXPECT_EQ(early.shoots[i].points.front(), late.shoots[i].points.front());
  }
  EXPECT_EQ(early.bunches.size(), late.bunches.size());
  // Leaves that were of full size are where they were.
  const auto is_in_late = [&](const LeafOrgan& leaf) {
    return std::any_of(late.leaves.begin(), late.leaves.end(), [&](const LeafOrgan& other) {
      return (other.junction - leaf.junction).norm() < 1e-9 && other.normal == leaf.normal;
    });
  };
  const auto stayed = std::count_if(early.leaves.begin(), early.leaves.end(), is_in_late);
  EXPECT_GT(stayed, static_cast<std::ptrdiff_t>(early.leaves.size()) / 3);
  const VineOrgans again = grow_at(75);
  ASSERT_EQ(early.leaves.size(), again.leaves.size());
  EXPECT_EQ(early.leaves.back().junction, again.leaves.back().junction);
}

TEST(VineSeason, LeavesFallShootsStayAndArePruned) {
  const auto full = static_cast<double>(grow_at(91).leaves.size());
  EXPECT_NEAR(static_cast<double>(grow_at(93).leaves.size()) / full, 0.95, 0.05);
  EXPECT_NEAR(static_cast<double>(grow_at(95).leaves.size()) / full, 0.5, 0.05);
  EXPECT_EQ(grow_at(97).leaves.size(), 0u);
  EXPECT_EQ(grow_at(97).shoots.size(), grow_at(91).shoots.size());
  EXPECT_TRUE(grow_at(97).shoots.front().is_brown);
  for (const double winter : {0.0, 5.0}) {
    EXPECT_TRUE(grow_at(winter).shoots.empty());
    EXPECT_TRUE(grow_at(winter).leaves.empty());
  }
  EXPECT_TRUE(grow_at(91).bunches.empty()) << "harvested";
}

TEST(VineBunch, BerriesGrowAndRipen) {
  // Coombe's modified stages: 2, 4, 7 mm at fruit set, groat and pea size; ripe 14 mm.
  VineGrowth growth;
  growth.variety.berry_diameter_m = 0.014;
  const auto diameter_mm = [&](double bbch) {
    growth.bbch = bbch;
    return 2e3 * grow(growth).bunches.front().berry_radius_m;
  };
  EXPECT_NEAR(diameter_mm(71), 2.0, 0.5);
  EXPECT_NEAR(diameter_mm(73), 4.0, 0.5);
  EXPECT_NEAR(diameter_mm(75), 7.0, 0.5);
  EXPECT_NEAR(diameter_mm(89), 14.0, 0.1);
  EXPECT_EQ(grow_at(79).bunches.front().ripe_share, 0.0);
  EXPECT_NEAR(grow_at(83).bunches.front().ripe_share, 0.5, 0.01);
  EXPECT_EQ(grow_at(89).bunches.front().ripe_share, 1.0);
  // The variety's 1.1 a shoot.
  const VineOrgans organs = grow_at(75);
  EXPECT_NEAR(static_cast<double>(organs.bunches.size()) / organs.shoots.size(), 1.1, 0.1);
  for (const BunchOrgan& bunch : organs.bunches) EXPECT_LT(bunch.axis.z(), 0.0) << "it hangs";
}

TEST(VineBunch, AMeshHasAllBerries) {
  const VineOrgans organs = grow_at(85);
  std::size_t berries = 0;
  for (const BunchOrgan& bunch : organs.bunches) {
    berries += static_cast<std::size_t>(bunch.berries);
  }
  EXPECT_EQ(make_bunch_mesh(organs.bunches, 0).triangles.size(), 20 * berries);
}

TEST(VineTraining, WiresHoldTheShoots) {
  // Between catch wires that are some 0.25 m apart, nodes wander little beyond them.
  std::vector<double> aside_m;
  for (const ShootOrgan& shoot : grow_at(75).shoots) {
    for (const Eigen::Vector3d& p : shoot.points) aside_m.push_back(std::abs(p.y()));
  }
  std::sort(aside_m.begin(), aside_m.end());
  const double p95_m = aside_m[aside_m.size() * 95 / 100];
  std::printf("95 %% of the nodes are within %.2f m of the row's plane\n", p95_m);
  EXPECT_LT(p95_m, 0.2);
}

TEST(VineTraining, LeavesOfTheNarrowestCanopyStayInIt) {
  VineGrowth growth;
  VineSpace space;
  space.width_m = 0.02;
  for (const LeafOrgan& leaf : grow(growth, space).leaves) {
    ASSERT_LE(std::abs(leaf.junction.y()), 0.01);
  }
}

TEST(VineTraining, YoungVinesAreSmallAndPergolasHaveARoof) {
  VineGrowth growth;
  growth.young_share = 1.0;
  EXPECT_LT(leaf_area_m2(grow(growth)), 0.1 * leaf_area_m2(grow_at(75)));

  growth.young_share = 0.0;
  growth.pruning = Pruning::kPergola;
  const VineOrgans pergola = grow(growth, {1.7, 3.0, 2.1});
  double left = 0.0;
  for (const LeafOrgan& leaf : pergola.leaves) {
    EXPECT_GT(leaf.junction.z(), 1.4);
    EXPECT_LT(leaf.junction.z(), 2.4);
    left += leaf.junction.y() > 0.0 ? 1.0 : 0.0;
  }
  EXPECT_NEAR(left / static_cast<double>(pergola.leaves.size()), 0.5, 0.05);

  growth.pruning = Pruning::kCordon;
  EXPECT_NEAR(leaf_area_m2(grow(growth)), leaf_area_m2(grow_at(75)),
              0.15 * leaf_area_m2(grow_at(75)));
}

TEST(VineGrowth, PrunedCordonsHaveSpursWhereTheirShootsGrow) {
  VineGrowth growth;
  growth.pruning = Pruning::kCordon;
  growth.bbch = 0.0;
  const VineOrgans winter = grow(growth);
  EXPECT_TRUE(winter.leaves.empty());
  ASSERT_FALSE(winter.shoots.empty());
  for (const ShootOrgan& spur : winter.shoots) {
    EXPECT_TRUE(spur.is_brown);
    // Two buds of last year's cane: 4 to 8 cm.
    EXPECT_NEAR((spur.points.back() - spur.points.front()).norm(), 0.06, 0.02);
  }
  growth.bbch = 55.0;
  const VineOrgans spring = grow(growth);
  EXPECT_GT(spring.shoots.size(), winter.shoots.size());
  EXPECT_LE(spring.shoots.size(), 2 * winter.shoots.size());
  for (const ShootOrgan& shoot : spring.shoots) {
    double nearest_m = 1e9;
    for (const ShootOrgan& spur : winter.shoots) {
      nearest_m = std::min(nearest_m, std::abs(spur.points[0].x() - shoot.points[0].x()));
    }
    // Half the distance of two buds, 12 shoots to a metre.
    EXPECT_LT(nearest_m, 0.5 / 12.0 + 1e-3);
  }
  // Canes are part of the trunks.
  growth.pruning = Pruning::kGuyot;
  growth.bbch = 0.0;
  EXPECT_TRUE(grow(growth).shoots.empty());
}

}  // namespace
}  // namespace vinerow::worlds::vine_growth_test
