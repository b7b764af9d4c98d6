/// The map `cloud_map`, and how a map comes into another frame.

#include "worlds/mapping/jobs/cloud_map_type.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include "engine/core/log.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "tests/worlds/mapping/cloud_map_fixture.h"
#include "worlds/mapping/folder/map_frame.h"
#include "worlds/mapping/grid/occupancy.h"

namespace vinerow::mapping::cloud_map_type_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Collects notes instead of printing them.
struct Notes {
  std::vector<std::string> texts;
  LogSink before;
  Notes() : before(set_log_sink([this](const std::string& t) { texts.push_back(t); })) {}
  ~Notes() { set_log_sink(before); }
};

/// A map's folder of the test, and the world of kind "vineyard" that it is given to.
class CloudMapType : public ::testing::Test {
 protected:
  std::string save(const CloudMap& map) const {
    const auto folder = folders_.path() / "map";
    save_map(map, folder);
    return folder.string();
  }
  ParameterSet parameters(const std::string& folder) const {
    ParameterSet set = test::map_parameters("cloud_map");
    set.set("folder", folder);
    return set;
  }
  std::unique_ptr<RowMap> make(const ParameterSet& set, const WorldModel* world = nullptr) const {
    MapContext context = test::surveyed_world("vineyard").context();
    if (world != nullptr) context.world = world;
    return make_map_of_folder(set, context);
  }
  const CloudMap& truth() const { return test::map_of_world("vineyard"); }
  test::MapFolders folders_;
};

/// The same place seen from another origin, by geodesy alone.
GeoOrigin shifted_origin(const GeoOrigin& origin, const Vector3d& offset) {
  const Geodetic place = LocalFrame(origin).to_geodetic(offset);
  return {place.latitude_rad, place.longitude_rad, place.altitude_m};
}

TEST_F(CloudMapType, TellsWhatTheFolderHolds) {
  const Notes notes;
  const auto map = make(parameters(save(truth())));
  EXPECT_EQ(map->rows[2].line_W, truth().map.rows[2].line_W);
  EXPECT_EQ(map->alleys[1].line_W, truth().map.alleys[1].line_W);
  EXPECT_EQ(map->boundary_W, truth().map.boundary_W);
  EXPECT_EQ(map->occupancy.cells, truth().map.occupancy.cells);
  EXPECT_EQ(map->terrain->heights_m, truth().map.terrain->heights_m);
  EXPECT_EQ(map->meshes.size(), truth().map.meshes.size());
  EXPECT_EQ(map->accuracy.surface_std_m, truth().map.accuracy.surface_std_m);
  EXPECT_TRUE(notes.texts.empty());
}

