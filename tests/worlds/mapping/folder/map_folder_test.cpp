/// Maps on disk: what is written is read back, other programs read it too, and what is broken is
/// refused in a sentence.

#include "worlds/mapping/folder/map_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/io/clouds/point_cloud_crs.h"
#include "engine/io/geo/geojson.h"
#include "engine/io/geo/height_raster.h"
#include "engine/io/geo/raster.h"
#include "engine/math/angles.h"
#include "tests/support/folder_test.h"
#include "tests/support/paths.h"
#include "tests/worlds/mapping/cloud_map_fixture.h"
#include "worlds/mapping/folder/map_json.h"

namespace vinerow::mapping::map_folder_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class MapFolder : public test::FolderTest {
 protected:
  MapFolder() : FolderTest("map_folder") {}

  static std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  /// The message without the folder's name.
  std::string error_of_load() const {
    return without_folder(test::config_error_of([&] { load_map(folder_ / "map"); }));
  }
  /// map.json with something changed.
  template <class Change>
  void change(Change&& with) const {
    auto json = nlohmann::json::parse(read(folder_ / "map/map.json"));
    with(json);
    write(folder_ / "map/map.json", json.dump());
  }
};

void expect_same(const MappedRowFigures& a, const MappedRowFigures& b) {
  EXPECT_EQ(a.row, b.row);
  EXPECT_EQ(a.block, b.block);
  EXPECT_EQ(a.first_W, b.first_W);
  EXPECT_EQ(a.last_W, b.last_W);
  EXPECT_EQ(a.length_m, b.length_m);
  EXPECT_EQ(a.bearing_deg, b.bearing_deg);
  EXPECT_EQ(a.spacing_m, b.spacing_m);
  EXPECT_EQ(a.canopy_base_m, b.canopy_base_m);
  EXPECT_EQ(a.canopy_top_m, b.canopy_top_m);
  EXPECT_EQ(a.canopy_width_m, b.canopy_width_m);
  EXPECT_EQ(a.volume_m3, b.volume_m3);
  EXPECT_EQ(a.seen_volume_m3, b.seen_volume_m3);
  EXPECT_EQ(a.containment, b.containment);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.gaps_m, b.gaps_m);
}

void expect_same(const CloudMapReport& a, const CloudMapReport& b) {
  EXPECT_EQ(a.file, b.file);
  EXPECT_EQ(a.format, b.format);
  EXPECT_EQ(a.crs, b.crs);
  EXPECT_EQ(a.cloud_bytes, b.cloud_bytes);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.not_finite, b.not_finite);
  EXPECT_EQ(a.ground_points, b.ground_points);
  EXPECT_EQ(a.low_points, b.low_points);
  EXPECT_EQ(a.canopy_points, b.canopy_points);
  EXPECT_EQ(a.other_points, b.other_points);
  EXPECT_EQ(a.density_per_m2, b.density_per_m2);
  EXPECT_EQ(a.noise_m, b.noise_m);
  EXPECT_EQ(a.bearing_deg, b.bearing_deg);
  EXPECT_EQ(a.spacing_m, b.spacing_m);
  EXPECT_EQ(a.spacing_std_m, b.spacing_std_m);
  EXPECT_EQ(a.canopy_top_m, b.canopy_top_m);
  EXPECT_EQ(a.canopy_width_m, b.canopy_width_m);
  EXPECT_EQ(a.volume_m3, b.volume_m3);
  EXPECT_EQ(a.seen_volume_m3, b.seen_volume_m3);
  EXPECT_EQ(a.containment, b.containment);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.mesh_bytes, b.mesh_bytes);
  EXPECT_EQ(a.reduction, b.reduction);
  EXPECT_EQ(a.notes, b.notes);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t k = 0; k < a.rows.size(); ++k) expect_same(a.rows[k], b.rows[k]);
}

