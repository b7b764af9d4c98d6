/// The map row_mesh: its errors come out as stated.

#include "engine/api/world_model.h"
#include "worlds/mapping/from_truth/row_mesh_map.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <chrono>
#include <cmath>

#include "engine/core/log.h"
#include "engine/math/angles.h"
#include "tests/worlds/mapping/map_fixture.h"
#include "worlds/mapping/from_truth/chain_errors.h"

namespace vinerow::mapping::row_mesh_map_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Numbers = std::vector<double>;

std::unique_ptr<RowMap> make(const ParameterSet& parameters, RowMeshReport* report = nullptr,
                             const std::string& world = "vineyard", std::uint64_t seed = 1) {
  return make_row_mesh_map(parameters, test::surveyed_world(world).context(seed), report);
}

std::string error_of(const ParameterSet& parameters) {
  return test::config_error_of([&] { make(parameters); });
}

ParameterSet parameters() {
  return test::map_parameters("row_mesh");
}

/// Largest distance of a vertex from where `move` puts the other map's.
template <class Move>
double worst_vertex_m(const RowMap& moved, const RowMap& map, Move&& move) {
  EXPECT_EQ(moved.meshes.size(), map.meshes.size());
  double worst_m = 0.0;
  for (std::size_t k = 0; k < map.meshes.size(); ++k) {
    const auto &a = moved.meshes[k].mesh_W.vertices, &b = map.meshes[k].mesh_W.vertices;
    EXPECT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
      worst_m =
          std::max(worst_m, (a[i].cast<double>() - move(Vector3d(b[i].cast<double>()))).norm());
    }
  }
  return worst_m;
}

/// Along a row's line from its first point.
double along_m(const PlantRow& row, const Vector3d& p) {
  const Vector2d a = row.line_W.front().head<2>();
  return (p.head<2>() - a).dot((row.line_W.back().head<2>() - a).normalized());
}

/// Ranges of a row's meshes along it, in order.
std::vector<std::pair<double, double>> ranges_of(const RowMap& map, int id) {
  std::vector<std::pair<double, double>> ranges;
  for (const RowMesh& mesh : map.meshes) {
    if (mesh.row != id) continue;
    double low = 1e300, high = -1e300;
    for (const auto& v : mesh.mesh_W.vertices) {
      const double s = along_m(map.rows[static_cast<std::size_t>(id)], v.cast<double>());
      low = std::min(low, s), high = std::max(high, s);
    }
    ranges.emplace_back(low, high);
  }
  std::sort(ranges.begin(), ranges.end());
  return ranges;
}

TEST(RowMeshMap, ParcelFTakesFewTrianglesAndSeconds) {
  ParameterSet world_parameters = test::world_parameters("vineyard");
  world_parameters.set("leaf_cards_per_m", 10.0).set("occupancy_cell_m", 0.2);
  test::SurveyedWorld world;
  world.model = test::make_world("vineyard", world_parameters);
  world.physics = std::make_unique<physics::PhysicsWorld>(physics::PhysicsSettings{}, *world.model);
  for (const std::int64_t levels : {3, 4, 6, 8}) {
    ParameterSet options = parameters();
    options.set("levels", levels);
    RowMeshReport report;
    const auto start = std::chrono::steady_clock::now();
    make_row_mesh_map(options, world.context(), &report);
    const double took_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_TRUE(report.unseen_rows.empty());
    EXPECT_LT(std::abs(report.accuracy.mean_m), 0.01);
    EXPECT_LT(report.accuracy.rms_m, 0.045);
    EXPECT_LT(report.triangles, report.true_triangles / 7);
    std::printf(
        "Parcel F, %d levels: %ld triangles, %.1f %% of %ld; surface %.4f m rms, mean %+.4f "
        "m, correlation %.2f m, %.1f %% of points without canopy; %.2f s\n",
        static_cast<int>(levels), report.triangles,
        100.0 * static_cast<double>(report.triangles) / static_cast<double>(report.true_triangles),
        report.true_triangles, report.accuracy.rms_m, report.accuracy.mean_m,
        report.accuracy.correlation_length_m,
        100.0 * static_cast<double>(report.accuracy.far_points) /
            static_cast<double>(report.accuracy.far_points + report.accuracy.points),
        took_s);
  }
}