TEST_F(CloudMapType, StatesAnotherAccuracyWhereAsked) {
  ParameterSet set = parameters(save(truth()));
  set.set("stated_surface_std_m", 0.07).set("offset_std_m", std::vector<double>{0.1, 0.2, 0.3});
  const auto map = make(set);
  EXPECT_EQ(map->accuracy.surface_std_m, 0.07);
  EXPECT_EQ(map->accuracy.offset_std_m, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(map->accuracy.correlation_length_m, truth().map.accuracy.correlation_length_m);
}

TEST_F(CloudMapType, DrawsTheGridAnewWhereAsked) {
  const std::string folder = save(truth());
  OccupancyOptions options;
  options.cell_m = truth().map.occupancy.cell_m;
  options.virtual_walls = false;
  ParameterSet set = parameters(folder);
  set.set("virtual_walls", false);
  EXPECT_EQ(make(set)->occupancy.cells, make_occupancy_grid(truth().map, options).cells);

  set = parameters(folder);
  set.set("occupancy_cell_m", 0.25).set("first_wall", std::string("first"));
  options = {};
  options.cell_m = 0.25;
  options.first_wall = RowEnd::kFirst;
  const auto first = make(set);
  EXPECT_EQ(first->occupancy.cells, make_occupancy_grid(truth().map, options).cells);
  set.set("first_wall", std::string("last"));
  EXPECT_NE(make(set)->occupancy.cells, first->occupancy.cells);
}

TEST_F(CloudMapType, MovesAMapOfAnotherOriginToWhereItIs) {
  const Notes notes;
  // The same map as a survey that was referred to a stone 900 m away would have it.
  CloudMap moved = truth();
  const GeoOrigin stone = shifted_origin(truth().origin, {-700.0, 560.0, 85.0});
  move_map(stone, moved);
  // Every point by geodesy.
  const LocalFrame from(truth().origin), to(stone);
  const auto there = [&](const Vector3d& p) { return to.to_local(from.to_geodetic(p)); };
  for (std::size_t k = 0; k < moved.map.rows.size(); ++k) {
    for (std::size_t i = 0; i < moved.map.rows[k].line_W.size(); ++i) {
      EXPECT_LT((moved.map.rows[k].line_W[i] - there(truth().map.rows[k].line_W[i])).norm(), 1e-6);
    }
  }
  const auto& v = truth().map.meshes[3].mesh_W.vertices;
  for (std::size_t i = 0; i < v.size(); ++i) {
    EXPECT_LT(
        (moved.map.meshes[3].mesh_W.vertices[i].cast<double>() - there(v[i].cast<double>())).norm(),
        1e-4);
  }
  const HeightField& ground = *truth().map.terrain;
  for (const auto& [x, y] : {std::pair(0.3, 0.4), {0.5, 0.5}, {0.8, 0.2}}) {
    const Vector2d p = ground.corner_W + Vector2d(x * ground.width_m(), y * ground.depth_m());
    const Vector3d q = there({p.x(), p.y(), ground.height_m(p.x(), p.y())});
    EXPECT_NEAR(moved.map.terrain->height_m(q.x(), q.y()), q.z(), 5e-3);
  }

  // In the world it comes back to where it was.
  const auto map = make(parameters(save(moved)));
  EXPECT_TRUE(notes.texts.empty());
  double worst_m = 0.0;
  for (std::size_t k = 0; k < map->rows.size(); ++k) {
    for (std::size_t i = 0; i < map->rows[k].line_W.size(); ++i) {
      worst_m = std::max(worst_m, (map->rows[k].line_W[i] - truth().map.rows[k].line_W[i]).norm());
    }
  }
  EXPECT_LT(worst_m, 1e-6);
  EXPECT_LT((map->occupancy.corner_W - truth().map.occupancy.corner_W).norm(), 0.02);
  for (const PlantRow& row : map->rows) {
    for (const Vector3d& p : row.line_W) {
      EXPECT_NEAR(map->terrain->height_m(p.x(), p.y()), ground.height_m(p.x(), p.y()), 0.01);
    }
  }
}

TEST_F(CloudMapType, RefusesAMapOfAnotherPlaceWithTheDistance) {
  CloudMap elsewhere = truth();
  elsewhere.origin = shifted_origin(truth().origin, {3000.0, 4000.0, 0.0});
  const std::string folder = save(elsewhere);
  const std::string error = test::config_error_of([&] { make(parameters(folder)); });
  // 5 km less what the two boxes reach towards each other.
  EXPECT_EQ(error.find("map cloud_map: the rows of map '" + folder + "' lie 4.9"), 0u) << error;
  EXPECT_NE(error.find(" km from world 'vineyard', must be within 50 m: it is of another place, or "
                       "one of the two origins is wrong"),
            std::string::npos)
      << error;

  elsewhere.has_origin = false;
  for (PlantRow& row : elsewhere.map.rows) {
    for (Vector3d& p : row.line_W) p.x() += 500.0;
  }
  const Notes notes;
  const std::string local = save(elsewhere);
  EXPECT_NE(test::config_error_of([&] { make(parameters(local)); })
                .find("must be within 50 m: its x and y are taken for the world's, as one of the "
                      "two has no origin"),
            std::string::npos);
}

TEST_F(CloudMapType, SaysWhereItHasNoOriginOrOtherHeights) {
  {
    const Notes notes;
    CloudMap map = truth();
    map.has_origin = false;
    const std::string folder = save(map);
    make(parameters(folder));
    EXPECT_EQ(notes.texts, std::vector<std::string>{"map of rover: map '" + folder +
                                                    "' has no origin, the map's x, y and z are "
                                                    "taken for the world's"});
  }
  {
    const Notes notes;
    WorldModel nowhere;
    nowhere.name = "mesh";
    make(parameters(save(truth())), &nowhere);
    ASSERT_EQ(notes.texts.size(), 1u);
    EXPECT_EQ(notes.texts[0],
              "map of rover: world 'mesh' has no origin, the map's x, y and z are taken for the "
              "world's");
  }
  const Notes notes;
  CloudMap map = truth();
  map.origin.altitude_m -= 48.0;  // the geoid's height in Piedmont
  const std::string folder = save(map);
  make(parameters(folder));
  ASSERT_EQ(notes.texts.size(), 1u);
  EXPECT_EQ(notes.texts[0],
            "map of rover: the rows of map '" + folder +
                "' lie 48.0 m below the world's ground: is the altitude of its origin in another "
                "height system?");
}

/// The map counted from the other side, each line the other way.
CloudMap counted_backwards(const CloudMap& map) {
  CloudMap back = map;
  const int last = static_cast<int>(map.map.rows.size()) - 1;
  std::reverse(back.map.rows.begin(), back.map.rows.end());
  std::reverse(back.map.alleys.begin(), back.map.alleys.end());
  for (PlantRow& row : back.map.rows) {
    row.id = last - row.id;
    std::reverse(row.line_W.begin(), row.line_W.end());
  }
  for (Alley& alley : back.map.alleys) {
    alley.id = last - 1 - alley.id;
    std::reverse(alley.line_W.begin(), alley.line_W.end());
  }
  for (RowMesh& mesh : back.map.meshes) mesh.row = last - mesh.row;
  std::stable_sort(back.map.meshes.begin(), back.map.meshes.end(),
                   [](const RowMesh& a, const RowMesh& b) { return a.row < b.row; });
  return back;
}

TEST_F(CloudMapType, CountsRowsAsTheWorldDoes) {
  CloudMap back = counted_backwards(truth());
  // The serpentine of the other side: with four rows its walls stand elsewhere.
  OccupancyOptions options;
  options.cell_m = truth().map.occupancy.cell_m;
  back.map.occupancy = make_occupancy_grid(back.map, options);
  const std::string folder = save(back);
  const auto map = make(parameters(folder));
  for (std::size_t k = 0; k < map->rows.size(); ++k) {
    EXPECT_EQ(map->rows[k].id, truth().map.rows[k].id);
    EXPECT_EQ(map->rows[k].line_W, truth().map.rows[k].line_W);
  }
  for (std::size_t k = 0; k < map->alleys.size(); ++k) {
    EXPECT_EQ(map->alleys[k].id, truth().map.alleys[k].id);
    EXPECT_EQ(map->alleys[k].line_W, truth().map.alleys[k].line_W);
  }
  ASSERT_EQ(map->meshes.size(), truth().map.meshes.size());
  for (std::size_t k = 0; k < map->meshes.size(); ++k) {
    EXPECT_EQ(map->meshes[k].row, truth().map.meshes[k].row);
    EXPECT_EQ(map->meshes[k].mesh_W.vertices, truth().map.meshes[k].mesh_W.vertices);
  }
  EXPECT_EQ(map->occupancy.cells, make_occupancy_grid(truth().map, options).cells);

  ParameterSet set = parameters(folder);
  set.set("numbering", std::string("map"));
  EXPECT_EQ(make(set)->rows[0].line_W, back.map.rows[0].line_W);
  EXPECT_EQ(make(set)->occupancy.cells, back.map.occupancy.cells);

  // A grid without walls stays one without.
  options.virtual_walls = false;
  back.map.occupancy = make_occupancy_grid(back.map, options);
  EXPECT_EQ(make(parameters(save(back)))->occupancy.cells, back.map.occupancy.cells);
}

TEST_F(CloudMapType, RefusesAFolderThatIsNoMap) {
  std::filesystem::create_directories(folders_.path());
  EXPECT_EQ(test::config_error_of([&] { make(parameters(folders_.path().string())); }),
            "'" + folders_.path().string() + "' holds no map: there is no map.json");
  ParameterSet none = test::map_parameters("cloud_map");
  EXPECT_NE(test::config_error_of([&] { none.require_complete(); }).find("folder"),
            std::string::npos);
}

}  // namespace
}  // namespace vinerow::mapping::cloud_map_type_test
