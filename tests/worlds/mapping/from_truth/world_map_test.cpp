/// The map that each world hands to its vehicles.

#include <gtest/gtest.h>

#include <chrono>

#include "engine/api/world_model.h"
#include "engine/io/grids/ros_map.h"
#include "tests/worlds/mapping/grid_search.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/mapping/from_truth/map_parameters.h"

namespace vinerow::mapping::world_map_test {
namespace {

using Eigen::Vector2d;

ParameterSet small_vineyard() {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", 4.0).set("row_length_m", 20.0).set("leaf_cards_per_m", 10.0);
  return parameters;
}

TEST(WorldMap, ParcelFHasTurningAreasOfTwoSpacings) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("leaf_cards_per_m", 20.0);
  const auto world = test::make_world("vineyard", parameters);
  const OccupancyReport report = plan_occupancy(world->rows, read_map_options(parameters));
  EXPECT_EQ(report.walls.size(), 16u);
  EXPECT_TRUE(report.notes.empty());
  ASSERT_EQ(report.turning_areas.size(), 14u);
  for (const TurningArea& area : report.turning_areas) EXPECT_NEAR(area.width_m, 5.0, 1e-9);

  EXPECT_EQ(world->rows->occupancy.cell_m, 0.05);
  OccupancyOptions coarse;
  coarse.cell_m = 0.1;  // a quarter of the cells to search
  const OccupancyGrid grid = make_occupancy_grid(world->rows, coarse);
  // At the grid's angle steps to eight neighbours are up to 8 % longer than the way.
  const auto& first = world->rows->alleys.front().line_W;
  const auto& last = world->rows->alleys.back().line_W;
  const double path_length_m =
      test::path_length_m(grid, first.front().head<2>(), last.back().head<2>());
  EXPECT_GT(path_length_m, 15 * 118.0);
  EXPECT_LT(path_length_m, 1.083 * (15 * 118.0 + 14 * 2.5));
}

TEST(WorldMap, EveryAlleyOfEveryWorldIsFreeAndEveryRowTaken) {
  for (const std::string type : {"vineyard", "orchard", "surveyed"}) {
    SCOPED_TRACE(type);
    ParameterSet parameters = type == "vineyard" ? small_vineyard() : test::world_parameters(type);
    if (type == "surveyed") parameters.set("survey_file", test::riseholme_file());
    parameters.set("occupancy_cell_m", 0.1);
    const auto world = test::make_world(type, parameters);
    const OccupancyGrid& grid = world->rows->occupancy;
    ASSERT_FALSE(grid.empty());
    for (const Alley& alley : world->rows->alleys) {
      for (std::size_t k = 0; k + 1 < alley.line_W.size(); ++k) {
        for (int i = 0; i <= 50; ++i) {
          const Vector2d p =
              (alley.line_W[k] + i / 50.0 * (alley.line_W[k + 1] - alley.line_W[k])).head<2>();
          EXPECT_FALSE(test::occupied_at(grid, p)) << "alley " << alley.id;
        }
      }
    }
    for (const PlantRow& row : world->rows->rows) {
      for (std::size_t k = 0; k + 1 < row.line_W.size(); ++k) {
        for (int i = 1; i < 50; ++i) {
          const Vector2d p =
              (row.line_W[k] + i / 50.0 * (row.line_W[k + 1] - row.line_W[k])).head<2>();
          EXPECT_TRUE(test::occupied_at(grid, p)) << "row " << row.id;
        }
      }
    }
    // The serpentine that begins at alley 0's first point is open to the end.
    const auto& alleys = world->rows->alleys;
    const bool forward = alleys.size() % 2 == 1;
    const auto& last = alleys.back().line_W;
    double centre_lines_m = 0.0;
    for (const Alley& alley : alleys) {
      centre_lines_m += (alley.line_W.back() - alley.line_W.front()).head<2>().norm();
    }
    const double path_length_m =
        test::path_length_m(grid, alleys.front().line_W.front().head<2>(),
                            (forward ? last.back() : last.front()).head<2>());
    EXPECT_TRUE(std::isfinite(path_length_m));
    EXPECT_GT(path_length_m, 0.95 * centre_lines_m);
  }
}

TEST(WorldMap, SdfRowsHaveOneToo) {
  const std::string sdf = test::temporary_file("map_rows.world", [] {
    std::string text = "<sdf version='1.6'><world name='w'>";
    for (int row = 0; row < 3; ++row) {
      for (int piece = 0; piece < 3; ++piece) {
        text += "<include><uri>model://vine</uri><name>v" + std::to_string(3 * row + piece) +
                "</name><pose>" + std::to_string(6 * piece) + " " + std::to_string(3 * row) +
                " 0 0 0 0</pose></include>";
      }
    }
    return text + "</world></sdf>";
  }());
  ParameterSet parameters = test::world_parameters("mesh");
  parameters.set("sdf_file", sdf).set("leaf_cards_per_m", 10.0);
  const auto world = test::make_world("mesh", parameters);
  ASSERT_EQ(world->rows->rows.size(), 3u);
  EXPECT_FALSE(world->rows->occupancy.empty());
  EXPECT_TRUE(test::occupied_at(world->rows->occupancy, {5.0, 3.0}));
  EXPECT_FALSE(test::occupied_at(world->rows->occupancy, {5.0, 1.5}));
}

TEST(WorldMap, CanBeLeftOutOrBeWithoutWalls) {
  ParameterSet parameters = small_vineyard();
  EXPECT_TRUE(test::make_world("vineyard", parameters.set("occupancy_cell_m", 0.0))
                  ->rows->occupancy.empty());
  parameters.set("occupancy_cell_m", 0.1).set("virtual_walls", false);
  const auto world = test::make_world("vineyard", parameters);
  const auto& alleys = world->rows->alleys;
  const double across_m = test::path_length_m(world->rows->occupancy, alleys[0].line_W[0].head<2>(),
                                              alleys[2].line_W[0].head<2>());
  EXPECT_LT(across_m, 8.0);
  parameters.set("virtual_walls", true);
  const auto walled = test::make_world("vineyard", parameters);
  EXPECT_GT(test::path_length_m(walled->rows->occupancy, alleys[0].line_W[0].head<2>(),
                                alleys[2].line_W[0].head<2>()),
            40.0);
  parameters.set("first_wall", std::string("first"));
  const auto flipped = test::make_world("vineyard", parameters);
  EXPECT_LT(test::path_length_m(flipped->rows->occupancy, alleys[0].line_W[0].head<2>(),
                                alleys[1].line_W[0].head<2>()),
            5.0);
}

TEST(WorldMap, HugeBlocksGetLargerCellsAndANote) {
  ParameterSet parameters = test::world_parameters("orchard");
  parameters.set("plant_rows", 1.0).set("row_length_m", 10.0);
  parameters.set("field_width_m", 400.0).set("field_length_m", 300.0);
  const auto world = test::make_world("orchard", parameters);
  EXPECT_LE(world->rows->occupancy.cells.size(), 8'000'000u);
  EXPECT_GT(world->rows->occupancy.cells.size(), 7'500'000u);
  ASSERT_EQ(world->notes.size(), 1u);
  EXPECT_EQ(world->notes[0],
            "occupancy_cell_m = 0.05 m would make more than 8 million cells; 0.123 m is used");
}

TEST(WorldMap, TheOrchardsMatrixIsThePapersWhereARefinementIsGiven) {
  ParameterSet parameters = test::world_parameters("orchard");
  parameters.set("refinement_per_m2", 4.0);
  const auto world = test::make_world("orchard", parameters);
  EXPECT_EQ(world->rows->occupancy.columns, 200);
  // n w l = 1440 m2 at 4 elements per square metre.
  EXPECT_NEAR(free_share(world->rows->occupancy), 1.0 - 5760.0 / 40000.0, 1e-12);
}

TEST(WorldMap, AFileReplacesTheTruth) {
  OccupancyGrid grid;
  grid.columns = 3;
  grid.rows = 2;
  grid.cell_m = 0.25;
  grid.corner_W = {-1.5, 2.25};
  grid.cells = {0, 1, 0, 1, 1, 0};
  const std::string file = test::temporary_file("given_map.yaml", "");
  io::save_ros_map(grid, file);
  ParameterSet parameters = small_vineyard();
  parameters.set("occupancy_file", file);
  const auto world = test::make_world("vineyard", parameters);
  const OccupancyGrid& got = world->rows->occupancy;
  EXPECT_EQ(got.cells, grid.cells);
  EXPECT_EQ(got.corner_W, grid.corner_W);
  EXPECT_EQ(got.cell_m, 0.25);
}

TEST(WorldMap, MapAndObstaclesChangeNoMeshFile) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_map_key_test";
  std::filesystem::remove_all(folder);
  ParameterSet parameters = small_vineyard();
  parameters.set("mesh_folder", folder.string());
  test::make_world("vineyard", parameters);
  ParameterSet obstacle = parameters.make_group("obstacles");
  obstacle.set("alley", 0.0).set("distance_m", 5.0);
  parameters.set("obstacles", std::vector<ParameterSet>{obstacle});
  parameters.set("occupancy_cell_m", 0.2).set("virtual_walls", false);
  parameters.set("first_wall", std::string("last"));
  test::make_world("vineyard", parameters);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder),
                          std::filesystem::directory_iterator()),
            1);
  std::filesystem::remove_all(folder);
}

TEST(WorldMap, ReliefKeepsTheSteepnessOfParcelFUnlessGiven) {
  const auto slope_of = [](const ParameterSet& parameters) {
    const auto world = test::make_world("vineyard", parameters);
    const auto& line = world->rows->rows[1].line_W;
    return (line[1] - line[0]).z() / (line[1] - line[0]).head<2>().norm();
  };
  ParameterSet parameters = small_vineyard();
  parameters.set("waves_m", 0.0);
  const double short_rows = slope_of(parameters);
  // 30 m over 118 m, less what the four rows' width takes of it; not 30 m over 20 m.
  EXPECT_GT(std::abs(short_rows), 0.20);
  EXPECT_LT(std::abs(short_rows), 30.0 / 118.0);
  parameters.set("relief_m", 30.0);
  EXPECT_GT(std::abs(slope_of(parameters)), 1.0);
}

}  // namespace
}  // namespace vinerow::mapping::world_map_test