TEST(RowMeshMap, OffsetComesBackFromTheCanopy) {
  const Vector3d offset(0.06, -0.05, 0.04);
  ParameterSet options = parameters();
  const auto map = make(options);
  options.set("offset_m", Numbers{offset.x(), offset.y(), offset.z()});
  RowMeshReport report;
  const auto moved = make(options, &report);
  EXPECT_EQ(report.shift_m, offset);
  EXPECT_EQ(moved->accuracy.offset_std_m, Vector3d(0, 0, 0)) << "a blunder is not stated";
  EXPECT_EQ(moved->accuracy.surface_std_m, map->accuracy.surface_std_m);
  EXPECT_LT(worst_vertex_m(*moved, *map, [&](const Vector3d& p) { return Vector3d(p + offset); }),
            2e-5);
  EXPECT_LT((moved->rows[2].line_W[0] - map->rows[2].line_W[0] - offset).norm(), 1e-12);
  EXPECT_LT((moved->alleys[1].line_W[0] - map->alleys[1].line_W[0] - offset).norm(), 1e-12);
  EXPECT_LT((moved->occupancy.corner_W - map->occupancy.corner_W - offset.head<2>()).norm(), 1e-12);

  // From the truth alone: points of the moved map and how far the canopy is from them give the
  // shift across the row and up in one step of least squares.
  const auto& world = test::surveyed_world("vineyard");
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (const auto& sample :
       test::sample_surface(world, *moved, 40'000, RandomStream(6, "", "samples"))) {
    A += sample.normal_W * sample.normal_W.transpose();
    b -= sample.normal_W * sample.error_m;
  }
  const Vector3d found = A.ldlt().solve(b);
  const Vector3d ahead = (map->rows[0].line_W.back() - map->rows[0].line_W.front()).normalized();
  const Vector3d left = Vector3d::UnitZ().cross(ahead).normalized();
  std::printf("shift across %.4f of %.4f m, off the ground %.4f of %.4f m\n", left.dot(found),
              left.dot(offset), ahead.cross(left).dot(found), ahead.cross(left).dot(offset));
  EXPECT_NEAR(left.dot(found), left.dot(offset), 0.01);
  EXPECT_NEAR(ahead.cross(left).dot(found), ahead.cross(left).dot(offset), 0.01);

  options.set("move_rows", false);
  const auto rows_true = make(options);
  EXPECT_EQ(rows_true->rows[2].line_W[0], map->rows[2].line_W[0]);
  EXPECT_EQ(rows_true->meshes[3].mesh_W.vertices, moved->meshes[3].mesh_W.vertices);
}

TEST(RowMeshMap, OffsetsThatAreDrawnSpreadAsStated) {
  ParameterSet options = parameters();
  options.set("offset_std_m", Numbers{0.1, 0.2, 0.05});
  options.set("section_spacing_m", Numbers{5, 5}).set("levels", std::int64_t{2});
  Vector3d squares = Vector3d::Zero();
  constexpr int kMaps = 60;
  for (int k = 0; k < kMaps; ++k) {
    RowMeshReport report;
    const auto map = make(options, &report, "orchard", static_cast<std::uint64_t>(k));
    EXPECT_EQ(map->accuracy.offset_std_m, Vector3d(0.1, 0.2, 0.05));
    squares += report.shift_m.cwiseProduct(report.shift_m) / kMaps;
  }
  // 99.9 % of chi-square with 60 degrees of freedom: 0.51 to 1.66 of the mean.
  const Vector3d ratio = squares.cwiseQuotient(Vector3d(0.01, 0.04, 0.0025));
  EXPECT_GT(ratio.minCoeff(), 0.51);
  EXPECT_LT(ratio.maxCoeff(), 1.66);
}

TEST(RowMeshMap, TurnsAndScalesAboutTheMiddleOfItsRows) {
  ParameterSet options = parameters();
  const auto map = make(options);
  options.set("scale", 1.002).set("rotation_deg", 0.3);
  const auto moved = make(options);
  Eigen::AlignedBox3d box;
  for (const PlantRow& row : map->rows) {
    for (const Vector3d& p : row.line_W) box.extend(p);
  }
  const double c = std::cos(rad_from_deg(0.3)), s = std::sin(rad_from_deg(0.3));
  const auto expected = [&](const Vector3d& p) {
    const Vector3d d = p - box.center();
    return Vector3d(box.center() +
                    1.002 * Vector3d(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z()));
  };
  EXPECT_LT(worst_vertex_m(*moved, *map, expected), 2e-5);
  EXPECT_LT((moved->rows[3].line_W[1] - expected(map->rows[3].line_W[1])).norm(), 1e-9);
  EXPECT_NEAR(moved->alleys[0].width_m, 1.002 * map->alleys[0].width_m, 1e-12);
  // The grid is turned with them: free in the middle of alleys, taken on the rows.
  const auto taken = [&](const Vector3d& p) {
    const Vector2d cell = (p.head<2>() - moved->occupancy.corner_W) / moved->occupancy.cell_m;
    return moved->occupancy.occupied(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  };
  for (int k = 1; k < 100; ++k) {
    const auto on = [&](const std::vector<Vector3d>& line) {
      return Vector3d(line.front() + k / 100.0 * (line.back() - line.front()));
    };
    EXPECT_FALSE(taken(on(moved->alleys[1].line_W)));
    EXPECT_TRUE(taken(on(moved->rows[1].line_W)));
  }
}

TEST(RowMeshMap, MissingStretchesHaveNoFacets) {
  ParameterSet options = parameters();
  std::vector<ParameterSet> gaps;
  gaps.push_back(options.make_group("missing"));
  gaps.back().set("row", std::int64_t{1}).set("from_m", 10.0).set("to_m", 13.5);
  gaps.push_back(options.make_group("missing"));
  gaps.back().set("row", std::int64_t{3}).set("from_m", -5.0).set("to_m", 6.0);
  options.set("missing", gaps);
  const auto map = make(options);
  const auto whole = make(parameters());
  const auto row1 = ranges_of(*map, 1), row3 = ranges_of(*map, 3);
  for (const auto& [low, high] : row1) EXPECT_TRUE(high < 10.001 || low > 13.499);
  for (const auto& [low, high] : row3) EXPECT_GT(low, 5.999);
  EXPECT_GE(row1.size(), ranges_of(*whole, 1).size());
  EXPECT_EQ(ranges_of(*map, 0), ranges_of(*whole, 0)) << "other rows stay";
  for (const RowMesh& mesh : map->meshes) EXPECT_GT(test::closed_volume_m3(mesh.mesh_W), 0.0);
  // Elsewhere it is the same surface: the gap took its own length and nothing else.
  const auto length = [](const auto& ranges) {
    double sum = 0.0;
    for (const auto& [low, high] : ranges) sum += high - low;
    return sum;
  };
  double cut_m = 0.0;
  for (const auto& [low, high] : ranges_of(*whole, 1)) {
    cut_m += std::max(0.0, std::min(high, 13.5) - std::max(low, 10.0));
  }
  EXPECT_NEAR(length(ranges_of(*whole, 1)) - length(row1), cut_m, 0.31);
}

TEST(RowMeshMap, GapsThatAreDrawnLieInCanopyAndAreReported) {
  ParameterSet options = parameters();
  ParameterSet group = options.make_group("random_missing");
  group.set("count", std::int64_t{6}).set("length_m", 1.2);
  options.set("random_missing", std::vector<ParameterSet>{group});
  RowMeshReport report, other;
  const auto map = make(options, &report);
  const auto whole = make(parameters());
  make(options, &other, "vineyard", 2);
  ASSERT_EQ(report.missing.size(), 6u);
  EXPECT_NE(report.missing[0].from_m, other.missing[0].from_m);
  for (const auto& gap : report.missing) {
    EXPECT_NEAR(gap.to_m - gap.from_m, 1.2, 1e-9);
    for (const auto& [low, high] : ranges_of(*map, gap.row)) {
      EXPECT_TRUE(high < gap.from_m + 1e-3 || low > gap.to_m - 1e-3);
    }
    bool inside = false;
    for (const auto& [low, high] : ranges_of(*whole, gap.row)) {
      inside = inside || (low < gap.from_m + 1e-3 && high > gap.to_m - 1e-3);
    }
    EXPECT_TRUE(inside);
  }
}

TEST(RowMeshMap, AnOldSurveyHasNoGaps) {
  ParameterSet options = parameters();
  RowMeshReport before, after;
  const auto whole = make(options, &before);
  options.set("fill_gaps", true);
  const auto filled = make(options, &after);
  std::size_t gaps = 0;
  for (int row = 0; row < 4; ++row) {
    const auto ranges = ranges_of(*filled, row), old = ranges_of(*whole, row);
    ASSERT_EQ(ranges.size(), 1u);
    EXPECT_NEAR(ranges[0].first, old.front().first, 1e-3);
    EXPECT_NEAR(ranges[0].second, old.back().second, 1e-3);
    gaps += old.size() - 1;
  }
  ASSERT_GT(gaps, 2u) << "the test needs a world with gaps";
  EXPECT_GT(after.accuracy.far_points, 3 * before.accuracy.far_points + 100);
  // What was made up counts for nothing in what the map says of itself.
  EXPECT_LT(after.accuracy.rms_m, 1.3 * before.accuracy.rms_m);
}

TEST(RowMeshMap, SurfaceNoiseIsOfItsSizeAndLengthAndIsStated) {
  // A chain with close sections and levels, so that the process itself shows.
  SectionChain chain;
  for (int k = 0; k < 20'000; ++k) {
    chain.push_back({0.1 * k, 0.5, 2.0, Numbers(4, 1.0), Numbers(4, 1.0)});
  }
  RandomStream random(7, "", "noise");
  add_surface_noise(chain, 0.05, 0.3, random);
  double square = 0.0, next = 0.0, level = 0.0, sides = 0.0;
  const auto count = static_cast<double>(chain.size());
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const double e = chain[i].left_m[1] - 1.0;
    square += e * e / count;
    level += e * (chain[i].left_m[2] - 1.0) / count;
    sides += e * (chain[i].right_m[1] - 1.0) / count;
    if (i + 3 < chain.size()) next += e * (chain[i + 3].left_m[1] - 1.0) / count;
  }
  // Levels lie at 0, 1/4, 3/4, 1 of 1.5 m. Independent values every 2 l, so some 3300: 1 sigma of a
  // variance is 2.5 %.
  EXPECT_NEAR(square, 0.0025, 0.0025 * 0.1);
  EXPECT_NEAR(next / square, std::exp(-1.0), 0.08);
  EXPECT_NEAR(level / square, std::exp(-0.75 / 0.3), 0.08);
  EXPECT_NEAR(sides / square, 0.0, 0.08);

  ParameterSet options = parameters();
  const auto smooth = make(options);
  options.set("surface_noise_std_m", 0.1);
  const auto rough = make(options);
  const auto samples = test::sample_surface(test::surveyed_world("vineyard"), *rough, 20'000,
                                            RandomStream(8, "", "samples"));
  const double sampled_m = test::rms_of(samples);
  EXPECT_NEAR(rough->accuracy.surface_std_m, sampled_m, 0.2 * sampled_m);
  EXPECT_GT(rough->accuracy.surface_std_m, 1.3 * smooth->accuracy.surface_std_m);
  EXPECT_GT(rough->accuracy.correlation_length_m, smooth->accuracy.correlation_length_m);
  for (const RowMesh& mesh : rough->meshes) EXPECT_GT(test::closed_volume_m3(mesh.mesh_W), 0.0);
  std::printf("noise 0.1 m: stated %.4f m over %.2f m, sampled %.4f m; without %.4f m\n",
              rough->accuracy.surface_std_m, rough->accuracy.correlation_length_m, sampled_m,
              smooth->accuracy.surface_std_m);
}

TEST(RowMeshMap, StatesWhatTheUserSays) {
  ParameterSet options = parameters();
  options.set("stated_surface_std_m", 0.5).set("stated_correlation_length_m", 2.0);
  const auto map = make(options);
  EXPECT_EQ(map->accuracy.surface_std_m, 0.5);
  EXPECT_EQ(map->accuracy.correlation_length_m, 2.0);
}

TEST(RowMeshMap, VehiclesThatNameTheSameSurveyHaveTheSameMap) {
  ParameterSet options = parameters();
  const auto& world = test::surveyed_world("vineyard");
  MapContext rover = world.context(), quadrotor = world.context();
  quadrotor.vehicle = "quadrotor";
  quadrotor.part = "quadrotor.map";
  const auto vertices = [&](const MapContext& context) {
    return make_row_mesh_map(options, context)->meshes[0].mesh_W.vertices;
  };
  EXPECT_NE(vertices(rover), vertices(quadrotor));
  options.set("survey", std::string("spring"));
  EXPECT_EQ(vertices(rover), vertices(quadrotor));
  const auto spring = vertices(rover);
  options.set("survey", std::string("autumn"));
  EXPECT_NE(vertices(rover), spring);
}

TEST(RowMeshMap, RowsWithoutCanopyAreAsWideAndHighAsTheySay) {
  WorldModel world;
  world.name = "bare";
  world.terrain = HeightField{2, 2, 100.0, {-50.0, -50.0}, {1.0f, 1.0f, 1.0f, 1.0f}};
  PlantRow row;
  row.line_W = {{0, 0, 1}, {20, 0, 1}};
  world.rows->rows = {row};
  const physics::PhysicsWorld physics({}, world);
  MapContext context;
  context.vehicle = "rover";
  context.world = &world;
  context.scene = &physics.scene();
  std::vector<std::string> notes;
  const LogSink before =
      set_log_sink([&](const std::string& text) { notes.push_back(text); });
  RowMeshReport report;
  const auto map = make_row_mesh_map(parameters(), context, &report);
  set_log_sink(before);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "map of rover: no canopy on row 0, whose mesh has the row's own width and height");
  EXPECT_EQ(report.unseen_rows, std::vector<int>{0});
  ASSERT_EQ(map->meshes.size(), 1u);
  const Eigen::AlignedBox3d box = map->meshes[0].mesh_W.bounds();
  EXPECT_LT((box.min() - Vector3d(0.0, -0.3, 1.5)).norm(), 1e-6);
  EXPECT_LT((box.max() - Vector3d(20.0, 0.3, 3.0)).norm(), 1e-6);
  EXPECT_NEAR(test::closed_volume_m3(map->meshes[0].mesh_W), 20.0 * 0.6 * 1.5, 1e-4);
  EXPECT_EQ(map->accuracy.surface_std_m, MapAccuracy{}.surface_std_m) << "nothing was measured";

  world.rows->rows.clear();
  EXPECT_EQ(test::config_error_of([&] { make_row_mesh_map(parameters(), context); }),
            "map row_mesh: world 'bare' has no plant rows to survey");
}

