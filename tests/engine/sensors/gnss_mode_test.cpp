/// Modes of a satellite receiver by their rules, and the errors of each.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/sensors/gnss_error.h"
#include "engine/sensors/gnss_mode.h"

namespace vinerow {

void PrintTo(GnssFix::Mode mode, std::ostream* out) {
  constexpr const char* kNames[] = {"none", "standalone", "sbas", "float", "fixed"};
  *out << kNames[static_cast<int>(mode)];
}

}  // namespace vinerow

namespace vinerow::sensors::gnss_mode_test {
namespace {

using Mode = GnssFix::Mode;
using Values = std::vector<std::pair<std::string, ParameterSet::Value>>;

constexpr double kPeriod_s = 0.2;
constexpr double kNone = std::numeric_limits<double>::infinity();

ParameterSet with(std::vector<ParameterSpec> specs, const Values& values) {
  ParameterSet parameters(std::move(specs), "gnss");
  for (const auto& [name, value] : values) parameters.set(name, value);
  return parameters;
}

/// Defaults: SBAS after 6 s, float with 5, fixed with 6 after 10 s and again after 4 s.
class Modes {
 public:
  explicit Modes(const Values& values = {})
      : modes_(gnss_mode_table().read(with(gnss_mode_table().specs(), values), "rover.sensors.s"),
               kPeriod_s) {}

  Mode step(double code_pdop, int carriers, double carrier_pdop) {
    time_s = kPeriod_s * tick_++;
    return modes_.step(code_pdop, carriers, carrier_pdop);
  }
  Mode open_sky() { return step(2.0, 9, 2.0); }
  /// Time from the next tick until `wanted` is reached, under an open sky.
  double time_until(Mode wanted) {
    const int first = tick_;
    while (open_sky() != wanted) {
      if (tick_ > first + 1000) return kNone;
    }
    return kPeriod_s * (tick_ - 1 - first);
  }

  double time_s = 0.0;  ///< of the last tick

