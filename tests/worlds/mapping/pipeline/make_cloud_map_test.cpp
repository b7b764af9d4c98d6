/// From points to a map in one call: what a vehicle gets, and the sentences for clouds that are no
/// vineyard.

#include "worlds/mapping/pipeline/make_cloud_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "engine/core/error.h"
#include "tests/worlds/mapping/photogrammetry/synthetic_parcel.h"
#include "worlds/mapping/grid/virtual_walls.h"

namespace vinerow::mapping::make_cloud_map_test {
namespace {

using test::SyntheticParcel;

SyntheticParcel small_parcel() {
  SyntheticParcel parcel;
  parcel.rows = 5;
  parcel.length_m = 40.0;
  parcel.slope_y = 0.12;
  parcel.density_per_m2 = 600.0;
  parcel.noise_m = 0.01;
  return parcel;
}

std::string refusal(ParcelCloud cloud, const CloudMapOptions& options = {}) {
  try {
    make_cloud_map(cloud, options);
    return "no error";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(MakeCloudMap, GivesAVehicleEverythingThatAWorldWould) {
  const SyntheticParcel parcel = small_parcel();
  ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
  CloudMapOptions options;
  options.occupancy.cell_m = 0.1;
  std::vector<std::string> phases;
  const CloudMap made =
      make_cloud_map(cloud, options, [&](const std::string& name) { phases.push_back(name); });
  EXPECT_EQ(phases, (std::vector<std::string>{"terrain", "rows", "points", "meshes", "grid"}));

  const RowMap& map = made.map;
  ASSERT_EQ(map.rows.size(), 5u);
  ASSERT_EQ(map.alleys.size(), 4u);
  for (const PlantRow& row : map.rows) {
    EXPECT_NEAR((row.line_W.back() - row.line_W.front()).head<2>().norm(), 40.0, 0.3);
    for (const Eigen::Vector3d& p : row.line_W) {
      EXPECT_NEAR(p.z(), parcel.ground_m(p.x(), p.y()), 0.03);
    }
    // The ellipse is 0.6 m wide and reaches from 0.5 m (not seen below 0.72 m) to 2.0 m.
    // An octagon around an ellipse is up to 1 / cos(pi / 8) times as wide.
    EXPECT_GT(row.canopy_width_m, 0.58);
    EXPECT_LT(row.canopy_width_m, 0.6 / std::cos(M_PI / 8.0) + 0.04);
    EXPECT_NEAR(row.canopy_top_m, 2.0, 0.1);
    EXPECT_LT(row.canopy_base_m, 0.9);
  }
  for (const Alley& alley : map.alleys) EXPECT_NEAR(alley.width_m, 2.5, 0.02);
  EXPECT_EQ(map.boundary_W.size(), 4u);
  ASSERT_TRUE(map.terrain);
  EXPECT_NEAR(map.terrain->height_m(parcel.middle_W.x(), parcel.middle_W.y()), parcel.middle_W.z(),
              0.03);
  EXPECT_GT(map.accuracy.surface_std_m, 0.0);
  EXPECT_LT(map.accuracy.surface_std_m, 0.1);

  ASSERT_FALSE(map.occupancy.empty());
  // A row is taken, an alley free, and of every row one end is walled.
  const auto is_occupied = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d cell = (p - map.occupancy.corner_W) / map.occupancy.cell_m;
    return map.occupancy.occupied(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  };
  int walled = 0;
  for (int k = 0; k < 5; ++k) {
    EXPECT_TRUE(is_occupied(parcel.place_W(k, 20.0, 0.0)));
    if (k < 4) {
      EXPECT_FALSE(is_occupied(parcel.place_W(k, 20.0, 1.25)));
    }
    const auto wall_at = [&](double s_m) {
      int hits = 0;
      for (double y_m = -0.2; y_m <= 0.2; y_m += 0.05) {
        hits += is_occupied(parcel.place_W(k, s_m, y_m)) ? 1 : 0;
      }
      return hits > 0;
    };
    EXPECT_NE(wall_at(-2.0), wall_at(42.0)) << "row " << k;
    walled += wall_at(-2.0) || wall_at(42.0) ? 1 : 0;
  }
  EXPECT_EQ(walled, 5);
}

TEST(MakeCloudMap, MeshesAreClosedAndHoldTheCanopy) {
  const SyntheticParcel parcel = small_parcel();
  ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
  const CloudMap made = make_cloud_map(cloud, {});
  ASSERT_EQ(made.map.meshes.size(), 5u);
  double volume_m3 = 0.0;
  for (const RowMesh& mesh : made.map.meshes) {
    // Every edge is used once in each direction.
    std::map<std::pair<int, int>, int> edges;
    double six_volumes = 0.0;
    const Eigen::Vector3d middle = parcel.middle_W;
    for (const auto& t : mesh.mesh_W.triangles) {
      for (int k = 0; k < 3; ++k) {
        ++edges[{static_cast<int>(t[k]), static_cast<int>(t[(k + 1) % 3])}];
      }
      const auto at = [&](int k) -> Eigen::Vector3d {
        return mesh.mesh_W.vertices[static_cast<std::size_t>(t[k])].cast<double>() - middle;
      };
      six_volumes += at(0).dot(at(1).cross(at(2)));
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    EXPECT_GT(six_volumes, 0.0) << "outward";
    volume_m3 += six_volumes / 6.0;
  }
  EXPECT_NEAR(volume_m3, made.report.volume_m3, 1e-3 * volume_m3);
  // The upper part of the ellipse, from where it is seen: 0.5 (1 + cos) of height at 225 degrees.
  const double a = 0.3, b = 0.75, low = -b * std::sin(0.25 * M_PI);
  double area_m2 = 0.0;
  for (double z = low; z < b; z += 1e-4)
    area_m2 += 2.0 * a * std::sqrt(1.0 - z * z / (b * b)) * 1e-4;
  const double truth_m3 = 5 * 40.0 * area_m2;
  EXPECT_NEAR(volume_m3, truth_m3, 0.1 * truth_m3);
  EXPECT_GE(made.report.containment, 0.98);
  EXPECT_LE(made.report.mesh_bytes, 1'300 * 5 * 41);
}

TEST(MakeCloudMap, TellsWhatItFound) {
  SyntheticParcel parcel = small_parcel();
  parcel.angle_deg = 30.0;
  ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
  const CloudMapReport report = make_cloud_map(cloud, {}).report;
  EXPECT_EQ(report.points, static_cast<std::int64_t>(cloud.points.size()));
  EXPECT_EQ(report.ground_points + report.low_points + report.canopy_points + report.other_points,
            report.points);
  EXPECT_NEAR(report.bearing_deg, 60.0, 0.1);
  EXPECT_NEAR(report.spacing_m, 2.5, 0.01);
  EXPECT_LT(report.spacing_std_m, 0.05);
  EXPECT_NEAR(report.noise_m, 0.01, 0.01);
  ASSERT_EQ(report.rows.size(), 5u);
  EXPECT_EQ(report.rows[0].spacing_m > 0.0, true);
  EXPECT_EQ(report.rows[4].spacing_m, 0.0);
  for (const MappedRowFigures& row : report.rows) {
    EXPECT_NEAR(row.bearing_deg, 60.0, 0.1);
    EXPECT_NEAR(row.length_m, 40.0, 0.3);
  }
}

TEST(MakeCloudMap, BudgetIsKept) {
  ParcelCloud cloud = test::make_synthetic_cloud(small_parcel()).cloud;
  CloudMapOptions options;
  options.budget_MB = 0.02;
  const CloudMap made = make_cloud_map(cloud, options);
  EXPECT_LE(made.report.mesh_bytes, 20'000);
  EXPECT_GT(made.report.mesh_bytes, 5'000);
}

TEST(MakeCloudMap, GivesTheSameBitsTwice) {
  ParcelCloud a = test::make_synthetic_cloud(small_parcel()).cloud, b = a;
  const CloudMap one = make_cloud_map(a, {}), two = make_cloud_map(b, {});
  ASSERT_EQ(one.map.meshes.size(), two.map.meshes.size());
  for (std::size_t k = 0; k < one.map.meshes.size(); ++k) {
    EXPECT_EQ(one.map.meshes[k].mesh_W.vertices, two.map.meshes[k].mesh_W.vertices);
    EXPECT_EQ(one.map.meshes[k].mesh_W.triangles, two.map.meshes[k].mesh_W.triangles);
  }
  EXPECT_EQ(one.map.occupancy.cells, two.map.occupancy.cells);
  EXPECT_EQ(a.classes, b.classes);
}

/// Points of another parcel, as if one flight had seen both.
void add_cloud(const ParcelCloud& other, ParcelCloud& cloud) {
  const Eigen::Vector3f shift = (other.origin_W - cloud.origin_W).cast<float>();
  for (const Eigen::Vector3f& p : other.points) cloud.points.push_back(p + shift);
}

/// A crown from 1.5 to 6 m above level ground.
void add_tree(const Eigen::Vector2d& middle_W, double radius_m, double ground_m,
              ParcelCloud& cloud) {
  RandomStream random(11, "", "tree");
  for (int n = 0; n < static_cast<int>(400.0 * M_PI * radius_m * radius_m); ++n) {
    const double turn = random.uniform(0.0, 2.0 * M_PI);
    const double r = radius_m * std::sqrt(random.uniform(0.0, 1.0));
    const Eigen::Vector3d p(middle_W.x() + r * std::cos(turn), middle_W.y() + r * std::sin(turn),
                            ground_m + random.uniform(1.5, 5.9));
    cloud.points.push_back((p - cloud.origin_W).cast<float>());
  }
}

/// The row of a parcel that a mapped one lies on, -1 where it lies on none, and how far its ends
/// are from the true ones.
struct Match {
  int row = -1;
  double end_m = 0.0;
};

Match match(const PlantRow& row, const SyntheticParcel& parcel) {
  const Eigen::Vector2d first = row.line_W.front().head<2>(), last = row.line_W.back().head<2>();
  Match best;
  best.end_m = 1e9;
  for (int k = 0; k < parcel.rows; ++k) {
    const Eigen::Vector2d a = parcel.place_W(k, 0.0, 0.0),
                          b = parcel.place_W(k, parcel.length_m, 0.0);
    const double end_m = std::min(std::max((first - a).norm(), (last - b).norm()),
                                  std::max((first - b).norm(), (last - a).norm()));
    if (end_m < best.end_m) best = {k, end_m};
  }
  if (best.end_m > 0.5 * parcel.spacing_m) best.row = -1;
  return best;
}

/// Every row of the parcel is a row of the block, in order, and nothing else is.
void expect_block(const CloudMap& block, const SyntheticParcel& parcel) {
  ASSERT_EQ(block.map.rows.size(), static_cast<std::size_t>(parcel.rows));
  ASSERT_EQ(block.map.alleys.size(), block.map.rows.size() - 1);
  std::vector<int> rows;
  for (const PlantRow& row : block.map.rows) {
    const Match on = match(row, parcel);
    const Eigen::Vector2d u = (parcel.place_W(0, 1.0, 0.0) - parcel.place_W(0, 0.0, 0.0));
    EXPECT_LT(on.end_m, 0.3) << u.dot(row.line_W.front().head<2>() - parcel.place_W(0, 0.0, 0.0))
                             << " to "
                             << u.dot(row.line_W.back().head<2>() - parcel.place_W(0, 0.0, 0.0));
    EXPECT_EQ(row.id, static_cast<int>(rows.size()));
    rows.push_back(on.row);
  }
  const bool is_rising = rows.front() == 0;
  for (int k = 0; k < parcel.rows; ++k) {
    EXPECT_EQ(rows[static_cast<std::size_t>(k)], is_rising ? k : parcel.rows - 1 - k);
  }
  for (const Alley& alley : block.map.alleys) EXPECT_NEAR(alley.width_m, parcel.spacing_m, 0.02);
}

/// What a flight over several parcels sees: a block, another one behind a track of 7.5 m whose rows
/// run 9 degrees off, a third at right angles to them and a tree at the ends of some rows.
struct Estate {
  SyntheticParcel first, behind, across;
  ParcelCloud cloud;

  Estate() {
    first.rows = 12;
    first.length_m = 60.0;
    first.margin_m = 3.0;
    behind = first;
    behind.seed = 2;
    behind.length_m = 50.0;
    behind.angle_deg = first.angle_deg + 9.0;
    behind.middle_W.head<2>() =
        first.place_W(0, 60.0 + 7.5, 0.5 * 11.0 * first.spacing_m) + 25.0 * along(behind);
    across = first;
    across.seed = 3;
    across.rows = 9;
    across.length_m = 24.0;
    across.spacing_m = 1.8;
    across.angle_deg = first.angle_deg + 85.0;
    across.middle_W.head<2>() = first.place_W(11, 30.0, 10.0 + 12.0);
    cloud = test::make_synthetic_cloud(first).cloud;
    add_cloud(test::make_synthetic_cloud(behind).cloud, cloud);
    add_cloud(test::make_synthetic_cloud(across).cloud, cloud);
    // Its crown begins 0.3 m behind the last vines of rows 4 to 7.
    add_tree(first.place_W(5, -5.3, 0.5 * first.spacing_m), 5.0, first.middle_W.z(), cloud);
  }
  static Eigen::Vector2d along(const SyntheticParcel& parcel) {
    return (parcel.place_W(0, 1.0, 0.0) - parcel.place_W(0, 0.0, 0.0)).normalized();
  }
};

TEST(MakeCloudMap, BlocksOfAnEstateAreMapsOfTheirOwn) {
  Estate estate;
  CloudMapOptions options;
  options.occupancy.cell_m = 0.2;
  const CloudMap made = make_cloud_map(estate.cloud, options);
  ASSERT_EQ(made.blocks.size(), 3u);
  expect_block(made.blocks[0], estate.first);
  expect_block(made.blocks[1], estate.behind);
  expect_block(made.blocks[2], estate.across);

  // The whole has all of them, counted through.
  ASSERT_EQ(made.map.rows.size(), 12u + 12u + 9u);
  ASSERT_EQ(made.map.alleys.size(), 11u + 11u + 8u);
  ASSERT_EQ(made.report.rows.size(), made.map.rows.size());
  double volume_m3 = 0.0;
  std::size_t r = 0;
  for (int b = 0; b < 3; ++b) {
    const CloudMap& block = made.blocks[static_cast<std::size_t>(b)];
    volume_m3 += block.report.volume_m3;
    for (std::size_t k = 0; k < block.map.rows.size(); ++k, ++r) {
      EXPECT_EQ(made.map.rows[r].id, static_cast<int>(r));
      EXPECT_EQ(made.map.rows[r].line_W, block.map.rows[k].line_W);
      EXPECT_EQ(made.report.rows[r].block, b);
      EXPECT_EQ(made.report.rows[r].row, static_cast<int>(r));
      EXPECT_EQ(made.report.rows[r].volume_m3, block.report.rows[k].volume_m3);
    }
    EXPECT_FALSE(block.map.occupancy.empty());
    ASSERT_TRUE(block.map.terrain);
  }
  EXPECT_NEAR(made.report.volume_m3, volume_m3, 1e-9 * volume_m3);
  for (const RowMesh& mesh : made.map.meshes) {
    // Every mesh lies on the row that it is said to be of.
    const PlantRow& row = made.map.rows[static_cast<std::size_t>(mesh.row)];
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector3d& p : row.line_W) points.push_back(p.head<2>());
    double apart_m = 0.0;
    RowCurve(std::move(points))
        .nearest_s_m(mesh.mesh_W.vertices.front().head<2>().cast<double>(), &apart_m);
    EXPECT_LT(apart_m, 1.0);
  }
  // And it says so, and what it has left out: the tree of 79 m2.
  std::string notes;
  for (const std::string& note : made.report.notes) notes += note + "\n";
  EXPECT_NE(notes.find("3 blocks of rows: block 0, 12 rows of 720 m in all, 67.0 deg from north, "
                       "2.50 m apart; block 1, 12 rows of 600 m in all, 58.0 deg"),
            std::string::npos)
      << notes;
  double area_m2 = 0.0;
  const std::size_t at = notes.find("left out: ");
  ASSERT_NE(at, std::string::npos) << notes;
  area_m2 = std::stod(notes.substr(at + 10));
  // Without what lies within reach of the rows' ends.
  EXPECT_GT(area_m2, 55.0) << notes;
  EXPECT_LT(area_m2, M_PI * 25.0 + 5.0) << notes;
}

TEST(MakeCloudMap, ABoundarySaysWhichBlockComesFirst) {
  Estate estate;
  CloudMapOptions options;
  for (const double s_m : {-3.0, 27.0}) {
    options.boundary_W.push_back(estate.across.place_W(0, s_m, -3.0));
  }
  for (const double s_m : {27.0, -3.0}) {
    options.boundary_W.push_back(estate.across.place_W(8, s_m, 3.0));
  }
  const CloudMap made = make_cloud_map(estate.cloud, options);
  ASSERT_EQ(made.blocks.size(), 3u);
  expect_block(made.blocks[0], estate.across);
  EXPECT_EQ(made.blocks[0].map.boundary_W, options.boundary_W);
  EXPECT_NE(made.blocks[1].map.boundary_W, options.boundary_W);
}

TEST(MakeCloudMap, ThinCloudsKeepTheirRowsAndSaySo) {
  for (const double density_per_m2 : {20.0, 31.0, 45.0}) {
    SyntheticParcel parcel;
    parcel.rows = 18;
    parcel.length_m = 80.0;
    parcel.density_per_m2 = density_per_m2;
    parcel.noise_m = 0.03;
    parcel.missing = 0.03;
    ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
    const CloudMap made = make_cloud_map(cloud, {});
    SCOPED_TRACE(density_per_m2);
    EXPECT_TRUE(made.blocks.empty());
    ASSERT_EQ(made.map.rows.size(), 18u);
    // To one vine: its points are some forty, of which half stand high enough.
    for (const PlantRow& row : made.map.rows) EXPECT_LT(match(row, parcel).end_m, parcel.vine_m);
    EXPECT_NEAR(made.report.spacing_m, 2.5, 0.02);
    EXPECT_NEAR(made.report.bearing_deg, 67.0, 0.2);
    const bool is_noted = std::any_of(
        made.report.notes.begin(), made.report.notes.end(),
        [](const auto& note) { return note.find("the cloud is thin") != std::string::npos; });
    EXPECT_TRUE(is_noted);
  }
}

TEST(MakeCloudMap, SaysWhatStandsThereWhereThereAreNoRows) {
  SyntheticParcel parcel = small_parcel();
  parcel.rows = 2;
  ParcelCloud bare = test::make_synthetic_cloud(parcel).cloud;
  std::erase_if(bare.points, [&](const Eigen::Vector3f& p) {
    return p.z() + bare.origin_W.z() >
           parcel.ground_m(p.x() + bare.origin_W.x(), p.y() + bare.origin_W.y()) + 0.3;
  });
  EXPECT_EQ(refusal(bare), "no rows found: nothing is more than 0.55 m above the ground");
  RandomStream random(5, "", "bushes");
  for (int bush = 0; bush < 30; ++bush) {
    const Eigen::Vector2d middle =
        parcel.place_W(0, random.uniform(0.0, 40.0), random.uniform(-6.0, 9.0));
    for (int n = 0; n < 600; ++n) {
      const Eigen::Vector3d p(middle.x() + 0.4 * random.normal(),
                              middle.y() + 0.4 * random.normal(),
                              parcel.ground_m(middle.x(), middle.y()) + random.uniform(0.2, 1.8));
      bare.points.push_back((p - bare.origin_W).cast<float>());
    }
  }
  EXPECT_NE(refusal(bare).find("m2 are higher than"), std::string::npos) << refusal(bare);
  EXPECT_EQ(refusal(bare).find("no rows found: "), 0u) << refusal(bare);
  EXPECT_NE(refusal(bare).find("side by side, 1 to 6 m apart as row_spacing_m says"),
            std::string::npos)
      << refusal(bare);
  EXPECT_EQ(refusal(ParcelCloud{}), "no rows found: the cloud has no points");
}

TEST(MakeCloudMap, SaysHowLongTheLinesAreIfAllAreTooShort) {
  const ParcelCloud cloud = test::make_synthetic_cloud(small_parcel()).cloud;
  CloudMapOptions options;
  options.row_length_low_m = 60.0;
  const std::string text = refusal(cloud, options);
  double longest_m = 0.0, least_m = 0.0;
  ASSERT_EQ(std::sscanf(text.c_str(),
                        "no rows found: the longest line of canopy is %lf m long, "
                        "min_row_length_m is %lf m",
                        &longest_m, &least_m),
            2)
      << text;
  EXPECT_NEAR(longest_m, small_parcel().length_m, 1.0);
  EXPECT_EQ(least_m, 60.0);
}

TEST(MakeCloudMap, SurvivesPointsThatAreNoParcel) {
  ParcelCloud one_spot;
  one_spot.points.assign(10'000, Eigen::Vector3f(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(refusal(one_spot).find("no rows found: "), 0u);
  ParcelCloud three;
  three.points = {{0, 0, 0}, {99, 0, 0}, {0, 100, 50}};
  EXPECT_EQ(refusal(three).find("no rows found: "), 0u);
  ParcelCloud far;
  far.points = {{0, 0, 0}, {1e6f, 0, 0}, {0, 1e6f, 0}};
  EXPECT_EQ(refusal(far),
            "the cloud's 3 points are spread over 1000000 m x 1000000 m, less than one in 4 m2; "
            "remove points that are far off, or cut it into parcels");
  // A point in 4 m2, over more than the terrain's histograms can hold.
  ParcelCloud wide;
  for (int i = 0; i < 1000; ++i) {
    for (int j = 0; j < 1000; ++j) {
      wide.points.emplace_back(2.0f * static_cast<float>(i), 2.0f * static_cast<float>(j), 0.0f);
    }
  }
  CloudMapOptions fine;
  fine.terrain_cell_m = 0.5;
  EXPECT_EQ(refusal(wide, fine),
            "the cloud is 1998 m x 1998 m, too large for a terrain of 0.5 m cells; cut it into "
            "parcels");
}

TEST(MakeCloudMap, RefusesOptionsThatDoNotFit) {
  const ParcelCloud cloud = test::make_synthetic_cloud(small_parcel()).cloud;
  CloudMapOptions options;
  options.spacing_low_m = 3.0;
  options.spacing_high_m = 2.0;
  EXPECT_EQ(refusal(cloud, options), "row_spacing_m = [3, 2], must rise");
  options = {};
  options.terrain_cell_m = 0.0;
  EXPECT_EQ(refusal(cloud, options), "terrain cell = 0, must be > 0");
  options = {};
  options.canopy_cut_m = -1.0;
  EXPECT_EQ(refusal(cloud, options), "canopy cut = -1, must be > 0");
  options = {};
  options.budget_MB = -1.0;
  EXPECT_EQ(refusal(cloud, options), "budget = -1, must be >= 0");
  options = {};
  options.occupancy.cell_m = -0.05;
  EXPECT_EQ(refusal(cloud, options), "grid cell = -0.05, must be >= 0");
  options = {};
  options.corners = 3;
  EXPECT_EQ(refusal(cloud, options), "row meshes: corners = 3, must be 5 to 16");
  options.corners = 8;
  options.occupancy.cell_m = 0.0;
  ParcelCloud points = cloud;
  EXPECT_TRUE(make_cloud_map(points, options).map.occupancy.empty());
}

}  // namespace
}  // namespace vinerow::mapping::make_cloud_map_test