void expect_same(const CloudMap& a, const CloudMap& b) {
  EXPECT_EQ(a.has_origin, b.has_origin);
  EXPECT_EQ(a.origin.latitude_rad, b.origin.latitude_rad);
  EXPECT_EQ(a.origin.longitude_rad, b.origin.longitude_rad);
  EXPECT_EQ(a.origin.altitude_m, b.origin.altitude_m);
  const RowMap &m = a.map, &n = b.map;
  ASSERT_EQ(m.rows.size(), n.rows.size());
  for (std::size_t k = 0; k < m.rows.size(); ++k) {
    EXPECT_EQ(m.rows[k].id, n.rows[k].id);
    EXPECT_EQ(m.rows[k].line_W, n.rows[k].line_W);
    EXPECT_EQ(m.rows[k].canopy_width_m, n.rows[k].canopy_width_m);
    EXPECT_EQ(m.rows[k].canopy_base_m, n.rows[k].canopy_base_m);
    EXPECT_EQ(m.rows[k].canopy_top_m, n.rows[k].canopy_top_m);
  }
  ASSERT_EQ(m.alleys.size(), n.alleys.size());
  for (std::size_t k = 0; k < m.alleys.size(); ++k) {
    EXPECT_EQ(m.alleys[k].id, n.alleys[k].id);
    EXPECT_EQ(m.alleys[k].line_W, n.alleys[k].line_W);
    EXPECT_EQ(m.alleys[k].width_m, n.alleys[k].width_m);
  }
  EXPECT_EQ(m.boundary_W, n.boundary_W);
  EXPECT_EQ(m.accuracy.surface_std_m, n.accuracy.surface_std_m);
  EXPECT_EQ(m.accuracy.correlation_length_m, n.accuracy.correlation_length_m);
  EXPECT_EQ(m.accuracy.offset_std_m, n.accuracy.offset_std_m);
  EXPECT_EQ(m.occupancy.columns, n.occupancy.columns);
  EXPECT_EQ(m.occupancy.rows, n.occupancy.rows);
  EXPECT_EQ(m.occupancy.cell_m, n.occupancy.cell_m);
  EXPECT_EQ(m.occupancy.corner_W, n.occupancy.corner_W);
  EXPECT_EQ(m.occupancy.cells, n.occupancy.cells);
  ASSERT_EQ(m.terrain.has_value(), n.terrain.has_value());
  if (m.terrain) {
    EXPECT_EQ(m.terrain->columns, n.terrain->columns);
    EXPECT_EQ(m.terrain->rows, n.terrain->rows);
    EXPECT_EQ(m.terrain->cell_m, n.terrain->cell_m);
    EXPECT_EQ(m.terrain->corner_W, n.terrain->corner_W);
    EXPECT_EQ(m.terrain->heights_m, n.terrain->heights_m);
  }
  ASSERT_EQ(m.meshes.size(), n.meshes.size());
  for (std::size_t k = 0; k < m.meshes.size(); ++k) {
    EXPECT_EQ(m.meshes[k].row, n.meshes[k].row);
    EXPECT_EQ(m.meshes[k].mesh_W.vertices, n.meshes[k].mesh_W.vertices);
    EXPECT_EQ(m.meshes[k].mesh_W.triangles, n.meshes[k].mesh_W.triangles);
  }
  expect_same(a.report, b.report);
}

TEST_F(MapFolder, ReadsBackWhatItWroteToTheBit) {
  for (const char* type : {"vineyard", "orchard", "surveyed"}) {
    SCOPED_TRACE(type);
    save_map(test::map_of_world(type), folder_ / type);
    expect_same(load_map(folder_ / type), test::map_of_world(type));
  }
}

