/// Areas of patches against sums of triangles, boxes in closed form and a sampled curved row.

#include "vehicles/payloads/canopy_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "engine/api/file_shelf.h"
#include "engine/core/random.h"
#include "tests/support/no_alloc.h"
#include "tests/vehicles/payloads/payload_rig.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::vehicles::canopy_patches_test {
namespace {

using namespace test;
using Eigen::Vector3d;

double canopy_area(const WorldModel& world) {
  double area_m2 = 0.0;
  for (const MeshInstance& instance : world.meshes) {
    if (instance.collides && instance.surface == SurfaceClass::kCanopy) {
      area_m2 += area_of(instance);
    }
  }
  return area_m2;
}

double sum_of(const CanopyPatches& patches) {
  double area_m2 = 0.0;
  for (const CanopyPatch& patch : patches.patches()) area_m2 += patch.area_m2;
  return area_m2;
}

/// A wall of canopy through upright edges, given by bottom and top.
void add_wall(WorldModel& world, const std::vector<std::pair<Vector3d, Vector3d>>& edges_W) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (const auto& [bottom_W, top_W] : edges_W) {
    mesh->vertices.push_back(bottom_W.cast<float>());
    mesh->vertices.push_back(top_W.cast<float>());
  }
  for (std::uint32_t i = 2; i < mesh->vertices.size(); i += 2) {
    mesh->triangles.push_back({i - 2, i - 1, i});
    mesh->triangles.push_back({i - 1, i + 1, i});
  }
  MeshInstance instance;
  instance.mesh = mesh;
  instance.surface = SurfaceClass::kCanopy;
  world.meshes.push_back(instance);
}

/// A bent wall: the strip of height 0.5 to 1.5 m at `radius_m` around the origin, in steps of
/// 1/4 degree, and rows along arcs of 30 and 32.5 m.
WorldModel make_curved_wall(double radius_m) {
  WorldModel world = make_flat_world();
  for (int i = 0; i < 2; ++i) {
    PlantRow row;
    row.id = i;
    for (int k = 0; k <= 60; ++k) {
      const double angle = rad_from_deg(1.0 * k), r = 30.0 + 2.5 * i;
      row.line_W.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
    }
    world.rows->rows.push_back(row);
  }
  std::vector<std::pair<Vector3d, Vector3d>> edges;
  for (int k = 0; k <= 240; ++k) {
    const double angle = rad_from_deg(0.25 * k);
    const Vector3d foot(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0);
    edges.emplace_back(foot + 0.5 * Vector3d::UnitZ(), foot + 1.5 * Vector3d::UnitZ());
  }
  add_wall(world, edges);
  return world;
}

TEST(CanopyPatches, ABoxHasTheAreasOfItsFaces) {
  // 20 m long, 0.5 m wide, 0.5 to 2.0 m high, in two big triangles a face.
  const CanopyPatches patches(make_box_rows({{.y_m = 1.0}}), 0.25, 0.25);
  EXPECT_NEAR(patches.area_m2(), 2.0 * (20.0 * 1.5 + 20.0 * 0.5 + 0.5 * 1.5), 1e-5);
  std::map<int, int> bands;
  for (const CanopyPatch& patch : patches.patches()) {
    EXPECT_EQ(patch.row, 10);
    ++bands[patch.band];
    if (patch.along == 0 || patch.along == 79) continue;
    // A step of wall; in the lowest and the highest band half of the underside or top with it.
    const double expected = 0.0625 + (patch.band == 2 || patch.band == 7 ? 0.0625 : 0.0);
    EXPECT_NEAR(patch.area_m2, expected, 1e-5) << "along " << patch.along << ", " << patch.band;
    EXPECT_NEAR(patch.p_W.x(), 0.25 * (patch.along + 0.5), 1e-5);
    EXPECT_NEAR(patch.p_W.y() - 1.0, patch.side * (expected > 0.1 ? 0.1875 : 0.25), 1e-5);
  }
  // 0.5 to 2.0 m are bands 2 to 7; a step has each on both sides.
  ASSERT_EQ(bands.size(), 6u);
  for (const auto& [band, count] : bands) EXPECT_EQ(count, 160) << "band " << band;
}

