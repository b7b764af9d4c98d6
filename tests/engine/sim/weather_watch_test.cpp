/// The window of weak wind, against closed forms of the mean of a 1-cosine gust.

#include "engine/api/world_model.h"
#include "engine/sim/weather_watch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::weather_watch_test {
namespace {

using Verdict = WeatherWatch::Verdict;

WorldModel windy(double mean_mps) {
  WorldModel world;
  world.wind.mean_speed_mps = mean_mps;
  world.wind.height_law = WindHeightLaw::kUniform;
  return world;
}

/// When the verdict fell, and which.
std::pair<double, Verdict> wait(const scenario::WeatherWindow& window, const WorldModel& world) {
  WeatherWatch watch(window, world);
  for (int k = 0; k < 1'000'000; ++k) {
    const Time now{k * 10'000'000ll};
    const Verdict verdict = watch.look(now);
    if (verdict != Verdict::kWait) return {0.01 * std::round(100.0 * now.s()), verdict};
  }
  return {-1.0, Verdict::kWait};
}

TEST(WeatherWatch, CalmAirIsAWindowOnceTheMeanIsThere) {
  EXPECT_EQ(wait({3.0, 10.0, 30.0, 0.0}, windy(2.9)), (std::pair{29.0, Verdict::kGo}));
}

TEST(WeatherWatch, TooMuchWindIsGivenUpAfterTheWait) {
  EXPECT_EQ(wait({3.0, 10.0, 30.0, 60.0}, windy(3.1)), (std::pair{90.0, Verdict::kGiveUp}));
}

TEST(WeatherWatch, TheHeightLawCounts) {
  WorldModel world = windy(6.0);
  world.wind.height_law = WindHeightLaw::kLogarithmic;  // 6 m/s at 10 m, z0 = 0.1 m: 3 m/s at 1 m
  EXPECT_EQ(wait({3.01, 1.0, 5.0, 0.0}, world).second, Verdict::kGo);
  EXPECT_EQ(wait({3.01, 10.0, 5.0, 0.0}, world).second, Verdict::kGiveUp);
}

TEST(WeatherWatch, AGustIsWaitedOut) {
  WorldModel world = windy(1.0);
  // From the mean wind's side: 1 + 4 (1 - cos(2 pi t / 100)) m/s for 100 s, 9 m/s at its top.
  world.wind.gusts = {{0.0, 100.0, 8.0, 0.0, 0.0, 0.0}};
  const double limit_mps = 3.0, over_s = 20.0;
  const auto mean_mps = [&](double end_s) {
    double sum = 0.0;
    for (int n = 0; n < 20; ++n) {
      const double t = end_s - n;
      sum += 1.0 + (t < 100.0 ? 4.0 * (1.0 - std::cos(2.0 * M_PI * t / 100.0)) : 0.0);
    }
    return sum / 20.0;
  };
  // It blows up within the first 20 s to a mean of 1.5 m/s already: a window of its own.
  ASSERT_LT(mean_mps(19.0), limit_mps);
  const auto begin = wait({1.2, 10.0, over_s, 600.0}, world);
  EXPECT_EQ(begin.second, Verdict::kGo);
  EXPECT_LE(mean_mps(begin.first), 1.2);
  EXPECT_GT(mean_mps(begin.first - 1.0), 1.2);
  EXPECT_GT(begin.first, 90.0);
}

}  // namespace
}  // namespace vinerow::weather_watch_test
