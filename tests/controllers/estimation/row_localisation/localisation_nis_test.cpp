// Normalised innovations squared of the estimators on a map of rows: those of the last echo and the
// last fix, so that their means over a run are chi-square means.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "controllers/estimation/row_localisation/distance_filter_law.h"
#include "controllers/estimation/row_localisation/map_localisation_law.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/controllers/estimation/row_localisation/localisation_bench.h"
#include "tests/controllers/estimation/row_localisation/wall_map.h"

namespace vinerow::test::localisation_nis_test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

/// Innovations (0.3, -0.2, 0.5) m with a variance of 0.04 m2 of the start and 1, 1, 2.25 m2 of the
/// fix.
constexpr double kFixNis = 0.09 / 1.04 + 0.04 / 1.04 + 0.25 / 2.29;
const Vector3d kFixStd_m(1.0, 1.0, 1.5);

TEST(LocalisationNis, OfADistanceFilterIsThatOfTheLastDatumTaken) {
  const WallBlock block;
  const RowMap map = make_wall_map(block);
  const controllers::RowMeshIndex index(map);
  controllers::RangeSensorModel left = make_range_sensor("left", 0.5 * kPi);
  left.bound_m = 0.03;
  controllers::DistanceFilterLaw law({}, map.accuracy, &index, {left});
  const Vector3d p_W(10, 1.25, 1);
  law.start(Time{}, p_W, 0.04 * Matrix3d::Identity());
  law.predict(Time{}, Vector3d::Zero(), Eigen::Quaterniond::Identity(), 0.0);
  EXPECT_EQ(law.range_nis(), 0.0);
  EXPECT_EQ(law.fix_nis(), 0.0);
  // A wall 1 m to the left, read as 1.1 m; R = 0.03^2 / 3.
  const controllers::RangeReading reading{0, 1.1, 4.0};
  law.take_ranges(Time{}, {&reading, 1});
  EXPECT_NEAR(law.range_nis(), 0.01 / (0.04 + 0.0003), 1e-6);
  const double range_nis = law.range_nis();
  // A refused one leaves it.
  const controllers::RangeReading refused{0, 3.0, 4.0};
  law.predict(Time{10'000'000}, Vector3d::Zero(), Eigen::Quaterniond::Identity(), 0.0);
  law.take_ranges(Time{10'000'000}, {&refused, 1});
  EXPECT_EQ(law.counters().echoes_gated, 1);
  EXPECT_EQ(law.range_nis(), range_nis);

  law.start(Time{}, p_W, 0.04 * Matrix3d::Identity());
  law.take_fix(Time{}, p_W + Vector3d(0.3, -0.2, 0.5), kFixStd_m, Vector3d::Zero());
  EXPECT_NEAR(law.fix_nis(), kFixNis, 1e-12);
  law.take_fix(Time{}, p_W + Vector3d(30, 0, 0), kFixStd_m, Vector3d::Zero());
  EXPECT_EQ(law.counters().fixes_gated, 1);
  EXPECT_NEAR(law.fix_nis(), kFixNis, 1e-12);
}

