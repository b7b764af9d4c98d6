#include "worlds/surveyed/surveyed.h"
#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/io/geo/geojson.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/parts/mesh_store.h"

namespace vinerow::worlds::surveyed_test {
namespace {

ParameterSet riseholme() {
  ParameterSet parameters = test::world_parameters("surveyed");
  parameters.set("survey_file", test::riseholme_file());
  parameters.set("origin_latitude_deg", 53.26810042662116);
  parameters.set("origin_longitude_deg", -0.5244249078498293);
  return parameters;
}

TEST(Surveyed, RiseholmeHasTheMeasuredFigures) {
  const auto world = test::make_world("surveyed", riseholme());
  EXPECT_TRUE(world->notes.empty());
  ASSERT_EQ(world->rows->rows.size(), 10u);
  ASSERT_EQ(world->rows->alleys.size(), 9u);
  for (const Alley& alley : world->rows->alleys) {
    // data/README.md: pitch 2.48 to 2.53 m, bearing 171.6 deg.
    EXPECT_GT(alley.width_m, 2.475);
    EXPECT_LT(alley.width_m, 2.535);
    const Eigen::Vector2d d = (alley.line_W.back() - alley.line_W.front()).head<2>();
    EXPECT_NEAR(deg_from_rad(std::atan2(d.x(), d.y())), 171.6, 0.3);
    EXPECT_NEAR(d.norm(), 17.0, 0.5);
  }
}

TEST(Surveyed, SurroundingsAreGroundAndNoParcel) {
  const auto near = test::make_world("surveyed", riseholme());
  ParameterSet parameters = riseholme();
  parameters.set("surroundings_m", 106.0).set("terrain_cell_m", 1.0);
  const auto wide = test::make_world("surveyed", parameters);
  EXPECT_EQ(wide->rows->boundary_W, near->rows->boundary_W);
  // 100 m more on both sides; a grid ends on whole cells, of 0.5 m and of 1 m.
  EXPECT_NEAR(wide->terrain->width_m(), near->terrain->width_m() + 200.0, 1.0);
  EXPECT_NEAR(wide->terrain->depth_m(), near->terrain->depth_m() + 200.0, 1.0);
}

TEST(Surveyed, MeshesAreReadBackUntilSomethingShapesOthers) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_surveyed_key_test";
  std::filesystem::remove_all(folder);
  const auto digest_of = [&](const std::string& name, const ParameterSet::Value& value) {
    ParameterSet parameters = riseholme();
    parameters.set("mesh_folder", folder.string()).set("leaf_cards_per_m", 20.0);
    parameters.set(name, value);
    const auto world = test::make_world("surveyed", parameters);
    Hasher hasher;
    for (const MeshInstance& m : world->meshes) hasher.add(mesh_digest(*m.mesh));
    return hasher.hex();
  };
  const auto count = [&] {
    return std::distance(std::filesystem::directory_iterator(folder),
                         std::filesystem::directory_iterator());
  };
  const std::string cold = digest_of("leaf_cards_per_m", 20.0);
  EXPECT_EQ(count(), 1);
  const auto file = *std::filesystem::recursive_directory_iterator(
      std::filesystem::directory_iterator(folder)->path());
  const auto written = std::filesystem::last_write_time(file);
  EXPECT_EQ(digest_of("sun_elevation_deg", 20.0), cold);
  EXPECT_EQ(count(), 1) << "light changes no mesh";
  EXPECT_EQ(std::filesystem::last_write_time(file), written) << "written again";
  EXPECT_NE(digest_of("canopy_width_m", 0.7), cold);
  EXPECT_NE(digest_of("plant_seed", std::int64_t{2}), cold);
  EXPECT_NE(digest_of("slope_deg", 3.0), cold);
  EXPECT_EQ(count(), 4);
  std::filesystem::remove_all(folder);
}

TEST(Surveyed, MiddleLinesAgreeWithTheAuthorsMidRowLines) {
  VINEROW_OUTSIDE_DATA(file, "vineyard_detection/data/mid_row_lines.geojson");
  const auto world = test::make_world("surveyed", riseholme());
  const LocalFrame frame(world->origin);
  const auto lines = io::read_survey(file, "mid_row_line").rows;
  ASSERT_EQ(lines.size(), 9u);
  for (const io::GeoFeature& line : lines) {
    double best_m = 1e9;
    const Eigen::Vector2d middle = 0.5 * (frame.to_local(line.points.front()).head<2>() +
                                          frame.to_local(line.points.back()).head<2>());
    for (const Alley& alley : world->rows->alleys) {
      const Eigen::Vector2d a = alley.line_W.front().head<2>();
      const Eigen::Vector2d d = (alley.line_W.back().head<2>() - a).normalized();
      const Eigen::Vector2d r = middle - a;
      best_m = std::min(best_m, std::abs(d.x() * r.y() - d.y() * r.x()));
    }
    // Theirs come from drone-detected poles (median error 0.21 m) and are rounded to 1e-6 deg (0.11
    // m).
    EXPECT_LT(best_m, 0.25);
  }
}

TEST(Surveyed, EveryVineAndPoleStandsWhereItWasMeasured) {
  const auto world = test::make_world("surveyed", riseholme());
  const LocalFrame frame(world->origin);
  std::vector<Eigen::Vector3f> trunks;
  for (const MeshInstance& m : world->meshes) {
    if (m.surface == SurfaceClass::kTrunk && m.collides) {
      trunks.insert(trunks.end(), m.mesh->vertices.begin(), m.mesh->vertices.end());
    }
  }
  const io::SurveyFile survey = io::read_survey(test::riseholme_file());
  ASSERT_EQ(survey.vines.size(), 120u);
  ASSERT_EQ(survey.poles.size(), 40u);
  for (const io::GeoFeature& vine : survey.vines) {
    const Eigen::Vector2d p = frame.to_local(vine.points[0]).head<2>();
    double best_m = 1e9;
    for (const Eigen::Vector3f& v : trunks) {
      const double above_m = v.z() - world->terrain->height_m(v.x(), v.y());
      if (above_m < 0.1) best_m = std::min(best_m, (v.head<2>().cast<double>() - p).norm());
    }
    // Vines are put onto the straight row: they stand up to 6 cm beside it, and a stem has 4 cm
    // radius at its foot.
    EXPECT_LT(best_m, 0.12) << vine.property("name");
  }
}

TEST(Surveyed, AuthorsOwnFileLoadsAsWell) {
  VINEROW_OUTSIDE_DATA(file, "vineyard_detection/data/vineyard_poles_and_rows.geojson");
  ParameterSet parameters = riseholme();
  parameters.set("survey_file", file.string());
  const auto world = test::make_world("surveyed", parameters);
  EXPECT_EQ(world->rows->rows.size(), 10u);
}

TEST(Surveyed, RefusesBadInputInOneSentence) {
  const auto error_of = [](const std::string& file) {
    return test::config_error_of([&] {
      ParameterSet parameters = test::world_parameters("surveyed");
      parameters.set("survey_file", file);
      test::make_world("surveyed", parameters);
    });
  };
  EXPECT_EQ(error_of("/none.geojson"), "GeoJSON file '/none.geojson' does not exist");
  const std::string points = test::temporary_file(
      "points.geojson",
      R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}}]})");
  EXPECT_NE(error_of(points).find("has no LineString (1 points"), std::string::npos);
  const std::string zero =
      test::temporary_file("zero.geojson", R"({"type":"LineString","coordinates":[[1,2],[1,2]]})");
  EXPECT_EQ(error_of(zero), "'" + zero + "', feature 0: the row has no length");
  // There and back over a tenth of a degree of latitude.
  const std::string detour = test::temporary_file(
      "detour.geojson", R"({"type":"LineString","coordinates":[[1,2],[1,2.1],[1.001,2]]})");
  EXPECT_EQ(error_of(detour),
            "'" + detour + "', feature 0: the row is 22.1 km long, must be at most 5 km");
  const std::string far = test::temporary_file(
      "far.geojson",
      R"({"type":"MultiLineString","coordinates":[[[1,2],[1,2.0001]],[[50,2],[50,2.0001]]]})");
  EXPECT_NE(error_of(far).find("km from the world's origin, must be within 20 km"),
            std::string::npos);
  EXPECT_NE(test::config_error_of([] {
              test::make_world("surveyed", test::world_parameters("surveyed"));
            }).find("survey_file must be given"),
            std::string::npos);
}

