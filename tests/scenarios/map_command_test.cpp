/// The command `vinerow map`.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/api/world_model.h"
#include "engine/imaging/png.h"
#include "engine/math/polygon.h"
#include "tests/scenarios/small_vineyard_map.h"
#include "tests/support/paths.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"

namespace vinerow::map_command_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::run_vinerow;
using test::ScratchFolder;
using test::value_in;

void expect_refused(const std::string& arguments, const std::string& text) {
  const auto result = run_vinerow(arguments);
  EXPECT_EQ(result.status, 2) << result.output;
  EXPECT_NE(result.output.find(text), std::string::npos) << "wanted: " << text << "\n"
                                                         << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
}

/// One map for all tests that look at it.
class MapCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ScratchFolder>("map_command");
    cloud_ = test::small_cloud(*folder_);
    result_ = run_vinerow(
        "map " + cloud_ + " --scenario " + (folder_->path() / "world.yaml").string() +
        " --cell 0.1 --title 'Small & steep' --truth " + truth_file() + " --out " + out().string());
    if (result_.status != 0) throw std::runtime_error(result_.output);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string truth_file() { return mapping::truth_file_of(cloud_).string(); }
  static fs::path out() { return folder_->path() / "map"; }

  static inline std::unique_ptr<ScratchFolder> folder_;
  static inline std::string cloud_;
  static inline test::CommandResult result_;
};

TEST_F(MapCommand, FindsTheRowsAndSaysSo) {
  const mapping::CloudMap map = mapping::load_map(out());
  ASSERT_EQ(map.map.rows.size(), 4u);
  EXPECT_EQ(map.map.alleys.size(), 3u);
  EXPECT_EQ(value_in(result_.output, "rows").substr(0, 2), "4,");
  EXPECT_NE(result_.output.find("rows found     4 of 4\n"), std::string::npos) << result_.output;
  // The table's numbers follow from the two files.
  const mapping::CloudTruth truth = mapping::read_cloud_truth(truth_file());
  const double volume_error = map.report.volume_m3 / truth.volume_m3 - 1.0;
  char line[80];
  std::snprintf(line, sizeof line, "volume         %+.2f %% of %.2f m3", 100.0 * volume_error,
                truth.volume_m3);
  EXPECT_NE(result_.output.find(line), std::string::npos) << line << "\n" << result_.output;
  std::snprintf(line, sizeof line, "spacing        %+.4f m of %.4f m",
                map.report.spacing_m - truth.spacing_m, truth.spacing_m);
  EXPECT_NE(result_.output.find(line), std::string::npos) << line << "\n" << result_.output;
  EXPECT_NEAR(map.report.spacing_m, 2.5, 0.02);
  EXPECT_EQ(map.origin.latitude_rad, truth.origin.latitude_rad);
  EXPECT_EQ(map.origin.altitude_m, truth.origin.altitude_m);
}