TEST_F(MapFolder, WritesTheSameBytesAndNothingOfAnEarlierMap) {
  const CloudMap& map = test::map_of_world("vineyard");
  save_map(map, folder_ / "a");
  save_map(map, folder_ / "b");
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "a")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_EQ(read(entry.path()), read(folder_ / "b" / fs::relative(entry.path(), folder_ / "a")))
        << entry.path();
  }
  EXPECT_EQ(files, 7 + static_cast<int>(map.map.meshes.size()));

  CloudMap small = map;
  small.has_origin = false;
  small.origin = {};
  small.map.terrain.reset();
  small.map.occupancy = {};
  small.map.boundary_W.clear();
  small.map.alleys.clear();
  small.map.rows.resize(1);
  small.map.meshes = {map.map.meshes.front()};
  small.report = {};
  write(folder_ / "a/notes.txt", "mine");
  save_map(small, folder_ / "a");
  expect_same(load_map(folder_ / "a"), small);
  for (const char* file : {"rows.geojson", "terrain.tif", "occupancy.yaml", "occupancy.pgm"}) {
    EXPECT_FALSE(fs::exists(folder_ / "a" / file)) << file;
  }
  EXPECT_EQ(read(folder_ / "a/notes.txt"), "mine");
}

/// Every validator that is there judges the written files as sound, and broken ones as broken.
TEST_F(MapFolder, SchemasTakeWhatIsWrittenAndRefuseWhatIsBroken) {
  using nlohmann::json;
  const CloudMap& map = test::map_of_world("vineyard");
  CloudMap bare = map;
  bare.has_origin = false;
  bare.map.terrain.reset();
  bare.map.occupancy = {};
  const auto judge = [&](const std::string& schema, const json& good, const json& other,
                         const std::vector<std::string>& patches) {
    json cases = {{true, good}, {true, other}};
    for (const std::string& patch : patches) {
      cases.push_back({false, good.patch(json::parse("[" + patch + "]"))});
    }
    write(folder_ / "schema.json", schema);
    write(folder_ / "cases.json", cases.dump());
    const int status = std::system(("python3 " VINEROW_SOURCE_DIR
                                    "/tests/engine/scenario/scenario_schema_check.py " +
                                    folder_.string())
                                       .c_str());
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127) {
      GTEST_SKIP() << "python3-jsonschema is not installed";
    }
    EXPECT_EQ(WEXITSTATUS(status), 0);
  };
  judge(map_json_schema(), json::parse(map_to_json(map)), json::parse(map_to_json(bare)),
        {R"({"op": "replace", "path": "/vinerow_map", "value": 2})",
         R"({"op": "remove", "path": "/rows/0/line_m"})",
         R"({"op": "remove", "path": "/rows/0/line_m/0/2"})",
         R"({"op": "replace", "path": "/rows", "value": []})",
         R"({"op": "replace", "path": "/rows/0/canopy_width_m", "value": null})",
         R"({"op": "replace", "path": "/rows/0/hulls", "value": 1.5})",
         R"({"op": "replace", "path": "/terrain/cell_m", "value": 0})",
         R"({"op": "replace", "path": "/origin/latitude_deg", "value": 91})",
         R"({"op": "add", "path": "/row", "value": 1})",
         R"({"op": "remove", "path": "/report/rows/1/volume_m3"})"});
  judge(report_json_schema(), json::parse(report_to_json(map.report)),
        json::parse(report_to_json({})),
        {R"({"op": "replace", "path": "/vinerow_map_report", "value": "1"})",
         R"({"op": "replace", "path": "/meshes/containment", "value": 1.1})",
         R"({"op": "replace", "path": "/cloud/points", "value": -1})",
         R"({"op": "replace", "path": "/rows/0/gaps_m", "value": [[1]]})",
         R"({"op": "add", "path": "/phases", "value": []})"});
}