TEST(CanopyPatches, AreSortedAndCountedOnce) {
  const CanopyPatches patches(make_box_rows({{.y_m = 0.0}, {.y_m = 2.5}}), 0.4, 0.3);
  const auto key = [](const CanopyPatch& p) {
    return std::make_tuple(p.row, -p.side, p.along, p.band);
  };
  for (std::size_t i = 1; i < patches.patches().size(); ++i) {
    EXPECT_LT(key(patches.patches()[i - 1]), key(patches.patches()[i]));
  }
}

TEST(CanopyPatches, OneCanopyIsCutOnceAndAnotherOneAgain) {
  FileShelf shelf;
  const auto cut = [&](const WorldModel& world, double step_m) {
    return make_canopy_patches(world, step_m, 0.3, &shelf);
  };
  const auto first = cut(make_box_rows({{.y_m = 0.0}}), 0.4);
  EXPECT_EQ(cut(make_box_rows({{.y_m = 0.0}}), 0.4), first) << "the same canopy in another world";
  EXPECT_NE(cut(make_box_rows({{.y_m = 0.0}}), 0.5), first);
  // Other meshes, places, rows and ground.
  EXPECT_NE(cut(make_box_rows({{.y_m = 0.0, .top_m = 1.9}}), 0.4), first);
  WorldModel changed = make_box_rows({{.y_m = 0.0}});
  for (MeshInstance& instance : changed.meshes) instance.X_WM.p.y() += 0.01;
  const auto moved = cut(changed, 0.4);
  changed.rows->rows[0].line_W[0].y() += 0.01;
  const auto turned = cut(changed, 0.4);
  EXPECT_NE(turned, moved);
  changed.terrain->heights_m[0] += 0.1f;
  const auto raised = cut(changed, 0.4);
  EXPECT_NE(raised, turned);
  EXPECT_EQ(cut(changed, 0.4), raised);
  EXPECT_NE(make_canopy_patches(changed, 0.4, 0.3, nullptr), raised);
}

TEST(CanopyPatches, CutsAWallBesideACurvedRowAtItsSteps) {
  const double radius = 30.3;  // 0.3 m to the right of the inner row
  const WorldModel world = make_curved_wall(radius);
  const CanopyPatches patches(world, 0.25, 0.25);
  EXPECT_NEAR(patches.area_m2(), canopy_area(world), 1e-9);
  // A step of 0.25 m along the row's chords is 0.25 * 30.3 / 30 along the wall, less within the
  // kinks of 1 degree every 0.52 m, where the wall goes on and the row does not: by two steps, on
  // average, the wall's share holds.
  std::map<int, double> area_of_step;
  for (const CanopyPatch& patch : patches.patches()) {
    EXPECT_EQ(patch.row, 0);
    EXPECT_EQ(patch.side, -1);
    area_of_step[patch.along] += patch.area_m2;
  }
  double sum = 0.0;
  for (int along = 4; along < 116; ++along) sum += area_of_step[along];
  EXPECT_NEAR(sum, 112 * 0.25 * radius / 30.0, 0.01 * sum);
}