TEST(RowMeshMap, IsWrittenAndReadBitForBit) {
  const std::string folder = ::testing::TempDir() + "row_mesh_map_files";
  std::filesystem::remove_all(folder);
  ParameterSet options = parameters();
  options.set("save_to", folder);
  const auto map = make(options);
  ParameterSet reading = parameters();
  reading.set("folder", folder);
  const auto read = make(reading);
  ASSERT_EQ(read->meshes.size(), map->meshes.size());
  for (std::size_t k = 0; k < map->meshes.size(); ++k) {
    EXPECT_EQ(read->meshes[k].row, map->meshes[k].row);
    EXPECT_EQ(read->meshes[k].mesh_W.vertices, map->meshes[k].mesh_W.vertices);
    EXPECT_EQ(read->meshes[k].mesh_W.triangles, map->meshes[k].mesh_W.triangles);
  }
  EXPECT_EQ(read->accuracy.surface_std_m, map->accuracy.surface_std_m);
  reading.set("fill_gaps", true);
  EXPECT_EQ(error_of(reading),
            "fill_gaps changes a survey, not the meshes of a folder: give one of both");
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  reading.set("fill_gaps", false);
  EXPECT_EQ(error_of(reading),
            "folder '" + folder +
                "' holds no row meshes: their files are called row_<number>_hull_<number>.ply");
}

TEST(RowMeshMap, RefusesWhatCannotBe) {
  ParameterSet options = parameters();
  options.set("section_spacing_m", Numbers{2, 1});
  EXPECT_EQ(error_of(options), "section_spacing_m = [2, 1] m, the first must be <= the second");
  options = parameters();
  ParameterSet gap = options.make_group("missing");
  gap.set("row", std::int64_t{9}).set("from_m", 1.0).set("to_m", 2.0);
  options.set("missing", std::vector<ParameterSet>{gap});
  EXPECT_EQ(error_of(options), "missing: there is no row 9, the last one is 3");
  gap.set("row", std::int64_t{2}).set("to_m", 1.0);
  options.set("missing", std::vector<ParameterSet>{gap});
  EXPECT_EQ(error_of(options), "missing[0]: from_m = 1 m of row 2, must be < to_m = 1 m");
  options = parameters();
  ParameterSet random = options.make_group("random_missing");
  random.set("count", std::int64_t{1}).set("length_m", 500.0);
  options.set("random_missing", std::vector<ParameterSet>{random});
  EXPECT_EQ(error_of(options),
            "random_missing: length_m = 500 m, no row has canopy of that length");
}

}  // namespace
}  // namespace vinerow::mapping::row_mesh_map_test