TEST_F(MapFolder, GeoJsonHasRowsEndsAlleysAndBoundaryWhereTheyAre) {
  const CloudMap& map = test::map_of_world("vineyard");
  save_map(map, folder_ / "map");
  const LocalFrame frame(map.origin);
  const auto features = io::read_geojson(folder_ / "map/rows.geojson");
  std::map<std::string, std::vector<io::GeoFeature>> by_type;
  for (const auto& feature : features) {
    EXPECT_TRUE(feature.has_altitude);
    by_type[feature.property("type")].push_back(feature);
  }
  const auto place = [&](const Geodetic& p) { return frame.to_local(p); };
  ASSERT_EQ(by_type["row"].size(), map.map.rows.size());
  ASSERT_EQ(by_type["row_end"].size(), 2 * map.map.rows.size());
  ASSERT_EQ(by_type["mid_row_line"].size(), map.map.alleys.size());
  ASSERT_EQ(by_type["boundary"].size(), 1u);
  for (std::size_t k = 0; k < map.map.rows.size(); ++k) {
    const auto& line_W = map.map.rows[k].line_W;
    const io::GeoFeature& row = by_type["row"][k];
    ASSERT_EQ(row.points.size(), line_W.size());
    for (std::size_t i = 0; i < line_W.size(); ++i) {
      EXPECT_LT((place(row.points[i]) - line_W[i]).norm(), 1e-3);
    }
    EXPECT_LT((place(by_type["row_end"][2 * k].points[0]) - line_W.front()).norm(), 1e-3);
    EXPECT_LT((place(by_type["row_end"][2 * k + 1].points[0]) - line_W.back()).norm(), 1e-3);
  }
  EXPECT_EQ(by_type["boundary"][0].points.size(), map.map.boundary_W.size() + 1);
  EXPECT_LT((place(by_type["boundary"][0].points[2]).head<2>() - map.map.boundary_W[2]).norm(),
            1e-3);
  // The world `surveyed` takes the rows for rows, and alleys for none.
  EXPECT_EQ(io::read_survey(folder_ / "map/rows.geojson").rows.size(), map.map.rows.size());
}

TEST_F(MapFolder, TerrainLiesWhereGeodesySays) {
  const CloudMap& map = test::map_of_world("vineyard");
  save_map(map, folder_ / "map");
  const HeightField& terrain = *map.map.terrain;
  // By the reader of elevation models, which knows nothing of how the file was made.
  const io::ElevationRaster raster = io::read_elevation(folder_ / "map/terrain.tif");
  const io::ElevationLookup lookup(raster);
  const LocalFrame frame(map.origin);
  for (const auto& [i, j] : {std::pair(0, 0), {7, 11}, {terrain.columns - 1, terrain.rows - 1}}) {
    const double x = terrain.corner_W.x() + i * terrain.cell_m;
    const double y = terrain.corner_W.y() + j * terrain.cell_m;
    const Geodetic place = frame.to_geodetic({x, y, terrain.height_m(x, y)});
    const std::optional<double> read = lookup.height_m(place.latitude_rad, place.longitude_rad);
    ASSERT_TRUE(read);
    EXPECT_NEAR(*read, place.altitude_m, 2e-3);
  }
  // The raster's easting and northing are W's x and y.
  const io::CloudFrame crs(raster.crs_wkt, map.origin);
  for (const double x : {-1000.0, 0.0, 700.0}) {
    for (const double y : {-1000.0, 0.0, 700.0}) {
      const Vector3d p = crs.to_local({x, y, map.origin.altitude_m});
      EXPECT_NEAR(p.x(), x, 1e-4);
      EXPECT_NEAR(p.y(), y, 1e-4);
      EXPECT_NEAR(p.z(), -(x * x + y * y) / (2.0 * 6.37e6), 1e-3);
    }
  }
}

TEST_F(MapFolder, TerrainWithoutOriginHasNoPlaceOnEarth) {
  CloudMap map = test::map_of_world("vineyard");
  map.has_origin = false;
  save_map(map, folder_ / "map");
  EXPECT_EQ(load_map(folder_ / "map").map.terrain->heights_m, map.map.terrain->heights_m);
  EXPECT_EQ(without_folder(
                test::config_error_of([&] { io::read_elevation(folder_ / "map/terrain.tif"); })),
            "raster 'map/terrain.tif' has no coordinate reference system; give it by 'crs: "
            "EPSG:<code>'");
}