TEST(CanopyPatches, StandAsHighAboveHollowsAndHumps) {
  // Ground in waves of 0.8 m, a row with no points but its ends, and a wall of 1 m that stands
  // 0.5 m above the ground: sheared upright, it keeps its areas.
  WorldModel world = make_flat_world();
  HeightField ground;
  ground.columns = 31, ground.rows = 31;
  ground.corner_W = {-5.0, -15.0};
  for (int j = 0; j < ground.rows; ++j) {
    for (int i = 0; i < ground.columns; ++i) {
      ground.heights_m.push_back(static_cast<float>(0.8 * std::sin((i - 5) / 3.0)));
    }
  }
  world.terrain = ground;
  PlantRow row;
  row.line_W = {{0.0, 0.0, 0.0}, {20.0, 0.0, 0.3}};
  world.rows->rows.push_back(row);
  std::vector<std::pair<Vector3d, Vector3d>> edges;
  for (int k = 0; k <= 20; ++k) {
    const Vector3d foot(k, 0.3, ground.height_m(k, 0.0));
    edges.emplace_back(foot + 0.5 * Vector3d::UnitZ(), foot + 1.5 * Vector3d::UnitZ());
  }
  world.meshes.clear();
  add_wall(world, edges);
  const CanopyPatches patches(world, 0.25, 0.25);
  ASSERT_EQ(patches.patches().size(), 80u * 4u);
  for (const CanopyPatch& patch : patches.patches()) {
    EXPECT_GE(patch.band, 2);
    EXPECT_LE(patch.band, 5);
    EXPECT_NEAR(patch.area_m2, 0.0625, 1e-4) << patch.along << " " << patch.band;
    EXPECT_EQ(patches.find(patch.p_W), static_cast<int>(&patch - patches.patches().data()));
  }
}

/// Areas of single patches of real hulls, against a second way: points spread evenly over every
/// triangle, each sorted by find().
TEST(CanopyPatches, OfHullsHaveTheAreasThatAManyPointsTell) {
  auto parameters = vinerow::test::world_parameters("vineyard");
  parameters.set("row_count", std::int64_t{2});
  parameters.set("row_length_m", 6.0);
  parameters.set("row_bend_deg", 40.0);
  const auto world = vinerow::test::make_world("vineyard", parameters);
  const CanopyPatches patches(*world, 0.25, 0.25);
  ASSERT_GT(patches.patches().size(), 200u);
  std::vector<double> counted(patches.patches().size(), 0.0);
  constexpr int kSide = 40;  // a triangle is cut into 1600
  for (const MeshInstance& instance : world->meshes) {
    if (!instance.collides || instance.surface != SurfaceClass::kCanopy) continue;
    for (const auto& [ia, ib, ic] : instance.mesh->triangles) {
      const auto corner = [&](std::uint32_t i) {
        return Vector3d(instance.X_WM * instance.mesh->vertices[i].cast<double>());
      };
      const Vector3d a = corner(ia), u = corner(ib) - a, v = corner(ic) - a;
      const double area_m2 = 0.5 * u.cross(v).norm() / (kSide * kSide);
      for (int i = 0; i < kSide; ++i) {
        for (int j = 0; i + j < kSide; ++j) {
          const auto count = [&](double third) {
            const int patch = patches.find(a + (i + third) / kSide * u + (j + third) / kSide * v);
            ASSERT_GE(patch, 0);
            counted[static_cast<std::size_t>(patch)] += area_m2;
          };
          count(1.0 / 3.0);
          if (i + j + 1 < kSide) count(2.0 / 3.0);
        }
      }
    }
  }
  double worst = 0.0, off = 0.0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    const double area_m2 = patches.patches()[i].area_m2;
    worst = std::max(worst, std::abs(counted[i] - area_m2) / area_m2);
    off += std::abs(counted[i] - area_m2);
  }
  // The points alone are uncertain by some of the 1600 parts on a border: about half a per cent.
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(off / patches.area_m2(), 0.003);
}