/// Half of the roofs' width from each row: they would overlap.
TEST(Surveyed, PergolasWiderThanTheNarrowestAlleyAreRefused) {
  // At 45 degrees of latitude, 2e-5 degrees of longitude are 1.57694 m on the WGS84 ellipsoid.
  const std::string file = test::temporary_file("narrow.geojson",
                                                R"({"type":"MultiLineString","coordinates":[
        [[8.0,45.0],[8.0,45.0001]],[[8.00002,45.0],[8.00002,45.0001]]]})");
  ParameterSet parameters = test::world_parameters("surveyed");
  parameters.set("survey_file", file);
  ParameterSet vines = parameters.make_group("vines");
  vines.set("pruning", std::string("pergola"));
  parameters.set("vines", std::vector<ParameterSet>{vines});
  const std::string error =
      test::config_error_of([&] { test::make_world("surveyed", parameters); });
  EXPECT_TRUE(error.starts_with("canopy_width_m = 2 m, must be <= the width of alley 0 = 1.5769"))
      << error;
  EXPECT_TRUE(error.ends_with(" m for a pergola")) << error;
  parameters.set("canopy_width_m", 1.5);
  EXPECT_EQ(test::make_world("surveyed", parameters)->rows->alleys.size(), 1u);

  // Of two alleys, of 2.4 m and of 1.58 m, the narrower one counts.
  parameters.set("canopy_width_m", 2.0)
      .set("survey_file", test::temporary_file("two_alleys.geojson",
                                               R"({"type":"MultiLineString","coordinates":[
        [[8.0,45.0],[8.0,45.0001]],[[8.00003,45.0],[8.00003,45.0001]],[[8.00005,45.0],[8.00005,45.0001]]]})"));
  const std::string of_two =
      test::config_error_of([&] { test::make_world("surveyed", parameters); });
  EXPECT_TRUE(of_two.starts_with("canopy_width_m = 2 m, must be <= the width of alley 1 = 1.5769"))
      << of_two;
}

