/// Flags of a command from a parameter table.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "tools/vinerow/table_flags.h"
#include "worlds/mapping/jobs/cloud_map_job_params.h"
#include "worlds/mapping/jobs/photogrammetry_job_params.h"

namespace vinerow::tools::table_flags_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Map {
  CLI::App app{"for tests"};
  std::shared_ptr<const ParameterSet> values =
      add_table_flags(app, mapping::cloud_map_job_table().specs(),
                      {.without = {"boundary"},
                       .names = {{"row_spacing_m", "--spacing"}},
                       .group = "Method",
                       .general = {"crs"}});
  mapping::CloudMapJobParams parse(const std::string& line) {
    app.parse(line);
    return mapping::cloud_map_job_table().read(*values, "");
  }
};

std::string refusal_of(const std::string& line) {
  try {
    Map().parse(line);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(TableFlags, NamesFlagsByTheirKeysWithoutUnits) {
  const auto name = [](const char* key, const char* unit) {
    ParameterSpec spec;
    spec.name = key;
    spec.unit = unit;
    return flag_name(spec);
  };
  EXPECT_EQ(name("slice_m", "m"), "--slice");
  EXPECT_EQ(name("density_per_m2", "1/m2"), "--density");
  EXPECT_EQ(name("wind_speed_mps", "m/s"), "--wind-speed");
  EXPECT_EQ(name("max_incidence_deg", "deg"), "--max-incidence");
  EXPECT_EQ(name("min_views", ""), "--min-views");
  EXPECT_EQ(name("swam", "m"), "--swam");
}

TEST(TableFlags, GivesTheTablesDefaults) {
  const mapping::CloudMapJobParams read = Map().parse("");
  const mapping::CloudMapJobParams plain;
  EXPECT_EQ(read.options.slice_m, plain.options.slice_m);
  EXPECT_EQ(read.options.corners, plain.options.corners);
  EXPECT_EQ(read.options.occupancy.virtual_walls, plain.options.occupancy.virtual_walls);
  EXPECT_EQ(read.options.occupancy.first_wall, plain.options.occupancy.first_wall);
  EXPECT_EQ(read.reading.thin, plain.reading.thin);

  CLI::App app;
  const auto values = add_table_flags(app, mapping::photogrammetry_job_table().specs(), {});
  app.parse("");
  const auto pictures = mapping::photogrammetry_job_table().read(*values, "").options;
  EXPECT_EQ(pictures.max_incidence_rad, mapping::PhotogrammetryOptions().max_incidence_rad);
  EXPECT_FALSE(pictures.density_per_m2.has_value());
}

TEST(TableFlags, TakesValuesOfEveryKind) {
  const mapping::CloudMapJobParams read = Map().parse(
      "--slice 0.2 --corners 6 --no-virtual-walls --first-wall last --row-spacing 2,3 --thin 4 "
      "--crs EPSG:32632");
  EXPECT_EQ(read.options.slice_m, 0.2);
  EXPECT_EQ(read.options.corners, 6);
  EXPECT_FALSE(read.options.occupancy.virtual_walls);
  EXPECT_EQ(read.options.occupancy.first_wall, mapping::RowEnd::kLast);
  EXPECT_EQ(read.options.spacing_low_m, 2.0);
  EXPECT_EQ(read.options.spacing_high_m, 3.0);
  EXPECT_EQ(read.reading.thin, 4u);
  EXPECT_EQ(read.reading.crs, "EPSG:32632");
  EXPECT_EQ(Map().parse("--spacing 1.5,3").options.spacing_low_m, 1.5);
  EXPECT_TRUE(Map().parse("--virtual-walls").options.occupancy.virtual_walls);

  CLI::App app;
  const auto values = add_table_flags(app, mapping::photogrammetry_job_table().specs(), {});
  app.parse("--area -1 2 3 4 5 6 --truth-classes");
  const auto pictures = mapping::photogrammetry_job_table().read(*values, "");
  EXPECT_THAT(pictures.area_m, ElementsAre(-1, 2, 3, 4, 5, 6));
  EXPECT_TRUE(pictures.file.truth_classes);
}

TEST(TableFlags, RefusesByTheLoadersSentence) {
  EXPECT_EQ(refusal_of("--slice 9"), "--slice: slice_m = 9 m, must be >= 0.02 m and <= 5 m");
  EXPECT_EQ(refusal_of("--spacing 3"), "--spacing: row_spacing_m has 1 entries, must have 2");
  EXPECT_THAT(refusal_of("--first-wall lst"),
              HasSubstr("--first-wall: first_wall = 'lst', must be one of: auto, first, last"));
  EXPECT_THROW(Map().parse("--boundary none"), CLI::ParseError) << "was left out";
  EXPECT_THROW(Map().parse("--slice wide"), CLI::ParseError);
}

TEST(TableFlags, SayUnitRangeAndDefaultInTheHelp) {
  Map map;
  const CLI::Option* slice = map.app.get_option("--slice");
  EXPECT_EQ(slice->get_description(),
            "distance between cross-sections before any is removed (m, [0.02, 5])");
  EXPECT_EQ(slice->get_default_str(), "0.14");
  EXPECT_EQ(slice->get_group(), "Method");
  EXPECT_NE(map.app.get_option("--crs")->get_group(), "Method");
  EXPECT_THAT(map.app.get_option("--first-wall")->get_description(),
              HasSubstr("(auto | first | last)"));
}

}  // namespace
}  // namespace vinerow::tools::table_flags_test
