#include "engine/sensors/gnss_error.h"

#include <cmath>

namespace vinerow {
namespace {

/// Defaults: u-blox ZED-F9P-04B data sheet (UBX-21044850 R05), table 3, GPS + Galileo. Circular
/// error probable / 1.1774 and median of the height's error / 0.6745 are standard deviations: PVT
/// 1.5 m and 2.0 m, SBAS 1.0 m and 1.5 m, RTK 0.01 m and 0.01 m; velocity 0.05 m/s (50 %) / 1.1774.
/// Shares: white noise by code and 1100 s from Beard, McLain, Small Unmanned Aircraft, 2012, table
/// 7.1; other times, float, and the white share of fixed are chosen.
struct Defaults {
  const char* mode;
  const char* words;
  double white_m[2];
  double walk_m[2];
  double walk_time_s;
};
constexpr Defaults kDefaults[4] = {
    {"standalone", "standalone", {0.21, 0.40}, {1.257, 2.938}, 1100.0},
    {"sbas", "SBAS", {0.21, 0.40}, {0.823, 2.188}, 300.0},
    {"float", "RTK float", {0.02, 0.04}, {0.25, 0.40}, 60.0},
    {"fixed", "RTK fixed", {0.005, 0.009}, {0.0069, 0.0118}, 60.0},
};
constexpr double kVelocityStd_mps = 0.042;
constexpr double kPpm = 1e-6;
/// Means over ten days under an open sky at 38 to 53 deg of latitude, with the other defaults.
constexpr double kCodeDop[2] = {0.8, 1.2}, kCarrierDop[2] = {1.0, 1.45};

ParameterSpec pair_parameter(const std::string& name, const std::string& unit,
                             const double (&values)[2], const std::string& description) {
  ParameterSpec spec = number_list_parameter(name, unit, {values[0], values[1]}, description, 2);
  spec.min = 0.0;
  spec.max = 1e3;
  return spec;
}

}  // namespace

std::vector<ParameterSpec> gnss_error_parameters() {
  std::vector<ParameterSpec> specs;
  for (const Defaults& mode : kDefaults) {
    const std::string name = mode.mode, words = mode.words;
    specs.push_back(pair_parameter(name + "_white_std_m", "m", mode.white_m,
                                   words + ": white error of east and north, of up"));
    specs.push_back(pair_parameter(name + "_walk_std_m", "m", mode.walk_m,
                                   words + ": slowly moving error of east and north, of up"));
    specs.push_back(positive_parameter(name + "_walk_time_s", "s", mode.walk_time_s,
                                       words + ": correlation time of that"));
    specs.push_back(number_parameter(name + "_velocity_std_mps", "m/s", kVelocityStd_mps, 0.0,
                                     100.0, words + ": white error of the velocity, each axis"));
  }
  const auto add_dop = [&specs](const std::string& kind, const double(&dop)[2]) {
    specs.push_back(
        pair_parameter(kind + "_usual_dop", "", dop,
                       "horizontal, vertical dilution by " + kind + " at which these errors hold"));
    specs.back().min_exclusive = true;
  };
  add_dop("code", kCodeDop);
  add_dop("carrier", kCarrierDop);
  specs.push_back(number_parameter("baseline_m", "m", 1000.0, 0.0, 50e3,
                                   "distance of the base station, 1 mm of error per km"));
  return specs;
}

GnssModeErrors read_gnss_errors(const ParameterSet& parameters) {
  GnssModeErrors modes;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const std::string name = kDefaults[i].mode;
    GnssModeError& mode = modes[i];
    for (std::size_t k = 0; k < 2; ++k) {
      mode.white_std_m[k] = parameters.numbers(name + "_white_std_m")[k];
      mode.walk_std_m[k] = parameters.numbers(name + "_walk_std_m")[k];
    }
    mode.walk_time_s = parameters.number(name + "_walk_time_s");
    mode.velocity_std_mps = parameters.number(name + "_velocity_std_mps");
    const bool by_phase = i + 1 >= static_cast<std::size_t>(GnssFix::Mode::kFloat);
    const auto& usual = parameters.numbers(by_phase ? "carrier_usual_dop" : "code_usual_dop");
    for (std::size_t k = 0; k < 2; ++k) mode.usual_dop[k] = usual[k];
  }
  const double by_distance_m = kPpm * parameters.number("baseline_m");
  for (const GnssFix::Mode rtk : {GnssFix::Mode::kFloat, GnssFix::Mode::kFixed}) {
    for (double& walk : modes[static_cast<std::size_t>(rtk) - 1].walk_std_m) {
      walk = std::hypot(walk, by_distance_m);
    }
  }
  return modes;
}

GnssError::GnssError(const GnssModeErrors& modes, double period_s, RandomStream random)
    : modes_(modes), random_(random) {
  for (std::size_t mode = 0; mode < walks_.size(); ++mode) {
    for (GaussMarkov& walk : walks_[mode]) {
      walk = GaussMarkov(1.0, modes_[mode].walk_time_s, period_s);
      walk.start(random_);
    }
  }
}

void GnssError::draw() {
  for (auto& walks : walks_) {
    for (GaussMarkov& walk : walks) walk.step(random_);
  }
  for (int axis = 0; axis < 3; ++axis) white_[axis] = random_.normal();
  for (int axis = 0; axis < 3; ++axis) velocity_white_[axis] = random_.normal();
}

void GnssError::apply(const Dilution& dilution, GnssFix& fix) const {
  const std::size_t index = static_cast<std::size_t>(fix.mode) - 1;
  const GnssModeError& mode = modes_[index];
  // Of one axis of the plane, and of the vertical.
  const double usual[2] = {mode.usual_dop[0] / std::sqrt(2.0), mode.usual_dop[1]};
  for (int axis = 0; axis < 3; ++axis) {
    const int kind = axis == 2 ? 1 : 0;
    const double scale = dilution.axes[axis] / usual[kind];
    fix.p_W[axis] += scale * (mode.white_std_m[kind] * white_[axis] +
                              mode.walk_std_m[kind] * walks_[index][axis].value());
    fix.std_m[axis] = scale * std::hypot(mode.white_std_m[kind], mode.walk_std_m[kind]);
  }
  fix.velocity_std_mps = mode.velocity_std_mps * dilution.position() /
                         std::hypot(mode.usual_dop[0], mode.usual_dop[1]);
  fix.v_W += fix.velocity_std_mps * velocity_white_;
}

}  // namespace vinerow