TEST_F(MapFolder, RefusesBrokenFoldersInASentence) {
  const CloudMap& map = test::map_of_world("vineyard");
  const auto anew = [&] {
    fs::remove_all(folder_ / "map");
    save_map(map, folder_ / "map");
  };
  EXPECT_EQ(error_of_load(), "'map' holds no map: there is no map.json");
  anew();
  fs::remove(folder_ / "map/terrain.tif");
  EXPECT_EQ(error_of_load(), "raster 'map/terrain.tif' does not exist");
  anew();
  fs::resize_file(folder_ / "map/terrain.tif", fs::file_size(folder_ / "map/terrain.tif") / 3);
  EXPECT_NE(error_of_load().find("raster 'map/terrain.tif' cannot be read"), std::string::npos)
      << error_of_load();
  anew();
  fs::remove(folder_ / "map/occupancy.pgm");
  EXPECT_NE(error_of_load().find("occupancy.pgm"), std::string::npos) << error_of_load();
  anew();
  fs::remove(folder_ / "map/meshes/row_02_hull_00.ply");
  EXPECT_NE(error_of_load().find("meshes of row 2, the folder 'map/meshes' holds"),
            std::string::npos)
      << error_of_load();
  anew();
  fs::resize_file(folder_ / "map/meshes/row_02_hull_00.ply", 500);
  EXPECT_NE(error_of_load().find("row_02_hull_00.ply"), std::string::npos) << error_of_load();
  anew();
  fs::resize_file(folder_ / "map/map.json", fs::file_size(folder_ / "map/map.json") / 2);
  EXPECT_EQ(error_of_load(), "map file 'map/map.json' is not valid JSON, or cut off");
  anew();
  HeightField other = *map.map.terrain;
  other.corner_W.x() += 1.0;
  io::write_height_raster(other, map.origin, folder_ / "map/terrain.tif");
  EXPECT_EQ(error_of_load().find("map 'map': terrain.tif has "), 0u) << error_of_load();
  EXPECT_NE(error_of_load().find(", by map.json they are "), std::string::npos);
}

TEST_F(MapFolder, RefusesBrokenMapJsonInASentence) {
  const CloudMap& map = test::map_of_world("vineyard");
  const auto error_with = [&](auto&& with) {
    save_map(map, folder_ / "map");
    change(with);
    return error_of_load();
  };
  const std::string in = "map file 'map/map.json'";
  EXPECT_EQ(error_with([](auto& j) { j["vinerow_map"] = 2; }),
            in + " is of version 2, this program reads version 1");
  EXPECT_EQ(error_with([](auto& j) { j.erase("vinerow_map"); }), in + " has no key 'vinerow_map'");
  EXPECT_EQ(error_with([](auto& j) { j = 3; }), in + " is 3, must be a mapping");
  EXPECT_EQ(error_with([](auto& j) { j["rows"][1].erase("line_m"); }),
            in + ": rows[1] has no key 'line_m'");
  EXPECT_EQ(error_with([](auto& j) {
              j["rows"][1]["line_m"][3] = {1, 2};
            }),
            in + ": rows[1].line_m[3] has 2 numbers, must have 3");
  EXPECT_EQ(error_with([](auto& j) { j["rows"][1]["line_m"][3][0] = nullptr; }),
            in + ": rows[1].line_m[3][0] is null, must be a finite number");
  EXPECT_EQ(error_with([](auto& j) { j["rows"][1]["canopy_width_m"] = "wide"; }),
            in + ": rows[1].canopy_width_m is \"wide\", must be a finite number");
  EXPECT_EQ(error_with([](auto& j) { j["rows"][1]["id"] = -1; }),
            in + ": rows[1].id is -1, must be a whole number >= 0");
  EXPECT_EQ(error_with([](auto& j) { j["rows"] = "none"; }),
            in + ": rows is \"none\", must be a list");
  EXPECT_EQ(error_with([](auto& j) { j["report"]["cloud"]["file"] = 5; }),
            in + ": report.cloud.file is 5, must be a text");
  EXPECT_EQ(error_with([](auto& j) { j["terrain"]["cell_m"] = 0; }),
            in + ": terrain.cell_m is 0, must be > 0");
  // Faults that the schema cannot detect.
  const std::string of = "map 'map'";
  EXPECT_EQ(error_with([](auto& j) {
              j["rows"][1]["line_m"] = {{1, 2, 3}};
            }),
            of + ": row 1: its line has 1 points, needs at least 2");
  EXPECT_EQ(error_with([](auto& j) {
              j["rows"][1]["line_m"] = {{1, 2, 3}, {1, 2, 9}};
            }),
            of + ": row 1: points 0 and 1 of its line are the same place");
  EXPECT_EQ(error_with([](auto& j) { j["rows"][1]["canopy_width_m"] = -0.5; }),
            of + ": row 1: its canopy_width_m is -0.5 m, must be > 0");
  EXPECT_EQ(error_with([](auto& j) { j["rows"][1]["canopy_base_m"] = 9; }),
            of + ": row 1: its canopy reaches from 9 m to 2 m, must be upward");
  EXPECT_EQ(error_with([](auto& j) { j["alleys"][0]["width_m"] = 0; }),
            of + ": alley 0: its width_m is 0 m, must be > 0");
  EXPECT_EQ(error_with([](auto& j) {
              j["boundary_m"] = {{1, 2}, {3, 4}};
            }),
            of + ": its boundary has 2 corners, needs at least 3, or none");
  EXPECT_EQ(error_with([](auto& j) { j["accuracy"]["surface_std_m"] = 0; }),
            of + ": its surface_std_m is 0 m, must be > 0");
  EXPECT_EQ(
      error_with([](auto& j) { j["origin"]["latitude_deg"] = 95; }),
      of + ": its origin is 95 deg north, 7.9244 deg east, 300 m, must be within +-90, +-180");
  EXPECT_EQ(error_with([](auto& j) { j["rows"] = nlohmann::json::array(); }), of + " has no rows");
  EXPECT_EQ(error_with([](auto& j) { j["rows"][1]["id"] = 0; }),
            of + ": row 0: its number is negative, or another row's too");
  EXPECT_EQ(error_with([](auto& j) {
              j["rows"][1]["hulls"] = 0;
            }).find(of + ": map.json counts 0 meshes of row 1, the folder 'map/meshes' holds "),
            0u);
}

