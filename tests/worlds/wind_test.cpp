/// The group `wind` of every built-in world: what becomes of its values, and what is refused.

#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include "engine/math/angles.h"
#include "tests/support/folder_test.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/parts/common.h"

namespace vinerow::wind_test {
namespace {

using Groups = std::vector<ParameterSet>;

/// Parameters that make a small world of each kind.
ParameterSet small_parameters(const std::string& type) {
  ParameterSet parameters = test::world_parameters(type);
  if (type == "vineyard") {
    parameters.set("row_count", 3.0).set("row_length_m", 20.0).set("relief_m", 2.0);
  } else if (type == "orchard") {
    parameters.set("plant_rows", 2.0).set("row_length_m", 20.0);
  } else if (type == "surveyed") {
    parameters.set("survey_file", test::riseholme_file());
  } else {
    ParameterSet item = parameters.make_group("items");
    item.set("file", test::temporary_file("cube_in_the_wind.obj", test::cube_obj()));
    parameters.set("items", Groups{item});
  }
  return parameters;
}

class WorldWind : public ::testing::TestWithParam<std::string> {
 protected:
  WorldWind() : parameters_(small_parameters(GetParam())), wind_(parameters_.make_group("wind")) {}
  std::unique_ptr<WorldModel> build() {
    parameters_.set("wind", Groups{wind_});
    return test::make_world(GetParam(), parameters_);
  }
  ParameterSet gust(double at_s, double amplitude_mps) {
    ParameterSet one = wind_.make_group("gusts");
    one.set("at_s", at_s).set("amplitude_mps", amplitude_mps);
    return one;
  }
  std::string error() {
    return test::config_error_of([this] { build(); });
  }
  ParameterSet parameters_, wind_;
};

TEST_P(WorldWind, IsCalmUnlessGiven) {
  const auto calm = test::make_world(GetParam(), parameters_);
  EXPECT_TRUE(calm->wind.calm());
  EXPECT_FALSE(calm->wind.air_density_kgm3);  // what the origin's altitude gives
}

TEST_P(WorldWind, ReadsShearLimitAndAtmosphere) {
  const Wind plain = build()->wind;
  EXPECT_EQ(plain.atmosphere, Atmosphere::kConstant);
  EXPECT_EQ(plain.turbulence_limit_mps, 0.0);
  wind_.set("height_law", std::string("linear")).set("ground_speed_mps", -6.0);
  wind_.set("turbulence_limit_mps", 1.0).set("atmosphere", std::string("us76"));
  const Wind wind = build()->wind;
  EXPECT_EQ(wind.height_law, WindHeightLaw::kLinear);
  EXPECT_EQ(wind.ground_speed_mps, -6.0);
  EXPECT_EQ(wind.turbulence_limit_mps, 1.0);
  EXPECT_EQ(wind.atmosphere, Atmosphere::kStandard76);
}

TEST_P(WorldWind, ReadsEveryValue) {
  wind_.set("mean_speed_mps", 3.0).set("from_deg", 250.0).set("reference_height_m", 8.0);
  wind_.set("height_law", std::string("power")).set("roughness_length_m", 0.03);
  wind_.set("power_exponent", 0.14).set("turbulence", 0.5).set("turbulence_wind_mps", 4.0);
  wind_.set("shelter", 1.2).set("air_density_kgm3", 1.1);
  ParameterSet front = gust(7.0, 2.0);
  front.set("duration_s", 3.0).set("from_deg", -90.0).set("vertical_mps", -0.5);
  front.set("front_speed_mps", 6.0);
  wind_.set("gusts", Groups{gust(5.0, 1.0), front});
  ParameterSet random = wind_.make_group("random_gusts");
  random.set("interval_s", 20.0).set("amplitude_mps", 1.5).set("duration_s", 4.0);
  wind_.set("random_gusts", Groups{random});
  const Wind wind = build()->wind;
  EXPECT_EQ(wind.mean_speed_mps, 3.0);
  EXPECT_EQ(wind.from_azimuth_rad, rad_from_deg(250.0));
  EXPECT_EQ(wind.reference_height_m, 8.0);
  EXPECT_EQ(wind.height_law, WindHeightLaw::kPower);
  EXPECT_EQ(wind.roughness_length_m, 0.03);
  EXPECT_EQ(wind.power_exponent, 0.14);
  EXPECT_EQ(wind.turbulence, 0.5);
  EXPECT_EQ(wind.turbulence_wind_mps, 4.0);
  EXPECT_EQ(wind.shelter_attenuation, 1.2);
  EXPECT_EQ(wind.air_density_kgm3, 1.1);
  ASSERT_EQ(wind.gusts.size(), 2u);
  EXPECT_EQ(wind.gusts[0].start_s, 5.0);
  EXPECT_EQ(wind.gusts[0].duration_s, 2.0);
  EXPECT_EQ(wind.gusts[0].amplitude_mps, 1.0);
  EXPECT_EQ(wind.gusts[0].from_azimuth_rad, std::nullopt);  // as the wind
  EXPECT_EQ(wind.gusts[1].from_azimuth_rad, rad_from_deg(-90.0));
  EXPECT_EQ(wind.gusts[1].vertical_mps, -0.5);
  EXPECT_EQ(wind.gusts[1].front_speed_mps, 6.0);
  ASSERT_TRUE(wind.random_gusts);
  EXPECT_EQ(wind.random_gusts->interval_s, 20.0);
  EXPECT_EQ(wind.random_gusts->amplitude_mps, 1.5);
  EXPECT_EQ(wind.random_gusts->duration_s, 4.0);
  EXPECT_EQ(wind.random_gusts->seed, 1u);  // the run's
}

TEST_P(WorldWind, RefusesValuesThatDoNotFitTogether) {
  wind_.set("mean_speed_mps", 3.0).set("roughness_length_m", 12.0);
  EXPECT_EQ(error(), "wind: roughness_length_m = 12 m, must be < reference_height_m = 10 m");
  wind_.set("roughness_length_m", 0.1);
  ParameterSet random = wind_.make_group("random_gusts");
  random.set("interval_s", 2.0).set("duration_s", 3.0);
  wind_.set("random_gusts", Groups{random});
  EXPECT_EQ(
      error(),
      "wind: random_gusts: interval_s = 2 s, must be > duration_s = 3 s, because random gusts do "
      "not overlap");
}

TEST_P(WorldWind, RefusesValuesOutOfRange) {
  const auto refusal = [](ParameterSet& set, const char* name, ParameterSet::Value value) {
    return test::config_error_of([&] { set.set(name, std::move(value)); });
  };
  EXPECT_EQ(refusal(wind_, "mean_speed_mps", -3.0),
            "mean_speed_mps = -3 m/s, must be >= 0 m/s and <= 100 m/s");
  EXPECT_EQ(refusal(wind_, "roughness_length_m", 0.0), "roughness_length_m = 0 m, must be > 0 m");
  EXPECT_EQ(refusal(wind_, "turbulence", -0.1), "turbulence = -0.1, must be >= 0 and <= 10");
  EXPECT_EQ(refusal(wind_, "shelter", 7.0), "shelter = 7, must be >= 0 and <= 5");
  EXPECT_EQ(refusal(wind_, "air_density_kgm3", 0.0),
            "air_density_kgm3 = 0 kg/m3, must be > 0 kg/m3 and <= 100 kg/m3");
  EXPECT_EQ(refusal(wind_, "air_density_kgm3", 1e15),
            "air_density_kgm3 = 1000000000000000 kg/m3, must be > 0 kg/m3 and <= 100 kg/m3");
  EXPECT_EQ(refusal(wind_, "height_law", std::string("log")),
            "height_law = 'log', must be one of: uniform, logarithmic, power, linear");
  ParameterSet one = gust(0.0, 1.0);
  EXPECT_EQ(refusal(one, "duration_s", 0.0), "duration_s = 0 s, must be > 0 s");
  EXPECT_EQ(refusal(one, "amplitude_mps", -1.0),
            "amplitude_mps = -1 m/s, must be >= 0 m/s and <= 100 m/s");
  ParameterSet half = wind_.make_group("gusts");
  half.set("at_s", 3.0);
  EXPECT_EQ(refusal(wind_, "gusts", Groups{half}),
            "gusts: amplitude_mps must be given (horizontal, in the middle of the pulse)");
}

TEST_P(WorldWind, TellsWhereTurbulenceHasNothingToScaleWith) {
  wind_.set("turbulence", 1.0);
  const auto world = build();
  ASSERT_FALSE(world->notes.empty());
  EXPECT_NE(std::find(world->notes.begin(), world->notes.end(),
                      "wind.turbulence has no wind to scale with and is left out; give "
                      "wind.mean_speed_mps or wind.turbulence_wind_mps"),
            world->notes.end());
}

INSTANTIATE_TEST_SUITE_P(All, WorldWind,
                         ::testing::Values("orchard", "vineyard", "surveyed", "mesh"),
                         [](const auto& type) { return type.param; });

/// A folder of its own: the cache of all tests also grows by what runs beside this one.
class VineyardWind : public test::FolderTest {
 protected:
  VineyardWind() : FolderTest("wind") {}
};

TEST_F(VineyardWind, ChangesNoMeshFile) {
  ParameterSet parameters = small_parameters("vineyard");
  parameters.set("mesh_folder", folder_.string());
  const auto count = [&] {
    return std::distance(std::filesystem::recursive_directory_iterator(folder_),
                         std::filesystem::recursive_directory_iterator());
  };
  test::make_world("vineyard", parameters);
  const auto before = count();
  ASSERT_GT(before, 1);
  ParameterSet wind = parameters.make_group("wind");
  wind.set("mean_speed_mps", 3.0);
  parameters.set("wind", Groups{wind});
  test::make_world("vineyard", parameters);
  EXPECT_EQ(count(), before);
}

}  // namespace
}  // namespace vinerow::wind_test
