#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/math/angles.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/mapping/model/row_map.h"
#include "worlds/parts/canopy.h"
#include "worlds/parts/foliage.h"
#include "worlds/parts/mesh_store.h"
#include "worlds/parts/primitives.h"
#include "worlds/parts/soil_types.h"
#include "worlds/parts/terrain.h"
#include "worlds/parts/trellis.h"

namespace vinerow::worlds::parts_test {
namespace {

TEST(RowCurve, PositionsByArcLength) {
  const mapping::RowCurve row({{0, 0}, {3, 0}, {3, 4}});
  EXPECT_DOUBLE_EQ(row.length_m(), 7.0);
  EXPECT_EQ(row.point_W(1.0), Eigen::Vector2d(1, 0));
  EXPECT_EQ(row.point_W(5.0), Eigen::Vector2d(3, 2));
  EXPECT_EQ(row.point_W(-1.0), Eigen::Vector2d(-1, 0));
  EXPECT_EQ(row.point_W(8.0), Eigen::Vector2d(3, 5));
  double apart_m = 0.0;
  EXPECT_DOUBLE_EQ(row.nearest_s_m({2, 3}, &apart_m), 6.0);
  EXPECT_DOUBLE_EQ(apart_m, 1.0);
}

TEST(RowCurve, FrameLeansAlongTheRowAndStandsUprightAcross) {
  const auto ground = [](double x, double y) { return 0.5 * x + 0.3 * y; };
  const Pose X_WR = mapping::row_frame(mapping::RowCurve({{0, 0}, {10, 0}}), ground, 4.0);
  EXPECT_TRUE(X_WR.p.isApprox(Eigen::Vector3d(4, 0, 2)));
  EXPECT_TRUE(
      (X_WR.q * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 0, 0.5).normalized(), 1e-9));
  EXPECT_TRUE((X_WR.q * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d(0, 1, 0), 1e-9));
}

TEST(RowMap, OrdersMixedUpRowsAcrossTheBlock) {
  // Three rows to the north, given in disorder and one of them southward.
  std::vector<mapping::RowCurve> rows;
  rows.emplace_back(std::vector<Eigen::Vector2d>{{0, 0}, {0, 10}});
  rows.emplace_back(std::vector<Eigen::Vector2d>{{5, 10}, {5, 0}});
  rows.emplace_back(std::vector<Eigen::Vector2d>{{2.5, 0}, {2.5, 10}});
  const auto ordered = mapping::order_rows(rows);
  ASSERT_EQ(ordered.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(ordered[static_cast<std::size_t>(i)].points_W().front(), Eigen::Vector2d(2.5 * i, 0));
  }
  EXPECT_EQ(mapping::middle_line(ordered[0], ordered[1]),
            (std::vector<Eigen::Vector2d>{{1.25, 0}, {1.25, 10}}));
  const auto boundary = mapping::parcel_boundary(ordered, 8.0, 2.0);
  double area = 0.0;  // shoelace; positive is counter-clockwise
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = boundary[i], &b = boundary[(i + 1) % 4];
    area += 0.5 * (a.x() * b.y() - b.x() * a.y());
  }
  EXPECT_NEAR(area, (10 + 16) * (5 + 4), 1e-9);
}

TEST(Terrain, PlaneHasItsSlopeAndWavesTheirHeight) {
  TerrainShape shape;
  shape.gradient = 0.1 * bearing_direction(rad_from_deg(90.0));
  const TerrainSurface plane(shape, RandomStream(1, "", "t"));
  EXPECT_NEAR(plane.height_m({20, 7}) - plane.height_m({10, 7}), 1.0, 1e-12);
  EXPECT_NEAR(plane.height_m({20, 17}) - plane.height_m({20, 7}), 0.0, 1e-12);
  TerrainShape waves;
  waves.wave_height_m = 2.0;
  const TerrainSurface surface(waves, RandomStream(1, "", "t"));
  double sum = 0.0;
  int count = 0;
  for (double x = -2000; x < 2000; x += 13) {
    for (double y = -2000; y < 2000; y += 13) {
      const double h = surface.height_m({x, y});
      sum += h * h;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(sum / count), 1.0, 0.03);  // rms is half the height
}

TEST(Terrain, ClodsHaveTheirDeviation) {
  const TerrainSurface flat(TerrainShape{}, RandomStream(1, "", "t"));
  const Eigen::AlignedBox2d box(Eigen::Vector2d(0, 0), Eigen::Vector2d(50, 50));
  const HeightField field = make_height_field(flat, box, 0.25, 0.02, RandomStream(1, "", "c"));
  double sum = 0.0;
  for (const float h : field.heights_m) sum += double{h} * h;
  // 40,401 samples: the deviation's own is 0.4 %.
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(field.heights_m.size())), 0.02, 0.0004);
}

TEST(Canopy, ShapeStaysInItsLimits) {
  const CanopyParams params;
  for (int variant = 0; variant < 20; ++variant) {
    const CanopyShape shape(params, 7.2, 8, RandomStream(7, "", std::to_string(variant)));
    for (double u = 0.0; u <= 7.2; u += 0.05) {
      for (double angle = 0.0; angle < 2 * kPi; angle += 0.1) {
        const Eigen::Vector2d p = shape.surface_point(u, angle);
        ASSERT_LT(std::abs(p.x()), 0.5 * params.width_m * 1.5);
        ASSERT_LT(p.y(), params.top_m * 1.15);
        ASSERT_GT(p.y(), params.base_m * 0.8);
      }
    }
  }
}