TEST(Surveyed, PointsFarFromEveryRowAreNoted) {
  const std::string file = test::temporary_file("stray.geojson",
                                                R"({"type":"FeatureCollection","features":[
        {"type":"Feature","properties":{"type":"row"},"geometry":{"type":"LineString","coordinates":[[8.0,45.0],[8.0,45.0002]]}},
        {"type":"Feature","properties":{"type":"vine"},"geometry":{"type":"Point","coordinates":[8.001,45.0001]}}]})");
  ParameterSet parameters = test::world_parameters("surveyed");
  parameters.set("survey_file", file);
  const auto world = test::make_world("surveyed", parameters);
  ASSERT_EQ(world->notes.size(), 1u);
  EXPECT_NE(world->notes[0].find("1 vine left out: farther than 1.00 m from every row"),
            std::string::npos)
      << world->notes[0];
}

TEST(Surveyed, FeaturesWithoutAMeaningAreNoted) {
  const std::string file = test::temporary_file("field.geojson",
                                                R"({"type":"FeatureCollection","features":[
        {"type":"Feature","properties":{"type":"row"},"geometry":{"type":"LineString","coordinates":[[8.0,45.0],[8.0,45.0002]]}},
        {"type":"Feature","properties":{"name":"hydrant"},"geometry":{"type":"Point","coordinates":[8.001,45.0001]}},
        {"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[8.001,45.0002]}},
        {"type":"Feature","properties":{"type":"parcel"},"geometry":{"type":"Polygon","coordinates":[[[8,45],[8.001,45],[8.001,45.001],[8,45]]]}}]})");
  ParameterSet parameters = test::world_parameters("surveyed");
  parameters.set("survey_file", file);
  const auto world = test::make_world("surveyed", parameters);
  EXPECT_EQ(
      world->notes,
      (std::vector<std::string>{
          file + ": 1 polygon left out: the parcel's border runs headland_m around the rows",
          file + ": 2 points left out: neither type nor name says vine, tree, pole or post"}));
}

}  // namespace
}  // namespace vinerow::worlds::surveyed_test
