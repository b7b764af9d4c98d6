#include "engine/sensors/scan_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/core/constants.h"
#include "engine/math/angles.h"

namespace vinerow::sensors::scan_pattern_test {
namespace {

double azimuth_deg(const LaserPulse& pulse) {
  return deg_from_rad(std::atan2(pulse.dir_S.y(), pulse.dir_S.x()));
}
double elevation_deg(const LaserPulse& pulse) {
  return deg_from_rad(std::asin(pulse.dir_S.z()));
}

/// Its laser fires every 55.296 us, by a clock.
ScanPatternParams vlp16() {
  ScanPatternParams params;
  params.column_s = 55.296e-6;
  params.firing_s = 36.864e-6;
  return params;
}

TEST(ScanPattern, OfTheVlp16FiresAsItsManualHasIt) {
  const auto pattern = make_scan_pattern(vlp16(), 0.1, "s");
  const auto pulses = pattern->pulses(0);
  // 100 ms hold 1808 columns of 16 lasers and 24.8 us: 11 more pulses.
  ASSERT_EQ(pulses.size(), 28'939u);
  // Manual: laser 0 at -15 deg, laser 1 at +1 deg, ..., 15 at +15 deg, each 2.304 us after the
  // last.
  const double elevations[] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  for (int i = 0; i < 16; ++i) {
    EXPECT_NEAR(pulses[i].time_s, 2.304e-6 * i, 1e-12);
    EXPECT_NEAR(elevation_deg(pulses[i]), elevations[i], 1e-9);
    // Rings of drivers: 0 is the lowest laser.
    EXPECT_EQ(pulses[i].ring, static_cast<int>((elevations[i] + 15) / 2));
  }
  EXPECT_NEAR(pulses[16].time_s, 55.296e-6, 1e-12);
}

TEST(ScanPattern, OfTheVlp16HasTheSameClockAtEveryRate) {
  // Data sheet and manual: 5 to 20 Hz make steps of 0.1 to 0.4 degrees; 16 lasers every 55.296 us
  // are 289,352 points a second at any of them.
  for (const double rate_Hz : {5.0, 10.0, 20.0}) {
    const double period_s = 1.0 / rate_Hz;
    const auto pattern = make_scan_pattern(vlp16(), period_s, "s");
    std::size_t count = 0;
    for (int frame = 0; frame < 10 * rate_Hz; ++frame) {
      const auto pulses = pattern->pulses(static_cast<std::uint64_t>(frame));
      ASSERT_LE(pulses.size(), pattern->most_pulses());
      for (const LaserPulse& pulse : pulses) {
        // One train through all frames, whichever frame a pulse falls in.
        const double expected_s = static_cast<double>(count / 16) * 55.296e-6 +
                                  static_cast<double>(count % 16) * 2.304e-6;
        ASSERT_NEAR(frame * period_s + pulse.time_s, expected_s, 1e-9);
        ASSERT_LT(pulse.time_s, period_s);
        // Where the mirror is at that time.
        const double turned_deg = 180.0 - 360.0 * pulse.time_s / period_s;
        ASSERT_NEAR(wrap_angle(rad_from_deg(azimuth_deg(pulse) - turned_deg)), 0.0, 1e-9);
        ++count;
      }
    }
    EXPECT_NEAR(static_cast<double>(count), 2'893'519.0, 1.0) << rate_Hz;
    const auto pulses = pattern->pulses(0);
    EXPECT_NEAR(azimuth_deg(pulses[160]) - azimuth_deg(pulses[176]), 0.02 * rate_Hz,
                0.01 * 0.02 * rate_Hz);
  }
}

TEST(ScanPattern, LosesNoPulseOfALaserThatFiresLate) {
  // The last of two lasers fires half a column after the first.
  ScanPatternParams params;
  params.elevations_deg = {0.0, 1.0};
  params.columns = 1000;
  params.firing_s = 1e-4;
  const auto pulses = make_scan_pattern(params, 0.1, "s");
  ASSERT_EQ(pulses->pulses(0).size(), 2000u);
  EXPECT_NEAR(pulses->pulses(0).back().time_s, 0.09995, 1e-12);
}

TEST(ScanPattern, TurnsClockwiseFromBehind) {
  const auto pattern = make_scan_pattern(vlp16(), 0.1, "s");
  const auto pulses = pattern->pulses(0);
  EXPECT_NEAR(std::abs(azimuth_deg(pulses.front())), 180.0, 1e-9);
  const auto at = [&](double time_s) {
    return *std::lower_bound(pulses.begin(), pulses.end(), time_s,
                             [](const auto& pulse, double time) { return pulse.time_s < time; });
  };
  EXPECT_NEAR(azimuth_deg(at(0.025 - 1e-9)), 90.0, 0.01);   // left
  EXPECT_NEAR(azimuth_deg(at(0.05 - 1e-9)), 0.0, 0.01);     // ahead
  EXPECT_NEAR(azimuth_deg(at(0.075 - 1e-9)), -90.0, 0.01);  // right
}

TEST(ScanPattern, HasOffsetsAndAView) {
  ScanPatternParams params;
  params.elevations_deg = {0.0, 10.0};
  params.azimuth_offsets_deg = {0.0, 3.0};
  params.columns = 360;
  params.field_of_view_deg = 90.0;
  const auto pattern = make_scan_pattern(params, 0.1, "s");
  const auto pulses = pattern->pulses(0);
  ASSERT_EQ(pulses.size(), 182u);
  for (const LaserPulse& pulse : pulses) EXPECT_LE(std::abs(azimuth_deg(pulse)), 45.0 + 1e-9);
  // Of one column: the second laser looks 3 degrees further to the left.
  const auto same =
      std::adjacent_find(pulses.begin(), pulses.end(),
                         [](const auto& a, const auto& b) { return a.time_s == b.time_s; });
  ASSERT_NE(same, pulses.end());
  EXPECT_NEAR(azimuth_deg(*(same + 1)) - azimuth_deg(*same), 3.0, 1e-9);
}

TEST(ScanPattern, ARosetteCoversItsFieldAndNeverRepeats) {
  ScanPatternParams params;
  params.is_rosette = true;
  const auto pattern = make_scan_pattern(params, 0.1, "s");
  std::set<std::pair<long, long>> cells;  // of a quarter of a degree
  std::size_t last = 0;
  for (int frame = 0; frame < 10; ++frame) {
    const auto pulses = pattern->pulses(static_cast<std::uint64_t>(frame));
    ASSERT_EQ(pulses.size(), 20'000u);
    for (const LaserPulse& pulse : pulses) {
      EXPECT_GE(elevation_deg(pulse), -7.0 - 1e-9);
      EXPECT_LE(elevation_deg(pulse), 52.0 + 1e-9);
      cells.emplace(std::lround(4.0 * azimuth_deg(pulse)), std::lround(4.0 * elevation_deg(pulse)));
    }
    // Each frame goes where none has been.
    EXPECT_GT(cells.size(), last + 4000);
    last = cells.size();
  }
  double lowest = 90.0, highest = -90.0;
  for (const LaserPulse& pulse : pattern->pulses(3)) {
    lowest = std::min(lowest, elevation_deg(pulse));
    highest = std::max(highest, elevation_deg(pulse));
  }
  EXPECT_NEAR(lowest, -7.0, 0.1);
  EXPECT_NEAR(highest, 52.0, 0.1);
}

TEST(ScanPattern, ARosetteKeepsItsRateInPeriodsOfAnyLength) {
  ScanPatternParams params;
  params.is_rosette = true;
  params.pulses_per_s = 123'456.7;
  const auto pattern = make_scan_pattern(params, 0.1, "s");
  std::size_t count = 0;
  for (int frame = 0; frame < 100; ++frame) {
    for (const LaserPulse& pulse : pattern->pulses(static_cast<std::uint64_t>(frame))) {
      ASSERT_NEAR(frame * 0.1 + pulse.time_s, static_cast<double>(count) / 123'456.7, 1e-9);
      ++count;
    }
  }
  EXPECT_EQ(count, 1'234'567u);
}

}  // namespace
}  // namespace vinerow::sensors::scan_pattern_test
