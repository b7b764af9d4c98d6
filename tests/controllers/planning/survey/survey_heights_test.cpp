#include "controllers/planning/survey/survey_heights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/core/random.h"

namespace vinerow::test::survey_heights_test {
namespace {

using Eigen::Vector2d;

controllers::GroundHeight ground_of(double (*height_m)(double)) {
  return [height_m](const Vector2d& p) { return std::optional<double>(height_m(p.x())); };
}

struct Ramps {
  std::optional<controllers::GroundProfile> profile;
  std::vector<double> wanted_m;
  std::vector<int> points;

  double height_at(double x) const {
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const auto &a = profile->samples()[points[k]], &b = profile->samples()[points[k + 1]];
      if (x > b.distance_m) continue;
      const double share = (x - a.distance_m) / (b.distance_m - a.distance_m);
      return wanted_m[points[k]] + share * (wanted_m[points[k + 1]] - wanted_m[points[k]]);
    }
    return wanted_m.back();
  }
};

Ramps make_ramps(const controllers::GroundHeight& ground, const std::vector<Vector2d>& line,
                 double above_m, double error_m = 2.0, double slope = 0.12) {
  Ramps ramps;
  ramps.profile = std::move(controllers::GroundProfile::make(line, ground)).value();
  ramps.wanted_m = controllers::make_wanted_heights(*ramps.profile, above_m, slope);
  ramps.points = controllers::split_ramps(*ramps.profile, ramps.wanted_m, line.size(), error_m);
  return ramps;
}

double waves(double x) {
  return 6.5 * std::sin(x / 70.0) + 0.02 * x;
}

TEST(SurveyHeights, RampsMissTheTerrainByTheAllowedErrorOnly) {
  const Ramps ramps = make_ramps(ground_of(waves), {{0, 0}, {260, 0}, {900, 0}}, 150.0);
  double worst_m = 0.0;
  for (double x = 0.0; x <= 900.0; x += 0.1) {
    worst_m = std::max(worst_m, std::abs(ramps.height_at(x) - waves(x) - 150.0));
  }
  EXPECT_LE(worst_m, 2.0);
  EXPECT_GT(worst_m, 1.0);  // no more points than needed
  for (const int point : ramps.points) {
    const auto& sample = ramps.profile->samples()[point];
    EXPECT_NEAR(ramps.wanted_m[point], waves(sample.p_W.x()) + 150.0, 1e-9);
  }
}

TEST(SurveyHeights, LevelAndEvenGroundNeedsNoPoints) {
  const auto even = [](double x) { return 0.1 * x; };
  EXPECT_EQ(make_ramps(ground_of(even), {{0, 0}, {500, 0}, {900, 0}}, 45.0).points.size(), 3u);
}

/// Second implementation: breadth-first over all pairs of samples, each checked by itself.
TEST(SurveyHeights, TakesTheFewestPoints) {
  RandomStream random(3, "survey", "heights");
  for (int trial = 0; trial < 6; ++trial) {
    const double a = 3.0 + 5.0 * random.uniform(), b = 15.0 + 30.0 * random.uniform();
    const double c = 6.0 * random.uniform(), d = 6.28 * random.uniform();
    const controllers::GroundHeight ground = [=](const Vector2d& p) {
      return std::optional<double>(a * std::sin(p.x() / b + d) + c * std::sin(p.x() / 11.0));
    };
    const Ramps ramps = make_ramps(ground, {{0, 0}, {240, 0}}, 60.0, 2.0, 10.0);
    const auto& samples = ramps.profile->samples();
    const int n = static_cast<int>(samples.size());
    std::vector<int> fewest(n, 1 << 20);
    fewest[0] = 0;
    for (int j = 1; j < n; ++j) {
      for (int i = 0; i < j; ++i) {
        bool fits = true;
        for (int k = i + 1; k < j && fits; ++k) {
          const double share = (samples[k].distance_m - samples[i].distance_m) /
                               (samples[j].distance_m - samples[i].distance_m);
          const double ramp_m = ramps.wanted_m[i] + share * (ramps.wanted_m[j] - ramps.wanted_m[i]);
          fits = std::abs(ramp_m - ramps.wanted_m[k]) <= 0.98 * 2.0;
        }
        if (fits) fewest[j] = std::min(fewest[j], fewest[i] + 1);
      }
    }
    EXPECT_EQ(static_cast<int>(ramps.points.size()) - 1, fewest[n - 1]) << trial;
  }
}

TEST(SurveyHeights, FlyAboveWhatIsSteeperThanTheyMayClimb) {
  // A terrace of 20 m within 10 m of way.
  const auto terrace = [](double x) { return 20.0 * std::clamp((x - 300.0) / 10.0, 0.0, 1.0); };
  const Ramps ramps = make_ramps(ground_of(terrace), {{0, 0}, {600, 0}}, 50.0);
  for (std::size_t k = 0; k + 1 < ramps.points.size(); ++k) {
    const auto &a = ramps.profile->samples()[ramps.points[k]],
               &b = ramps.profile->samples()[ramps.points[k + 1]];
    const double slope = (ramps.wanted_m[ramps.points[k + 1]] - ramps.wanted_m[ramps.points[k]]) /
                         (b.distance_m - a.distance_m);
    EXPECT_LE(std::abs(slope), 0.12 + 1e-9);
  }
  for (double x = 0.0; x <= 600.0; x += 0.25) {
    EXPECT_GE(ramps.height_at(x), terrace(x) + 50.0 - 2.0) << x;
  }
  EXPECT_NEAR(ramps.height_at(0.0), 50.0, 1e-9);
  EXPECT_NEAR(ramps.height_at(600.0), 70.0, 1e-9);
  // Climbing 20 m at 12 % begins 167 m before the top.
  EXPECT_NEAR(ramps.height_at(310.0 - 100.0), 70.0 - 12.0, 2.0);
}

TEST(SurveyHeights, BeginAtTheStartAndClimbAtTheSlope) {
  const auto profile =
      controllers::GroundProfile::make({{0, 0}, {1000, 0}}, ground_of([](double) { return 0.0; }))
          .value();
  std::vector<double> wanted_m = controllers::make_wanted_heights(profile, 60.0, 0.12);
  EXPECT_NEAR(controllers::start_heights_at(profile, 0.0, 0.12, wanted_m), 500.0, 1.0);
  EXPECT_NEAR(wanted_m[profile.at_point(0)], 0.0, 1e-9);
  EXPECT_NEAR(wanted_m[200], 30.0, 0.1);
  EXPECT_NEAR(wanted_m.back(), 60.0, 1e-9);
  wanted_m = controllers::make_wanted_heights(profile, 60.0, 0.12);
  EXPECT_NEAR(controllers::start_heights_at(profile, 72.0, 0.12, wanted_m), 100.0, 1.0);
  wanted_m = controllers::make_wanted_heights(profile, 60.0, 0.01);
  EXPECT_TRUE(std::isinf(controllers::start_heights_at(profile, 0.0, 0.01, wanted_m)));
}

TEST(SurveyHeights, BeyondTheTerrainItsEdgeGoesOn) {
  const controllers::GroundHeight ground = [](const Vector2d& p) {
    return p.x() > 100.0 && p.x() < 200.0 ? std::optional(p.x()) : std::nullopt;
  };
  const auto profile = controllers::GroundProfile::make({{0, 0}, {300, 0}}, ground).value();
  EXPECT_NEAR(profile.samples().front().ground_m, 101.0, 1e-9);
  EXPECT_NEAR(profile.samples().back().ground_m, 199.0, 1e-9);
  EXPECT_EQ(profile.beyond_terrain(), 301 - 99);
  const auto none = controllers::GroundProfile::make({{0, 0}, {50, 0}}, ground);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.reason(), "there is no ground below any of it");
}

}  // namespace
}  // namespace vinerow::test::survey_heights_test
