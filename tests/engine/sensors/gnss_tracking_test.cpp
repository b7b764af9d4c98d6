/// What hides satellites, what weakens them, and when they serve again.

#include "engine/sensors/gnss_tracking.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/parameter_table.h"
#include "tests/engine/sensors/gnss_bench.h"

namespace vinerow::sensors::gnss_tracking_test {
namespace {

using Eigen::Vector3d;
using test::PlainScene;

constexpr double kStart_s = 771'717'600.0;  // 2024-06-15 10:00
constexpr double kMask_deg = 10.0;
const LeafAreaDensity kUsual(kUsualLeafAreaDensity_m2pm3);

GnssSky sky_of_barolo() {
  std::vector<CircularOrbit> orbits = gps_orbits();
  const std::vector<CircularOrbit> galileo = galileo_orbits();
  orbits.insert(orbits.end(), galileo.begin(), galileo.end());
  return {test::barolo(), orbits, kStart_s};
}

/// What tracks with the defaults, but without fading.
GnssView look(const SceneQuery& scene, const Vector3d& p_W, double time_s = 0.0,
              double jamming_dB = 0.0, const LeafAreaDensity& leaves = kUsual) {
  ParameterSet parameters(gnss_signal_table().specs(), "gnss");
  parameters.set("fading_share", 0.0);
  GnssTracking tracking(gnss_signal_table().read(parameters, "s"), sky_of_barolo(), scene, leaves,
                        0.2, true, RandomStream(1, "rover", "s"));
  return tracking.look(time_s, p_W, false, jamming_dB);
}

/// Directions of the satellites above the mask, hour by hour.
template <class Use>
void for_each_hour(Use&& use) {
  const GnssSky sky = sky_of_barolo();
  for (double time_s = 0.0; time_s < 86'400.0; time_s += 3'600.0) {
    std::vector<Vector3d> seen;
    for (std::size_t i = 0; i < sky.size(); ++i) {
      const Vector3d direction_W = sky.direction_W(i, time_s);
      if (direction_W.z() >= std::sin(rad_from_deg(kMask_deg))) seen.push_back(direction_W);
    }
    use(time_s, seen);
  }
}

TEST(GnssTracking, UnderAnOpenSkyItHearsAllAboveTheMask) {
  for_each_hour([](double time_s, const std::vector<Vector3d>& seen) {
    const GnssView view = look(PlainScene(), {0, 0, 1}, time_s);
    EXPECT_EQ(view.code.count(), static_cast<int>(seen.size())) << time_s;
    EXPECT_EQ(view.carrier.count(), static_cast<int>(seen.size())) << time_s;
  });
}

TEST(GnssTracking, AWallHidesWhatIsBehindIt) {
  PlainScene scene;
  scene.boxes.push_back({{2, -1e4, -1}, {3, 1e4, 5}, SurfaceClass::kPost});
  for_each_hour([&](double time_s, const std::vector<Vector3d>& seen) {
    // The upper edge of its front is 4 m higher than the antenna and 2 m away to the east.
    int open = 0;
    for (const Vector3d& d : seen) open += d.x() <= 0.0 || d.z() / d.x() > 4.0 / 2.0;
    EXPECT_EQ(look(scene, {0, 0, 1}, time_s).code.count(), open) << time_s;
  });
}

TEST(GnssTracking, LeavesTakeSoMuchPerMetreOfThem) {
  // An endless hedge of 2 m: 2 m / |d_x| of leaves for whatever is on its side.
  PlainScene scene;
  scene.boxes.push_back({{1, -1e5, -1}, {3, 1e5, 1e5}});
  int hidden_from_phase = 0, hidden_from_code = 0;
  for_each_hour([&](double time_s, const std::vector<Vector3d>& seen) {
    int code = 0, carrier = 0;
    for (const Vector3d& d : seen) {
      // Closed forms of gnss_tracking.h with the defaults: 38 to 48 dB-Hz, 6 dB/m, 20 and 32 dB-Hz.
      // What is farther than 1 km is not looked for.
      const double leaves_m = d.x() > 1e-3 ? 2.0 / d.x() : 0.0;
      const double cn0_dBHz = 38.0 + 10.0 * d.z() - 6.0 * leaves_m;
      ASSERT_GT(std::abs(cn0_dBHz - 20.0), 1e-3);
      code += cn0_dBHz >= 20.0, carrier += cn0_dBHz >= 32.0;
    }
    const GnssView view = look(scene, {0, 0, 1}, time_s);
    EXPECT_EQ(view.code.count(), code) << time_s;
    EXPECT_EQ(view.carrier.count(), carrier) << time_s;
    hidden_from_code += static_cast<int>(seen.size()) - code;
    hidden_from_phase += static_cast<int>(seen.size()) - carrier;
  });
  EXPECT_GT(hidden_from_code, 50);
  EXPECT_GT(hidden_from_phase, hidden_from_code);
}

TEST(GnssTracking, TheLossGrowsWithTheLeafArea) {
  // The hedge with half and twice the usual 6 m2/m3: 3 and 12 dB for each metre.
  PlainScene scene;
  scene.boxes.push_back({{1, -1e5, -1}, {3, 1e5, 1e5}});
  for (const double density_m2pm3 : {3.0, 12.0}) {
    int hidden = 0;
    for_each_hour([&](double time_s, const std::vector<Vector3d>& seen) {
      int code = 0;
      for (const Vector3d& d : seen) {
        const double leaves_m = d.x() > 1e-3 ? 2.0 / d.x() : 0.0;
        const double cn0_dBHz = 38.0 + 10.0 * d.z() - density_m2pm3 * leaves_m;
        ASSERT_GT(std::abs(cn0_dBHz - 20.0), 1e-3);
        code += cn0_dBHz >= 20.0;
      }
      const GnssView view = look(scene, {0, 0, 1}, time_s, 0.0, LeafAreaDensity(density_m2pm3));
      EXPECT_EQ(view.code.count(), code) << density_m2pm3 << " " << time_s;
      hidden += static_cast<int>(seen.size()) - code;
    });
    EXPECT_GT(hidden, 20);
  }
}

TEST(GnssTracking, WeakSatellitesCountLessInTheGeometry) {
  // All have the usual 45 dB-Hz; 10 dB less are ten times the noise, which is all of a phase's
  // variance and a tenth of a code's: 10 and 0.9 + 0.1 * 10 times the variance.
  ParameterSet parameters(gnss_signal_table().specs(), "gnss");
  parameters.set("zenith_cn0_dBHz", 45.0).set("horizon_cn0_dBHz", 45.0);
  const PlainScene open;
  GnssTracking tracking(gnss_signal_table().read(parameters, "s"), sky_of_barolo(), open, kUsual,
                        0.2, true, RandomStream(1, "rover", "s"));
  const GnssView clear = tracking.look(0.0, {0, 0, 1}, false, 0.0);
  const GnssView jammed = tracking.look(0.0, {0, 0, 1}, false, 10.0);
  Dilution a, b;
  ASSERT_TRUE(clear.code.read(a) && jammed.code.read(b));
  EXPECT_NEAR((b.axes - std::sqrt(1.9) * a.axes).norm(), 0.0, 1e-9);
  ASSERT_TRUE(clear.carrier.read(a) && jammed.carrier.read(b));
  EXPECT_NEAR((b.axes - std::sqrt(10.0) * a.axes).norm(), 0.0, 1e-9);
}

TEST(GnssTracking, AfterABlockageCodeComesBackBeforePhase) {
  ParameterSet parameters(gnss_signal_table().specs(), "gnss");
  parameters.set("reacquisition_s", 1.0).set("carrier_lock_s", 3.0);
  const PlainScene open;
  GnssTracking tracking(gnss_signal_table().read(parameters, "s"), sky_of_barolo(), open, kUsual,
                        0.2, true, RandomStream(1, "rover", "s"));
  const auto counts = [&](bool in_outage) {
    const GnssView view = tracking.look(0.0, {0, 0, 1}, in_outage, 0.0);
    return std::pair(view.code.count() > 0, view.carrier.count() > 0);
  };
  EXPECT_EQ(counts(false), std::pair(true, true));
  // A gap of 0.6 s is bridged for code (bridged_gap_s is 1 s), not for phase.
  for (int i = 0; i < 3; ++i) EXPECT_EQ(counts(true), std::pair(false, false));
  for (int i = 1; i <= 20; ++i) EXPECT_EQ(counts(false), std::pair(true, i >= 15)) << i;
  for (int i = 0; i < 10; ++i) counts(true);
  for (int i = 1; i <= 20; ++i) EXPECT_EQ(counts(false), std::pair(i >= 5, i >= 15)) << i;
}

}  // namespace
}  // namespace vinerow::sensors::gnss_tracking_test