TEST(CanopyPatches, OfAVineyardAddUpToItsTriangles) {
  for (const char* type : {"vineyard", "orchard"}) {
    auto parameters = vinerow::test::world_parameters(type);
    if (std::string(type) == "vineyard") {
      parameters.set("row_count", std::int64_t{4});
      parameters.set("row_length_m", 30.0);
      parameters.set("row_bend_deg", 20.0);
    }
    const auto world = vinerow::test::make_world(type, parameters);
    const double expected = canopy_area(*world);
    ASSERT_GT(expected, 100.0);
    const CanopyPatches patches(*world, 0.25, 0.25);
    EXPECT_NEAR(patches.area_m2(), expected, 1e-9 * expected) << type;
    EXPECT_NEAR(sum_of(patches), expected, 1e-9 * expected) << type;
    for (const CanopyPatch& patch : patches.patches()) EXPECT_GT(patch.area_m2, 0.0);
  }
}

TEST(CanopyPatches, AMeshWithoutRowsHasNone) {
  WorldModel world = make_box_rows({{.y_m = 0.0}});
  world.rows->rows.clear();
  const CanopyPatches patches(world, 0.25, 0.25);
  EXPECT_TRUE(patches.patches().empty());
  EXPECT_EQ(patches.find({1.0, 0.2, 1.0}), -1);
  std::array<PatchShare, 4> shares;
  EXPECT_EQ(patches.spread({1.0, 0.2, 1.0}, shares), 0);
}

TEST(CanopyPatches, SpreadsWithoutMovingTheMiddle) {
  const CanopyPatches patches(make_box_rows({{.y_m = 0.0}}), 0.25, 0.25);
  RandomStream random(5, "", "test");
  const vinerow::test::AllocationCounter counter;
  for (int n = 0; n < 1000; ++n) {
    // On the wall, away from its edges.
    const Vector3d p(random.uniform(1.0, 19.0), 0.25, random.uniform(1.0, 1.5));
    std::array<PatchShare, 4> shares;
    const int count = patches.spread(p, shares);
    ASSERT_GT(count, 0);
    double sum = 0.0;
    Vector3d middle = Vector3d::Zero();
    for (int k = 0; k < count; ++k) {
      const PatchShare& share = shares[static_cast<std::size_t>(k)];
      const CanopyPatch& patch = patches.patches()[static_cast<std::size_t>(share.patch)];
      EXPECT_EQ(patch.side, 1);
      sum += share.share;
      middle += share.share * Vector3d(0.25 * (patch.along + 0.5), 0.25, 0.25 * (patch.band + 0.5));
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_LT((middle - p).norm(), 1e-9);
  }
  EXPECT_EQ(counter.count(), 0u);
}

TEST(CanopyNumbers, AreWeightedByArea) {
  const CanopyPatches patches(make_box_rows({{.y_m = 0.0, .to_x_m = 1.0}}), 0.5, 10.0);
  ASSERT_EQ(patches.patches().size(), 4u);  // two steps on both sides, all alike
  CanopyCoverage coverage = patches.empty_coverage();
  coverage.wanted = 2.0;
  coverage.patches[0].amount = 3.0;
  coverage.patches[1].amount = 1.0;
  const CanopyNumbers all = calc_canopy_numbers(patches, coverage);
  EXPECT_NEAR(all.covered_share, 0.25, 1e-6);
  EXPECT_NEAR(all.mean, 1.0, 1e-6);
  EXPECT_NEAR(all.variation, std::sqrt((9.0 + 1.0) / 4.0 - 1.0), 1e-6);
  coverage.patches[2].amount = coverage.wanted;
  EXPECT_NEAR(calc_canopy_numbers(patches, coverage).covered_share, 0.5, 1e-6)
      << "the wanted amount itself is enough";
  std::vector<std::uint8_t> left(static_cast<std::size_t>(patches.step_count()), 0);
  left[0] = left[1] = 1;
  const CanopyNumbers part = calc_canopy_numbers(patches, coverage, left);
  EXPECT_NEAR(part.covered_share, 0.5, 1e-6);
  EXPECT_NEAR(part.mean, 2.0, 1e-6);
  EXPECT_NEAR(part.variation, 0.5, 1e-6);
}

}  // namespace
}  // namespace vinerow::vehicles::canopy_patches_test