TEST_F(MapCommand, ReportsFiguresOfTheMap) {
  const mapping::CloudMap map = mapping::load_map(out());
  const json report = json::parse(test::read_text(out() / "report.json"));
  EXPECT_EQ(report["cloud"]["file"], "parcel.las");
  EXPECT_EQ(report["cloud"]["bytes"], fs::file_size(cloud_));
  std::int64_t classes = 0;
  for (const char* name : {"ground_points", "low_points", "canopy_points", "other_points"}) {
    classes += report["cloud"][name].get<std::int64_t>();
  }
  EXPECT_EQ(classes, report["cloud"]["points"]);
  // By the files themselves.
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(out() / "meshes")) bytes += entry.file_size();
  std::size_t triangles = 0;
  for (const RowMesh& mesh : map.map.meshes) triangles += mesh.mesh_W.triangles.size();
  EXPECT_EQ(report["meshes"]["triangles"], triangles);
  EXPECT_NEAR(
      report["meshes"]["reduction"].get<double>(),
      1.0 - report["meshes"]["bytes"].get<double>() / static_cast<double>(fs::file_size(cloud_)),
      1e-12);
  // Headers of so few meshes are a small part.
  EXPECT_NEAR(report["meshes"]["bytes"].get<double>(), static_cast<double>(bytes),
              0.1 * static_cast<double>(bytes));
  double length_m = 0.0, volume_m3 = 0.0;
  for (std::size_t k = 0; k < report["rows"].size(); ++k) {
    const json& row = report["rows"][k];
    EXPECT_EQ(row["row"], map.map.rows[k].id);
    length_m += row["length_m"].get<double>();
    volume_m3 += row["volume_m3"].get<double>();
    EXPECT_EQ(row["canopy_width_m"], map.map.rows[k].canopy_width_m);
  }
  EXPECT_NEAR(report["vineyard"]["volume_m3"].get<double>(), volume_m3, 1e-9);
  EXPECT_EQ(report["vineyard"]["row_count"], 4);
  EXPECT_NEAR(length_m, 4 * 24.0, 4 * 1.5);

  const std::string html = test::read_text(out() / "report.html");
  for (const std::string& text :
       {std::string("<h1>Small &amp; steep</h1>"), std::string("<div class=\"value\">4</div>"),
        std::string("pictures/top.png"), std::string("pictures/classes.png"),
        std::string("pictures/mesh.png"), std::string("pictures/grid.png")}) {
    EXPECT_NE(html.find(text), std::string::npos) << text;
  }
  char cell[40];
  std::snprintf(cell, sizeof cell, "<td>%.2f</td>", report["rows"][2]["length_m"].get<double>());
  EXPECT_NE(html.find(cell), std::string::npos) << cell;
  EXPECT_EQ(html.find("http"), std::string::npos) << "the page needs no network";
}

/// Every element that is opened is closed, in order; attributes are quoted; no bare & or <.
TEST_F(MapCommand, ThePageIsWellFormed) {
  const std::string html = test::read_text(out() / "report.html");
  std::vector<std::string> open;
  std::size_t at = html.find("<html");
  ASSERT_NE(at, std::string::npos);
  while ((at = html.find_first_of("<&", at)) != std::string::npos) {
    if (html[at] == '&') {
      EXPECT_LE(html.find(';', at) - at, 6u) << html.substr(at, 30);
      ++at;
      continue;
    }
    const std::size_t end = html.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = html.substr(at + 1, end - at - 1);
    EXPECT_EQ(std::count(tag.begin(), tag.end(), '"') % 2, 0) << tag;
    if (tag[0] == '/') {
      ASSERT_FALSE(open.empty()) << tag;
      EXPECT_EQ(open.back(), tag.substr(1));
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
    at = end;
  }
  EXPECT_TRUE(open.empty()) << open.back();
}

TEST_F(MapCommand, PicturesShowGroundRowsAndGrid) {
  const auto count = [&](const char* name, auto&& is) {
    const auto picture = imaging::read_png((out() / "pictures" / name).string());
    EXPECT_TRUE(picture.ok()) << name;
    int pixels = 0;
    for (int y = 0; y < picture->height; ++y) {
      for (int x = 0; x < picture->width; ++x) {
        const std::uint8_t* p = picture->at(x, y);
        pixels += is(int(p[0]), int(p[1]), int(p[2]));
      }
    }
    return static_cast<double>(pixels) / (picture->width * picture->height);
  };
  const auto green = [](int r, int g, int b) { return g > r + 25 && g > b + 15; };
  const auto brown = [](int r, int g, int b) { return r > g + 12 && g > b + 12; };
  const auto red = [](int r, int g, int b) { return r > 150 && g < 90 && b < 90; };
  const auto blue = [](int r, int g, int b) { return b > 160 && r < 90 && g < 150; };
  EXPECT_GT(count("classes.png", green), 0.05);
  EXPECT_GT(count("classes.png", brown), 0.05);
  EXPECT_GT(count("mesh.png", green), 0.05);
  EXPECT_GT(count("mesh.png", brown), 0.05);
  EXPECT_GT(count("top.png", green), 0.005);
  EXPECT_GT(count("top.png", red), 1e-4) << "ends of the rows";
  EXPECT_GT(count("grid.png", green), 0.01);
  EXPECT_GT(count("grid.png", blue), 2e-4) << "virtual walls";
}

TEST_F(MapCommand, TheSameBytesAgainButForTheTiming) {
  const fs::path again = folder_->path() / "again";
  const auto second =
      run_vinerow("map " + cloud_ + " --scenario " + (folder_->path() / "world.yaml").string() +
                  " --cell 0.1 --title 'Small & steep' --out " + again.string());
  ASSERT_EQ(second.status, 0) << second.output;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(out())) {
    if (!entry.is_regular_file() || entry.path().filename() == "timing.json") continue;
    ++files;
    EXPECT_TRUE(test::read_text(entry.path()) ==
                test::read_text(again / fs::relative(entry.path(), out())))
        << entry.path();
  }
  EXPECT_GE(files, 7 + 4 + 4);
  const json timing = json::parse(test::read_text(out() / "timing.json"));
  std::vector<std::string> phases;
  double sum_s = 0.0;
  for (const json& phase : timing["phases"]) {
    phases.push_back(phase["name"]);
    sum_s += phase["wall_s"].get<double>();
    EXPECT_GT(phase["peak_memory_MB"].get<double>(), 1.0);
  }
  EXPECT_NEAR(timing["total_s"].get<double>(), sum_s, 1e-6);
  for (const char* name : {"read", "terrain", "rows", "meshes", "grid", "files", "pictures"}) {
    EXPECT_NE(std::find(phases.begin(), phases.end(), name), phases.end()) << name;
  }
}