TEST(LocalisationNis, OfABankIsThatOfTheLikeliestFiltersLastDatum) {
  const WallBlock block;
  const RowMap map = make_wall_map(block);
  const controllers::RowMeshIndex index(map);
  controllers::RangeSensorModel left = make_range_sensor("left", 0.5 * kPi);
  left.bound_m = 0.03;
  controllers::MapLocalisationParams params;
  params.noise.fix_horizontal_m.std = params.noise.fix_vertical_m.std = 0.0;
  controllers::MapLocalisationLaw law(params, map, index, {left});
  const Vector3d p_W(10, 1.25, 1);
  law.start(Time{}, p_W, 0.04 * Matrix3d::Identity());
  law.predict(Time{}, Vector3d::Zero(), Eigen::Quaterniond::Identity());
  EXPECT_EQ(law.range_nis(), 0.0);
  EXPECT_EQ(law.fix_nis(), 0.0);
  law.correct_range(Time{}, 0, 1.1, 0.05);
  EXPECT_NEAR(law.range_nis(), 0.01 / (0.04 + 0.0003), 1e-6);
  const double range_nis = law.range_nis();
  law.predict(Time{10'000'000}, Vector3d::Zero(), Eigen::Quaterniond::Identity());
  law.correct_range(Time{10'000'000}, 0, 3.0, 0.05);
  EXPECT_EQ(law.counters().echoes_gated, 1);
  EXPECT_EQ(law.range_nis(), range_nis);

  law.start(Time{}, p_W, 0.04 * Matrix3d::Identity());
  law.predict(Time{}, Vector3d::Zero(), Eigen::Quaterniond::Identity());
  law.correct_fix(Time{}, p_W + Vector3d(0.3, -0.2, 0.5), kFixStd_m, Vector3d::Zero());
  EXPECT_NEAR(law.fix_nis(), kFixNis, 1e-12);
  law.correct_fix(Time{}, p_W + Vector3d(30, 0, 0), kFixStd_m, Vector3d::Zero());
  EXPECT_EQ(law.counters().fixes_gated, 1);
  EXPECT_NEAR(law.fix_nis(), kFixNis, 1e-12);
}

struct Moments {
  double mean, std;
};
Moments moments_of(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value, squares += value * value;
  const double n = static_cast<double>(values.size()), mean = sum / n;
  return {mean, std::sqrt(squares / n - mean * mean)};
}

TEST(LocalisationNis, HasTheMomentsOfChiSquareWhereTheErrorsAreAsStated) {
  // A vehicle that stands, and filters that know it: fixes are white, echoes uniform.
  const Values common = {{"range_bound_m", 0.05}, {"velocity_std_mps", 0.0}};
  const Values distance = {{"cone", false}, {"walk_m2_per_s", 1e-12}, {"huber_sigma", 0.0}};
  const Values bank = {{"cone_rays", std::int64_t{1}}, {"velocity_density_m_rts", 0.0},
                       {"heading_std_deg", 0.0},       {"heading_white_std_deg", 0.0},
                       {"fix_walk_std_m", 0.0},        {"huber_sigma", 100.0}};
  const WallBlock block;
  const RowMap map = make_wall_map(block);
  for (const std::string type : {"distance_filter", "map_localisation"}) {
    SCOPED_TRACE(type);
    Values values = type == "distance_filter" ? distance : bank;
    values.insert(values.end(), common.begin(), common.end());
    LocalisationBench bench(type, values, &map, {make_range_sensor("left", 0.5 * kPi)});
    RandomStream random(5, "test", "nis");
    Odometry at;
    at.X_WB.p = {10, 1.25, 1};
    std::vector<double> of_ranges, of_fixes;
    for (int tick = 0; tick < 4000; ++tick) {
      bench.write_motion(at, at);
      if (tick % 5 == 0) {
        bench.write_fix(
            at.X_WB.p + Vector3d(random.normal(), random.normal(), 1.5 * random.normal()),
            kFixStd_m);
      }
      if (tick % 2 == 0) bench.write_range(0, 1.0 + random.uniform(-0.05, 0.05));
      bench.step();
      if (tick % 5 == 0) of_fixes.push_back(bench.value("nis_gnss_position"));
      if (tick % 2 == 0) of_ranges.push_back(bench.value("nis_range"));
    }
    // Chi-square of 3: mean 3, variance 6. Four standard errors of 800.
    const Moments fixes = moments_of(of_fixes), ranges = moments_of(of_ranges);
    EXPECT_NEAR(fixes.mean, 3.0, 4.0 * std::sqrt(6.0 / 800));
    EXPECT_NEAR(fixes.std, std::sqrt(6.0), 0.6);
    // The square of a uniform error over its variance: mean 1, variance 4/5; 2000 of them.
    EXPECT_NEAR(ranges.mean, 1.0, 4.0 * std::sqrt(0.8 / 2000));
    EXPECT_NEAR(ranges.std, std::sqrt(0.8), 0.1);
  }
}

}  // namespace
}  // namespace vinerow::test::localisation_nis_test