TEST_F(MapFolder, RefusesToWriteWhatIsNotSound) {
  const auto error_with = [&](auto&& with) {
    CloudMap map = test::map_of_world("vineyard");
    with(map);
    return without_folder(test::config_error_of([&] { save_map(map, folder_ / "map"); }));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_with([&](CloudMap& m) { m.map.rows[1].line_W[2].z() = nan; }),
            "map 'map': row 1: point 2 of its line is not finite");
  EXPECT_EQ(error_with([&](CloudMap& m) { m.map.rows[1].canopy_width_m = nan; }),
            "map 'map': row 1: its canopy_width_m is nan m, must be > 0");
  EXPECT_EQ(error_with([&](CloudMap& m) { m.map.boundary_W[0].x() = nan; }),
            "map 'map': a corner of its boundary is not finite");
  EXPECT_EQ(error_with([&](CloudMap& m) { m.map.meshes[0].mesh_W.vertices[3].x() = NAN; }),
            "map 'map': a mesh of row 0 has a vertex that is not finite");
  EXPECT_EQ(error_with([&](CloudMap& m) { m.map.meshes[0].row = 99; }),
            "map 'map': a mesh is of row 99, which it does not have");
  EXPECT_EQ(error_with([&](CloudMap& m) { m.map.rows[1].id = 0; }),
            "map 'map': row 0: its number is negative, or another row's too");
  EXPECT_EQ(error_with([&](CloudMap& m) {
              m.map.terrain->columns = 3, m.map.terrain->rows = 2;
              m.map.terrain->heights_m.resize(5);
            }),
            "map 'map': its terrain of 3 x 2 samples holds 5 heights");
  EXPECT_EQ(error_with([&](CloudMap& m) { m.map.terrain->heights_m[5] = NAN; }),
            "raster 'map/terrain.tif' cannot be written: the terrain has a height that is not "
            "finite");
  const std::string error =
      test::config_error_of([&] { save_map(test::map_of_world("vineyard"), "/proc/none/map"); });
  EXPECT_TRUE(error.starts_with("folder '/proc/none/map' cannot be created for the map:")) << error;
}

}  // namespace
}  // namespace vinerow::mapping::map_folder_test
