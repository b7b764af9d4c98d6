/// A satellite receiver in scenes: what it makes of the sky it sees, of jamming and of outages.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "tests/engine/sensors/data_sheet.h"
#include "tests/engine/sensors/gnss_bench.h"
#include "tests/engine/sensors/sensor_rig.h"
#include "tests/support/no_alloc.h"

namespace vinerow::sensors::gnss_test {
namespace {

using Eigen::Vector3d;
using test::GnssBench;
using test::PlainScene;
using Mode = GnssFix::Mode;

struct Quality {
  int fixed = 0, ticks = 0;
  double satellites = 0.0, std_m = 0.0, rms_m = 0.0;
};

/// One minute at 1 m/s along +y.
Quality drive(const SceneQuery& scene, double x_m, double height_m,
              const test::SensorValues& values = {}) {
  GnssBench bench(scene, GnssBench::parameters(values));
  Quality quality;
  constexpr int kTicks = 300;
  for (int i = 0; i < kTicks; ++i) {
    bench.place({x_m, -30.0 + 0.2 * i, height_m}, {0, 1, 0});
    const GnssFix& fix = bench.step();
    quality.fixed += fix.mode == Mode::kFixed;
    ++quality.ticks;
    quality.satellites += fix.satellites / static_cast<double>(kTicks);
    quality.std_m += fix.std_m.norm() / kTicks;
    quality.rms_m += bench.error().squaredNorm() / kTicks;
  }
  quality.rms_m = std::sqrt(quality.rms_m);
  return quality;
}

TEST(Gnss, BetweenTwoRowsItIsWorseThanAboveThem) {
  const PlainScene rows = test::vine_rows();
  const Quality above = drive(rows, 0.0, 3.0), between = drive(rows, 0.0, 0.6);
  EXPECT_EQ(above.fixed, above.ticks);
  EXPECT_LT(above.std_m, 0.03);
  EXPECT_LT(above.rms_m, 0.05);
  EXPECT_LT(between.satellites, above.satellites - 1.0);
  EXPECT_GT(between.std_m, 1.2 * above.std_m);
  // With half of the satellites, those that are left do not always allow a fix.
  const std::vector<std::string> gps = {"gps"};
  const Quality gps_above = drive(rows, 0.0, 3.0, {{"constellations", gps}});
  const Quality gps_between = drive(rows, 0.0, 0.6, {{"constellations", gps}});
  EXPECT_EQ(gps_above.fixed, gps_above.ticks);
  EXPECT_LT(gps_between.fixed, gps_between.ticks / 2);
  EXPECT_GT(gps_between.std_m, 5.0 * gps_above.std_m);
  EXPECT_GT(gps_between.rms_m, 3.0 * gps_above.rms_m);
}

TEST(Gnss, AFixIsTheAntennasPlaceAndVelocityWithinWhatItStates) {
  const PlainScene open;
  GnssBench bench(open, GnssBench::parameters({{"position_m", std::vector<double>{0.3, 0, 0.5}}}));
  bench.place({1, 2, 3}, {0, 1.5, 0});
  constexpr int kCount = 4'000;
  double velocity_squares = 0.0, stated = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const GnssFix& fix = bench.step();
    ASSERT_TRUE(fix.valid);
    ASSERT_EQ(fix.mode, Mode::kFixed);
    ASSERT_LT((fix.p_W - Vector3d(1.3, 2, 3.5)).cwiseQuotient(fix.std_m).cwiseAbs().maxCoeff(),
              6.0);
    velocity_squares += std::pow(fix.v_W.y() - 1.5, 2);
    stated += std::pow(fix.velocity_std_mps, 2);
  }
  EXPECT_NEAR(velocity_squares / stated, 1.0, 5.0 * std::sqrt(2.0 / kCount));
}

ParameterSet with_window(ParameterSet parameters, const char* list,
                         const std::vector<std::pair<const char*, double>>& values) {
  ParameterSet window = parameters.make_group(list);
  for (const auto& [name, value] : values) window.set(name, value);
  parameters.set(list, std::vector<ParameterSet>{window});
  return parameters;
}

TEST(Gnss, AnOutageTakesTheFixAndItComesBackStepByStep) {
  const PlainScene open;
  const ParameterSet plain = GnssBench::parameters({});
  GnssBench whole(open, plain), holed(open, test::with_outage(plain, 10.0, 20.0));
  for (int i = 0; i < 250; ++i) {
    const double t = holed.time_s();
    const GnssFix& reference = whole.step();
    const GnssFix& fix = holed.step();
    if (t >= 10.0 - 1e-9 && t < 20.0 - 1e-9) {
      EXPECT_FALSE(fix.valid) << t;
      EXPECT_EQ(fix.mode, Mode::kNone);
      EXPECT_EQ(fix.satellites, 0);
      EXPECT_EQ(fix.p_W, Vector3d::Zero());
      continue;
    }
    // Defaults: satellites again after 2 s by code and by phase, fixed after 10 s more.
    const Mode expected = t < 10.0 || t > 31.7 ? Mode::kFixed
                          : t > 21.7           ? Mode::kFloat
                                               : Mode::kNone;
    EXPECT_EQ(fix.mode, expected) << t;
    if (expected == Mode::kFixed) {
      EXPECT_EQ(fix.p_W, reference.p_W) << "the outage has shifted the noise, " << t << " s";
      EXPECT_EQ(fix.v_W, reference.v_W);
    }
  }
}

TEST(Gnss, JammingRisesDegradesAndFalls) {
  const PlainScene open;
  GnssBench bench(
      open, with_window(GnssBench::parameters({}), "jamming",
                        {{"begin_s", 10.0}, {"end_s", 70.0}, {"drop_dB", 24.0}, {"ramp_s", 20.0}}));
  double open_std_m = 0.0, full_std_m = 0.0;
  int open_satellites = 0, full_satellites = 0;
  Mode before = Mode::kFixed;
  for (int i = 0; i < 600; ++i) {
    const double t = bench.time_s();
    const GnssFix fix = bench.step();
    if (t < 10.0) {
      EXPECT_EQ(fix.mode, Mode::kFixed);
      open_std_m = fix.std_m.norm(), open_satellites = fix.satellites;
    } else if (t < 30.0) {
      EXPECT_LE(fix.mode, before) << "while it rises nothing gets better, " << t;
      before = fix.mode;
    } else if (t < 50.0) {
      // 24 dB leave 14 to 24 dB-Hz: no phase at all, and only those above 37 deg by code.
      EXPECT_EQ(fix.mode, Mode::kSbas) << t;
      full_std_m = fix.std_m.norm(), full_satellites = fix.satellites;
    }
  }
  EXPECT_LT(full_satellites, open_satellites - 2);
  EXPECT_GT(full_std_m, 100.0 * open_std_m);
  EXPECT_EQ(bench.step().mode, Mode::kFixed) << "50 s after the end";
}

TEST(Gnss, StrongJammingLeavesNoFix) {
  const PlainScene open;
  GnssBench bench(open, with_window(GnssBench::parameters({}), "jamming",
                                    {{"begin_s", 0.0}, {"end_s", 5.0}, {"drop_dB", 40.0}}));
  for (int i = 0; i < 25; ++i) EXPECT_FALSE(bench.step().valid) << i;
}

TEST(Gnss, AStepAllocatesNothingWhateverItSees) {
  const PlainScene rows = test::vine_rows();
  GnssBench bench(rows, with_window(GnssBench::parameters({{"leaves_dB_per_m", 15.0}}), "jamming",
                                    {{"begin_s", 5.0}, {"end_s", 10.0}, {"drop_dB", 30.0}}));
  bench.place({0, 0, 0.6});
  bench.step();
  const test::AllocationCounter counter;
  for (int i = 0; i < 100; ++i) bench.step();
  EXPECT_EQ(counter.count(), 0u);
}

TEST(Gnss, ContradictionsAreRefusedInOneSentence) {
  const PlainScene open;
  const auto refusal_of = [&](const ParameterSet& parameters) {
    return test::refusal_of([&] { GnssBench bench(open, parameters); });
  };
  const auto refusal = [&](const test::SensorValues& values) {
    return refusal_of(GnssBench::parameters(values));
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(refusal({{"constellations", Texts{"gps", "galilei"}}}),
            "rover.sensors.s: constellations: unknown constellation 'galilei'; did you mean "
            "'galileo'? (known: gps, galileo)");
  EXPECT_EQ(refusal({{"constellations", Texts{"gps", "gps"}}}),
            "rover.sensors.s: constellations: 'gps' is given twice");
  EXPECT_EQ(refusal({{"constellations", Texts{}}}),
            "rover.sensors.s: constellations is empty, must name one of: gps, galileo");
  EXPECT_EQ(refusal({{"epoch_utc", std::string("15 June 2024")}}),
            "rover.sensors.s: epoch_utc = '15 June 2024', must be a date and time in UTC like "
            "2024-06-15T10:00:00");
  EXPECT_EQ(refusal({{"carrier_cn0_dBHz", 15.0}}),
            "rover.sensors.s: carrier_cn0_dBHz = 15 dB-Hz, must be >= code_cn0_dBHz = 20 dB-Hz");
  EXPECT_EQ(refusal({{"zenith_cn0_dBHz", 30.0}}),
            "rover.sensors.s: zenith_cn0_dBHz = 30 dB-Hz, must be >= horizon_cn0_dBHz = 38 dB-Hz");
  const ParameterSet plain = GnssBench::parameters({});
  EXPECT_EQ(refusal_of(with_window(plain, "jamming",
                                   {{"begin_s", 5.0}, {"end_s", 4.0}, {"drop_dB", 10.0}})),
            "rover.sensors.s: jamming[0]: end_s = 4 s, must be >= begin_s = 5 s");
  EXPECT_EQ(refusal_of(with_window(plain, "outages", {{"begin_s", 9.0}, {"end_s", 5.0}})),
            "rover.sensors.s: outages[0]: end_s = 5 s, must be >= begin_s = 9 s");
  EXPECT_EQ(refusal_of(with_window(
                plain, "jamming",
                {{"begin_s", 5.0}, {"end_s", 9.0}, {"drop_dB", 10.0}, {"ramp_s", 3.0}})),
            "rover.sensors.s: jamming[0]: ramp_s = 3 s, must be at most half of the window from 5 "
            "s to 9 s");
}

TEST(Gnss, TheDataSheetsAreReadAndDiffer) {
  const PlainScene open;
  const scenario::PartConfig rtk = test::data_sheet("zed_f9p_rtk");
  const scenario::PartConfig plain = test::data_sheet("neo_m8n");
  EXPECT_EQ(rtk.type, "gnss");
  EXPECT_EQ(rtk.rate_Hz, 5.0);
  GnssBench good(open, rtk.parameters), usual(open, plain.parameters);
  EXPECT_EQ(good.step().mode, Mode::kFixed);
  const GnssFix fix = usual.step();
  EXPECT_EQ(fix.mode, Mode::kSbas);
  // The maker's 2.0 m CEP is 1.7 m per axis at the usual dilution; this sky is near it.
  EXPECT_NEAR(fix.std_m.x(), 1.7, 0.6);
}

}  // namespace
}  // namespace vinerow::sensors::gnss_test