TEST_F(MapCommand, TakesABoundaryAndLeavesWallsOut) {
  // 3 m around the rows, as the map has them.
  const mapping::CloudMap map = mapping::load_map(out());
  Eigen::AlignedBox2d box;
  for (const PlantRow& row : map.map.rows) {
    for (const auto& p : row.line_W) box.extend(Eigen::Vector2d(p.head<2>()));
  }
  const Eigen::Vector2d a = box.min().array() - 3.0, b = box.max().array() + 3.0;
  char text[300];
  std::snprintf(text, sizeof text, "x,y\n%f,%f\n%f,%f\n%f,%f\n%f,%f\n", a.x(), a.y(), a.x(), b.y(),
                b.x(), b.y(), b.x(), a.y());
  const fs::path folder = folder_->path() / "bounded";
  const auto result =
      run_vinerow("map " + cloud_ +
                  " --no-pictures --no-virtual-walls --cell 0.2 --export obj,glb,ply --scenario " +
                  (folder_->path() / "world.yaml").string() + " --boundary " +
                  folder_->file("boundary.csv", text) + " --out " + folder.string());
  ASSERT_EQ(result.status, 0) << result.output;
  const mapping::CloudMap bounded = mapping::load_map(folder);
  ASSERT_EQ(bounded.map.boundary_W.size(), 4u);
  Eigen::AlignedBox2d parcel;
  for (const Eigen::Vector2d& p : bounded.map.boundary_W) parcel.extend(p);
  EXPECT_LT((parcel.min() - a).norm(), 2e-6);
  EXPECT_LT((parcel.max() - b).norm(), 2e-6);
  EXPECT_GT(signed_area_m2(bounded.map.boundary_W), 0.0) << "counter-clockwise";
  // The grid covers the parcel, with at most two cells to spare on either side.
  EXPECT_GE(bounded.map.occupancy.columns * 0.2, b.x() - a.x());
  EXPECT_LE(bounded.map.occupancy.columns * 0.2, b.x() - a.x() + 4 * 0.2);
  EXPECT_TRUE(std::none_of(bounded.report.notes.begin(), bounded.report.notes.end(),
                           [](const std::string& note) {
                             return note.find("no boundary was given") != std::string::npos;
                           }));
  EXPECT_FALSE(fs::exists(folder / "pictures"));
  // Every mesh is an object of its own in the files for other programs.
  const std::string obj = test::read_text(folder / "rows.obj");
  std::size_t objects = 0, faces = 0, triangles = 0;
  for (std::size_t at = 0; (at = obj.find('\n', at)) != std::string::npos; ++at) {
    objects += obj.compare(at + 1, 2, "o ") == 0;
    faces += obj.compare(at + 1, 2, "f ") == 0;
  }
  for (const RowMesh& mesh : bounded.map.meshes) triangles += mesh.mesh_W.triangles.size();
  EXPECT_EQ(objects, bounded.map.meshes.size());
  EXPECT_EQ(faces, triangles);
  EXPECT_EQ(test::read_text(folder / "rows.glb").substr(0, 4), "glTF");
  EXPECT_NE(test::read_text(folder / "rows.ply").find("element face " + std::to_string(triangles)),
            std::string::npos);
  EXPECT_EQ(bounded.map.occupancy.cell_m, 0.2);
}