 private:
  GnssModes modes_;
  int tick_ = 0;
};

TEST(GnssModes, AReceiverThatRunsIsFixedAtOnce) {
  EXPECT_EQ(Modes().open_sky(), Mode::kFixed);
  EXPECT_EQ(Modes({{"corrections", std::string("sbas")}}).open_sky(), Mode::kSbas);
  EXPECT_EQ(Modes({{"corrections", std::string("none")}}).open_sky(), Mode::kStandalone);
}

TEST(GnssModes, AColdStartTakesItsTimesOneAfterTheOther) {
  Modes by_code({{"start", std::string("cold")}, {"corrections", std::string("sbas")}});
  EXPECT_NEAR(by_code.time_until(Mode::kStandalone), 25.0, 1e-9);
  EXPECT_NEAR(by_code.time_until(Mode::kSbas), 6.0 - kPeriod_s, 1e-9);
  Modes rtk({{"start", std::string("cold")}});
  EXPECT_NEAR(rtk.time_until(Mode::kFloat), 25.0, 1e-9);
  EXPECT_NEAR(rtk.time_until(Mode::kFixed), 10.0 - kPeriod_s, 1e-9);
}

TEST(GnssModes, AfterALapseToFloatTheFixIsBackSoonerThanAfterALossOfPhase) {
  Modes modes;
  ASSERT_EQ(modes.open_sky(), Mode::kFixed);
  EXPECT_EQ(modes.step(2.0, 5, 3.0), Mode::kFloat);
  EXPECT_NEAR(modes.time_until(Mode::kFixed), 4.0, 1e-9);
  EXPECT_EQ(modes.step(2.0, 4, 3.0), Mode::kSbas);
  EXPECT_NEAR(modes.time_until(Mode::kFixed), 10.0, 1e-9);
  EXPECT_EQ(modes.step(kNone, 0, kNone), Mode::kNone);
  EXPECT_EQ(modes.step(2.0, 4, 3.0), Mode::kStandalone);
  EXPECT_NEAR(modes.time_until(Mode::kFixed), 10.0, 1e-9);
}

TEST(GnssModes, BadGeometryTakesModesAwayLikeFewSatellites) {
  Modes modes;
  EXPECT_EQ(modes.step(2.0, 12, 5.1), Mode::kSbas) << "max_rtk_pdop is 5";
  EXPECT_EQ(modes.step(25.1, 12, 2.0), Mode::kNone) << "max_pdop is 25";
  EXPECT_EQ(modes.step(25.0, 4, kNone), Mode::kStandalone);
}

TEST(GnssModes, WithoutABaseStationCarrierPhaseServesNothing) {
  Modes modes({{"corrections", std::string("sbas")}});
  for (int i = 0; i < 200; ++i) EXPECT_EQ(modes.open_sky(), Mode::kSbas);
}

TEST(GnssModes, ContradictionsAreRefused) {
  const auto refusal = [](const Values& values) -> std::string {
    try {
      Modes modes(values);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(refusal({{"fixed_satellites", std::int64_t{4}}}),
            "rover.sensors.s: fixed_satellites = 4, must be >= float_satellites = 5");
  EXPECT_EQ(refusal({{"time_to_refix_s", 11.0}}),
            "rover.sensors.s: time_to_refix_s = 11 s, must be <= time_to_fix_s = 10 s");
}

GnssModeErrors errors_with(const Values& values) {
  const ParameterSet parameters = with(gnss_error_table().specs(), values);
  return gnss_error_table().read(parameters, "gnss").resolve();
}

class GnssErrorOfMode : public ::testing::TestWithParam<Mode> {
 protected:
  /// Defaults: 0.8 and 1.2 by code, 1.0 and 1.45 by carrier phase; the first on two axes.
  static Dilution usual() {
    const bool by_phase = GetParam() >= Mode::kFloat;
    const double axis = (by_phase ? 1.0 : 0.8) * std::sqrt(0.5);
    return {{axis, axis, by_phase ? 1.45 : 1.2}, 0.7};
  }
  static GnssError error_with(const Values& values, double period_s = kPeriod_s) {
    return {errors_with(values), period_s, RandomStream(1, "rover", "gnss")};
  }
  GnssFix errors_of(const GnssError& error, const Dilution& dilution) const {
    GnssFix fix;
    fix.mode = GetParam();
    error.apply(dilution, fix);
    return fix;
  }
};

TEST_P(GnssErrorOfMode, HasTheSizeThatItStates) {
  // Samples farther apart than any correlation time, so all are independent.
  GnssError error = error_with({}, 20'000.0);
  constexpr int kCount = 20'000;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), velocity_squares = Eigen::Vector3d::Zero();
  double cross = 0.0;
  GnssFix fix;
  for (int i = 0; i < kCount; ++i) {
    error.draw();
    fix = errors_of(error, usual());
    squares += fix.p_W.cwiseAbs2() / kCount;
    velocity_squares += fix.v_W.cwiseAbs2() / kCount;
    cross += fix.p_W.x() * fix.p_W.y() / kCount;
  }
  const double bound = 5.0 * std::sqrt(2.0 / kCount);  // five standard errors of a variance
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(squares[axis] / std::pow(fix.std_m[axis], 2), 1.0, bound) << axis;
    EXPECT_NEAR(velocity_squares[axis] / std::pow(fix.velocity_std_mps, 2), 1.0, bound) << axis;
  }
  EXPECT_NEAR(cross / std::pow(fix.std_m.x(), 2), 0.0, 5.0 / std::sqrt(kCount));
}

TEST_P(GnssErrorOfMode, ItsWalkForgetsExponentiallyAndItsWhitePartAtOnce) {
  Values only_walk, only_white;
  for (const char* mode : {"standalone", "sbas", "float", "fixed"}) {
    const std::string name = mode;
    const std::vector<double> none = {0.0, 0.0}, some = {0.5, 0.5};
    only_walk.push_back({name + "_white_std_m", none});
    only_walk.push_back({name + "_walk_std_m", some});
    only_walk.push_back({name + "_walk_time_s", 2.0});
    only_white.push_back({name + "_white_std_m", some});
    only_white.push_back({name + "_walk_std_m", none});
  }
  only_white.push_back({"baseline_m", 0.0});
  GnssError walk = error_with(only_walk), white = error_with(only_white);
  constexpr int kCount = 100'000;
  double walk_squares = 0.0, walk_lagged = 0.0, last_walk = 0.0;
  double white_squares = 0.0, white_lagged = 0.0, last_white = 0.0;
  for (int i = 0; i < kCount; ++i) {
    walk.draw(), white.draw();
    const double a = errors_of(walk, usual()).p_W.x(), b = errors_of(white, usual()).p_W.x();
    walk_squares += a * a, walk_lagged += a * last_walk;
    white_squares += b * b, white_lagged += b * last_white;
    last_walk = a, last_white = b;
  }
  // Closed form exp(-0.2 / 2). About 10^4 independent samples of the walk: five times 1 %.
  EXPECT_NEAR(walk_squares / kCount, 0.25, 0.25 * 5.0 * std::sqrt(2.0 / 1e4));
  EXPECT_NEAR(walk_lagged / walk_squares, std::exp(-0.1), 0.01);
  EXPECT_NEAR(white_squares / kCount, 0.25, 0.25 * 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(white_lagged / white_squares, 0.0, 5.0 / std::sqrt(kCount));
}

TEST_P(GnssErrorOfMode, GrowsWithTheDilutionOfItsAxis) {
  GnssError error = error_with({});
  error.draw();
  Dilution wide = usual();
  wide.axes = wide.axes.cwiseProduct(Eigen::Vector3d(2.0, 3.0, 5.0));
  const GnssFix near = errors_of(error, usual()), far = errors_of(error, wide);
  EXPECT_NEAR(far.std_m.x() / near.std_m.x(), 2.0, 1e-12);
  EXPECT_NEAR(far.std_m.y() / near.std_m.y(), 3.0, 1e-12);
  EXPECT_NEAR(far.std_m.z() / near.std_m.z(), 5.0, 1e-12);
  EXPECT_NEAR(far.p_W.y() / near.p_W.y(), 3.0, 1e-12);
  EXPECT_NEAR(far.velocity_std_mps / near.velocity_std_mps, wide.position() / usual().position(),
              1e-12);
}

/// Modes for which the data sheet has figures.
class GnssErrorOfDataSheet : public GnssErrorOfMode {};

TEST_P(GnssErrorOfDataSheet, HalfOfTheErrorsAreSmallerThanItSays) {
  // ZED-F9P: standalone 1.5 m and 2.0 m, SBAS 1.0 m and 1.5 m, fixed 0.01 m and 0.01 m.
  const bool is_fixed = GetParam() == Mode::kFixed, is_sbas = GetParam() == Mode::kSbas;
  const double cep_m = is_fixed ? 0.01 : is_sbas ? 1.0 : 1.5;
  const double median_m = is_fixed ? 0.01 : is_sbas ? 1.5 : 2.0;
  GnssError error = error_with({}, 20'000.0);
  constexpr int kCount = 20'000;
  int near_in_plane = 0, near_in_height = 0;
  for (int i = 0; i < kCount; ++i) {
    error.draw();
    const GnssFix fix = errors_of(error, usual());
    near_in_plane += fix.p_W.head<2>().norm() < cep_m;
    near_in_height += std::abs(fix.p_W.z()) < median_m;
  }
  // Five standard errors of a share (0.018), and 1 % for a base 1 km away and rounded figures.
  EXPECT_NEAR(near_in_plane, 0.5 * kCount, 0.028 * kCount);
  EXPECT_NEAR(near_in_height, 0.5 * kCount, 0.028 * kCount);
}

std::string name_of(const ::testing::TestParamInfo<Mode>& parameter) {
  constexpr const char* kNames[] = {"none", "standalone", "sbas", "float", "fixed"};
  return kNames[static_cast<int>(parameter.param)];
}
INSTANTIATE_TEST_SUITE_P(All, GnssErrorOfMode,
                         ::testing::Values(Mode::kStandalone, Mode::kSbas, Mode::kFloat,
                                         Mode::kFixed),
                         name_of);

INSTANTIATE_TEST_SUITE_P(All, GnssErrorOfDataSheet,
                         ::testing::Values(Mode::kStandalone, Mode::kSbas, Mode::kFixed), name_of);

TEST(GnssError, ABaseStationFarAwayAddsAMillimetrePerKilometre) {
  const auto walk_m = [](double baseline_m) {
    return errors_with({{"baseline_m", baseline_m}})[3].walk_std_m[0];
  };
  EXPECT_NEAR(std::pow(walk_m(20'000.0), 2) - std::pow(walk_m(0.0), 2), 0.02 * 0.02, 1e-12);
}

}  // namespace
}  // namespace vinerow::sensors::gnss_mode_test
