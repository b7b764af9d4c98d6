/// Ranging sensors in the surveyed vineyard of Riseholme: how many rays a cone needs, and whether
/// what a scanner sees are the posts and vines that were measured there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/io/geo/geojson.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "engine/physics/world_scene.h"
#include "tests/engine/sensors/post_detector.h"
#include "tests/engine/sensors/ranging_bench.h"
#include "tests/support/data.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::sensors::ranging_vineyard_test {
namespace {

struct Riseholme {
  std::unique_ptr<WorldModel> world;
  std::unique_ptr<physics::WorldScene> scene;
};

const Riseholme& riseholme() {
  static const Riseholme place = [] {
    ParameterSet parameters = test::world_parameters("surveyed");
    parameters.set("survey_file", test::riseholme_file());
    parameters.set("origin_latitude_deg", 53.26810042662116);
    parameters.set("origin_longitude_deg", -0.5244249078498293);
    Riseholme result;
    result.world = test::make_world("surveyed", parameters);
    result.scene = std::make_unique<physics::WorldScene>(*result.world);
    return result;
  }();
  return place;
}

/// Level, heading along the alley, `share` of the way down it, `aside_m` left of its middle.
Pose in_alley(std::size_t alley, double share, double height_m, double aside_m = 0.0) {
  const auto& line = riseholme().world->rows->alleys.at(alley).line_W;
  const Eigen::Vector2d a = line.front().head<2>(), b = line.back().head<2>();
  const Eigen::Vector2d direction = (b - a).normalized();
  const Eigen::Vector2d p =
      a + share * (b - a) + aside_m * Eigen::Vector2d(-direction.y(), direction.x());
  const double ground_m = riseholme().world->terrain->height_m(p.x(), p.y());
  return {quaternion_from_rpy({0, 0, std::atan2(direction.y(), direction.x())}),
          {p.x(), p.y(), ground_m + height_m}};
}

struct ConeError {
  double mean_m = 0.0;
  double max_m = 0.0;
  double p95_m = 0.0;
};

/// First return of a bundle of `rings` minus that of 4,921 rays, at 240 poses in all alleys.
ConeError error_on_the_canopy(int rings) {
  std::vector<double> errors;
  for (const double yaw_deg : {45.0, 90.0, 135.0}) {
    const test::SensorValues mounting = {{"rotation_deg", std::vector<double>{0, 0, yaw_deg}},
                                         {"noise_std_m", 0.0}};
    test::SensorValues dense = mounting, sparse = mounting;
    dense.emplace_back("rings", std::int64_t{40});
    sparse.emplace_back("rings", std::int64_t{rings});
    test::RangingBench<RangeSample> all("ultrasound", dense, *riseholme().scene),
        few("ultrasound", sparse, *riseholme().scene);
    for (int i = 0; i < 80; ++i) {
      const Pose X_WB = in_alley(i % 9, 0.1 + 0.01 * i, 1.2, 0.005 * (i - 40));
      all.place(X_WB), few.place(X_WB);
      errors.push_back(few.step().range_m - all.step().range_m);
    }
  }
  std::sort(errors.begin(), errors.end());
  ConeError result;
  for (const double error : errors) result.mean_m += error / static_cast<double>(errors.size());
  result.max_m = errors.back();
  result.p95_m = errors[errors.size() * 95 / 100];
  return result;
}

TEST(RangingInAVineyard, TheConeOfADeviceFindsTheFirstReturnOnACanopy) {
  const auto rings = static_cast<int>(test::data_sheet("hc_sr04").parameters.integer("rings"));
  const ConeError error = error_on_the_canopy(rings);
  // Measured: mean 1.1 mm with 2 rings, 0.5 mm with 4, 0.3 mm with 6; 95 % within 5.4, 2.0, 1.1 mm.
  // The sensor's own accuracy is 3 mm.
  EXPECT_GE(error.mean_m, 0.0);
  EXPECT_LT(error.mean_m, 0.001);
  EXPECT_LT(error.p95_m, 0.003);
  EXPECT_LT(error.max_m, 0.01);
}

std::vector<Eigen::Vector2d> in_plane(const std::vector<io::GeoFeature>& features) {
  const LocalFrame frame(riseholme().world->origin);
  std::vector<Eigen::Vector2d> points;
  for (const io::GeoFeature& feature : features)
    points.push_back(frame.to_local(feature.points.front()).head<2>());
  return points;
}

/// Distances from each point to the nearest of others, ascending.
std::vector<double> nearest_m(const std::vector<Eigen::Vector2d>& points,
                              const std::vector<Eigen::Vector2d>& others) {
  std::vector<double> distances;
  for (const Eigen::Vector2d& p : points) {
    double best_m = 1e9;
    for (const Eigen::Vector2d& other : others) best_m = std::min(best_m, (p - other).norm());
    distances.push_back(best_m);
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

/// Drives a scanner, 0.3 m above the ground and level, down every other alley, a scan each 0.2 m.
std::vector<Eigen::Vector2d> detect_posts(const std::string& name) {
  test::RangingBench<LaserScan> bench(test::data_sheet(name), *riseholme().scene);
  test::PostDetector detector;
  for (std::size_t alley = 0; alley < riseholme().world->rows->alleys.size(); alley += 2) {
    for (int i = 0; i <= 85; ++i) {
      bench.place(in_alley(alley, i / 85.0, 0.3));
      detector.add(bench.step());
    }
  }
  std::vector<Eigen::Vector2d> found;
  for (const test::PostDetector::Post& post : detector.posts(5)) found.push_back(post.p_W);
  return found;
}

// The survey's poles and vines are RTK points; the authors' own detector, on pictures taken by a
// drone, had a median error of 0.21 m and a largest of 1.05 m. Here the scanner's pose is the true
// one, and the world stands off the survey by itself: vines up to 6 cm beside, as they are put onto
// the straight row, end posts 6 cm along it, as they lean (12 deg, 0.3 m above the ground); stems
// are crooked by up to 5 cm. A post and a vine's stem are both 60 mm thick: such scans cannot
// distinguish them.
TEST(RangingInAVineyard, WhatAScannerSeesAreTheSurveyedPolesAndVines) {
  const io::SurveyFile survey = io::read_survey(test::riseholme_file());
  const std::vector<Eigen::Vector2d> poles = in_plane(survey.poles), vines = in_plane(survey.vines);
  std::vector<Eigen::Vector2d> all = poles;
  all.insert(all.end(), vines.begin(), vines.end());
  ASSERT_EQ(all.size(), 160u);
  for (const std::string name : {"hokuyo_ust10lx", "sick_tim571"}) {
    const std::vector<Eigen::Vector2d> found = detect_posts(name);
    const std::vector<double> from_poles = nearest_m(poles, found),
                              from_vines = nearest_m(vines, found),
                              from_found = nearest_m(found, all);
    std::printf(
        "%s: poles median %.3f m, most %.3f m; vines median %.3f m, most %.3f m; %zu found\n",
        name.c_str(), from_poles[poles.size() / 2], from_poles.back(), from_vines[vines.size() / 2],
        from_vines.back(), found.size());
    EXPECT_LT(from_poles[poles.size() / 2], 0.06) << name;
    EXPECT_LT(from_poles.back(), 0.1) << name;
    EXPECT_LT(from_vines[vines.size() / 2], 0.06) << name;
    EXPECT_LT(from_vines.back(), 0.12) << name;
    EXPECT_LT(from_found.back(), 0.12) << name << " found what is not there";
    EXPECT_EQ(found.size(), all.size()) << name;
  }
}

}  // namespace
}  // namespace vinerow::sensors::ranging_vineyard_test