TEST_F(MapCommand, PrintsTheSchemasOfItsFiles) {
  const auto map = run_vinerow("schema map.json"), report = run_vinerow("schema report.json");
  EXPECT_EQ(json::parse(map.output)["title"], "Vinerow map: map.json");
  EXPECT_EQ(json::parse(report.output)["title"], "Vinerow map: report.json");
  EXPECT_EQ(run_vinerow("schema cloud").status, 2);
}

TEST_F(MapCommand, RefusesInOneSentence) {
  const std::string out = " --out " + (folder_->path() / "refused").string();
  expect_refused("map none.las" + out, "none.las");
  expect_refused("map " + cloud_ + " --origin 91,8" + out, "--origin: 91,8 must be latitude");
  expect_refused("map " + cloud_ + " --origin 44" + out, "--origin: must be latitude,longitude");
  expect_refused("map " + cloud_ + " --origin 44,8 --scenario x.yaml" + out,
                 "give either --origin or --scenario, not both");
  expect_refused("map " + cloud_ + " --truth none.json" + out, "none.json");
  expect_refused("map " + cloud_ + " --boundary none.csv" + out,
                 "--boundary: 'none.csv' does not exist");
  expect_refused("map " + cloud_ + " --spacing 3" + out,
                 "--spacing: row_spacing_m has 1 entries, must have 2");
  expect_refused(
      "map " + cloud_ + " --boundary " + folder_->file("bow.csv", "0,0\n10,10\n10,0\n0,10\n") + out,
      "crosses its edge from point");
  expect_refused("map " + cloud_ + " --out /proc/none/map",
                 "folder '/proc/none/map' cannot be created");
  EXPECT_FALSE(fs::exists(folder_->path() / "refused")) << "an empty folder stays";
}

TEST_F(MapCommand, FindsNoRowsInAMeadow) {
  // Grass up to 30 cm on a slope, 40 points a square metre.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(0.0, 40.0), grass(0.0, 0.3);
  std::string text = "x y z\n";
  for (int k = 0; k < 64'000; ++k) {
    const double x = place(random), y = place(random);
    char line[80];
    std::snprintf(line, sizeof line, "%.3f %.3f %.3f\n", x, y, 0.1 * x + grass(random));
    text += line;
  }
  expect_refused("map " + folder_->file("meadow.xyz", text) + " --out " +
                     (folder_->path() / "meadow").string(),
                 "no rows found");
  EXPECT_FALSE(fs::exists(folder_->path() / "meadow"));
}

}  // namespace
}  // namespace vinerow::map_command_test