TEST(Foliage, LeavesStayNearTheHullTheyBelongTo) {
  const CanopyParams params;
  const CanopyShape shape(params, 7.2, 8, RandomStream(7, "", "shape"));
  for (int level = 0; level < 3; ++level) {
    const FoliageDetail detail = vine_foliage_detail(260, level);
    const TriangleMesh leaves = make_vine_foliage(shape, detail, RandomStream(7, "", "leaves"));
    EXPECT_EQ(leaves.triangles.size(),
              2u * static_cast<std::size_t>(std::lround(detail.cards_per_m * 7.2)));
    const Eigen::AlignedBox3d box = leaves.bounds();
    // A card reaches half its length over its centre at most.
    const double reach_m = 0.5 * detail.card_length_m;
    EXPECT_LT(box.max().y(), 0.5 * params.width_m * 1.35 + 1.3 * reach_m) << level;
    EXPECT_LT(box.max().z(), params.top_m * 1.15 + reach_m) << level;
    EXPECT_GT(box.min().z(), params.base_m * 0.85 - reach_m) << level;
    for (const auto& uv : leaves.uvs) {
      ASSERT_TRUE((uv.array() >= 0.0f).all() && (uv.array() <= 1.0f).all());
    }
  }
}

TEST(Foliage, LevelsShowTheSameLeafArea) {
  for (int level = 1; level < 3; ++level) {
    const FoliageDetail near = vine_foliage_detail(260, 0), far = vine_foliage_detail(260, level);
    EXPECT_NEAR(near.cards_per_m * near.card_length_m * near.card_length_m,
                far.cards_per_m * far.card_length_m * far.card_length_m, 1e-9);
  }
}

TEST(Primitives, TubeIsClosedWithTheVolumeOfItsPrism) {
  TriangleMesh mesh;
  const TubePoint points[] = {{{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.1}, {{0, 0, 2}, 0.1}};
  constexpr int kSides = 12;
  append_tube(mesh, points, kSides, Eigen::Vector3f::Ones());
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    volume +=
        a.dot(mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>())) / 6.0;
  }
  // Regular polygon of n sides: n/2 r^2 sin(2 pi / n), times the length.
  EXPECT_NEAR(volume, 2.0 * 0.5 * kSides * 0.01 * std::sin(2 * kPi / kSides), 1e-6);
}

TEST(Trellis, PostsAreSpreadEvenlyAndNotTooFarApart) {
  EXPECT_EQ(spread_posts(0, 10, 5), (std::vector<double>{0, 5, 10}));
  EXPECT_EQ(spread_posts(0, 11, 5).size(), 4u);
  EXPECT_EQ(spread_posts(0, 2, 5), (std::vector<double>{0, 2}));
}

TEST(MeshStore, FilesKeepTheThingsOfAMesh) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("vinerow_mesh_store_" + std::to_string(::getpid()));
  const auto make = [] {
    TriangleMesh mesh;
    for (const double x : {0.0, 1.0, 2.0}) {
      mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
      const std::array<TubePoint, 2> post = {TubePoint{{x, 0.0, 0.0}, 0.1},
                                             TubePoint{{x, 0.0, 1.0}, 0.1}};
      append_tube(mesh, post, 4, {0.5f, 0.5f, 0.5f});
      // A triangle without area, which files leave out.
      mesh.triangles.push_back({0, 0, 1});
    }
    return mesh;
  };
  const TriangleMesh fresh = make();
  const auto written = FileMeshStore(folder).get("posts", make);
  // Another store reads the file.
  const auto read = FileMeshStore(folder).get("posts", [] { return TriangleMesh{}; });
  std::filesystem::remove_all(folder);
  const auto triangles = static_cast<std::uint32_t>(fresh.triangles.size() - 3);
  const std::vector<std::uint32_t> expected = {0, triangles / 3, 2 * triangles / 3};
  EXPECT_EQ(written->triangles.size(), triangles);
  EXPECT_EQ(written->things, expected);
  EXPECT_EQ(read->things, expected);
  EXPECT_EQ(read->triangles, written->triangles);
}

TEST(MeshStore, RefusesAPlantThatWouldTakeAllMemory) {
  const auto mesh_of = [](std::size_t triangles) {
    TriangleMesh mesh;
    mesh.vertices.assign(3, Eigen::Vector3f::Zero());
    mesh.triangles.assign(triangles, {0, 1, 2});
    return mesh;
  };
  MemoryMeshStore store;
  EXPECT_EQ(store.get("most", [&] { return mesh_of(MeshStore::kMostTriangles); })->triangles.size(),
            MeshStore::kMostTriangles);
  EXPECT_EQ(
      test::config_error_of([&] { store.get("bunches/3", [&] { return mesh_of(4'000'000); }); }),
      "'bunches/3' has 4.0 million triangles, must be at most 3.0 million: take fewer organs "
      "(of vines berries, bunches_per_shoot, shoots_per_m, lateral_share; of trees "
      "leaf_area_per_m3, fruits, tree_height_m, row_width_m)");
}

TEST(Soil, KnownByName) {
  for (const std::string& name : soil_names()) {
    const Soil soil = find_soil(name);
    EXPECT_EQ(soil.name, name);
    EXPECT_GE(soil.peak_friction, soil.sliding_friction);
    EXPECT_GT(soil.sliding_friction, soil.rolling_resistance);
  }
  const std::string error = test::config_error_of([] { find_soil("wet_sol"); });
  EXPECT_NE(error.find("soil = 'wet_sol', must be one of: dry_grass"), std::string::npos);
  EXPECT_NE(error.find("did you mean 'wet_soil'?"), std::string::npos);
}

}  // namespace
}  // namespace vinerow::worlds::parts_test
