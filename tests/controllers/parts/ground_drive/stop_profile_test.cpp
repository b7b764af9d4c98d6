#include "controllers/parts/ground_drive/stop_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/random.h"

namespace vinerow::controllers::stop_profile_test {
namespace {

constexpr double kStop_m = 20.0;
constexpr double kDt_s = 0.02;

/// A vehicle whose speed lags behind its command.
struct Stopping {
  double reached_m = 0.0, braking_mps2 = 0.0, time_s = 0.0;
};
Stopping stop(double deceleration_mps2, double speed_mps, double lag_s) {
  StopProfile profile(deceleration_mps2);
  profile.set_place(kStop_m);
  Stopping result;
  double v = speed_mps;
  for (; result.time_s < 100.0 && (v > 1e-4 || !profile.is_holding()); result.time_s += kDt_s) {
    const double wanted = std::min(profile.update(result.reached_m), speed_mps);
    const double before = v;
    v += (wanted - v) * (1.0 - std::exp(-kDt_s / lag_s));
    result.braking_mps2 = std::max(result.braking_mps2, (before - v) / kDt_s);
    result.reached_m += 0.5 * (before + v) * kDt_s;
  }
  return result;
}

TEST(StopProfile, EndsBeforeThePlaceAlsoWhereTheWheelsLag) {
  for (const double speed_mps : {0.3, 1.0, 2.0}) {
    for (const double lag_s : {0.02, 0.1, 0.25}) {
      const Stopping stopping = stop(0.5, speed_mps, lag_s);
      EXPECT_GT(stopping.reached_m, kStop_m - 0.15) << speed_mps << " m/s, lag " << lag_s;
      EXPECT_LT(stopping.reached_m, kStop_m) << speed_mps << " m/s, lag " << lag_s;
    }
  }
}

TEST(StopProfile, BrakesNoHarderThanAsked) {
  // Without lag: the even braking of v^2 = 2 a left, up to the last step to zero.
  const Stopping stopping = stop(0.5, 2.0, 1e-4);
  EXPECT_LT(stopping.braking_mps2, 3.5);  // 0.07 m/s to nothing within one cycle
  StopProfile profile(0.5);
  profile.set_place(kStop_m);
  double hardest_mps2 = 0.0;
  for (double s = 0.0; s < kStop_m - 0.15; s += 1e-3) {
    const double v = profile.update(s), w = profile.update(s + 1e-3);
    hardest_mps2 = std::max(hardest_mps2, 0.5 * (v * v - w * w) / 1e-3);
  }
  EXPECT_LE(hardest_mps2, 0.5 + 1e-6);
}

TEST(StopProfile, StaysInTheNoiseOfAnEstimateAndGoesOnWithThePlace) {
  StopProfile profile(0.5);
  profile.set_place(kStop_m);
  RandomStream random(1, "", "noise");
  EXPECT_EQ(profile.update(kStop_m - StopProfile::kShort_m), 0.0);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(profile.update(kStop_m - StopProfile::kShort_m + random.uniform(-0.14, 0.14)), 0.0);
  }
  EXPECT_TRUE(profile.is_holding());
  profile.set_place(kStop_m + 1.0);
  EXPECT_GT(profile.update(kStop_m - StopProfile::kShort_m), 0.0);
  EXPECT_FALSE(profile.is_holding());
  profile.set_place(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isinf(profile.update(kStop_m)));
}

TEST(StopProfile, StandsWhereItIsBeyondThePlace) {
  StopProfile profile(0.5);
  profile.set_place(-2.0);
  EXPECT_EQ(profile.update(0.0), 0.0);
  EXPECT_EQ(profile.left_m(), 0.0);
}

}  // namespace
}  // namespace vinerow::controllers::stop_profile_test
