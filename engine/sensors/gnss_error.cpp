#include "engine/sensors/gnss_error.h"

#include <cmath>
#include <string>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {
namespace {

struct ModeWords {
  const char* key;
  const char* words;
};
constexpr std::array<ModeWords, 4> kModeWords = {{{"standalone", "standalone"},
                                                  {"sbas", "SBAS"},
                                                  {"float", "RTK float"},
                                                  {"fixed", "RTK fixed"}}};
constexpr double kPpm = 1e-6;

ParameterTable<GnssErrorParams> make_gnss_error_table() {
  using P = GnssErrorParams;
  ParameterTable<P> table;
  for (std::size_t i = 0; i < kModeWords.size(); ++i) {
    const std::string key = kModeWords[i].key, words = kModeWords[i].words;
    const auto mode = [i](auto member) {
      return [i, member](P& p) -> auto& { return p.modes[i].*member; };
    };
    table
        .numbers(key + "_white_std_m", "m", mode(&GnssModeError::white_std_m), between(0.0, 1e3),
                 words + ": white error, horizontal and vertical")
        .numbers(key + "_walk_std_m", "m", mode(&GnssModeError::walk_std_m), between(0.0, 1e3),
                 words + ": slowly varying error, horizontal and vertical")
        .number(key + "_walk_time_s", "s", mode(&GnssModeError::walk_time_s), kPositive,
                words + ": correlation time of the slowly varying error")
        .number(key + "_velocity_std_mps", "m/s", mode(&GnssModeError::velocity_std_mps),
                between(0.0, 100.0), words + ": white error of the velocity, each axis");
  }
  table
      .numbers("code_usual_dop", "", &P::code_usual_dop, above(0.0, 1e3),
               "horizontal, vertical dilution by code for which these errors hold")
      .numbers("carrier_usual_dop", "", &P::carrier_usual_dop, above(0.0, 1e3),
               "horizontal, vertical dilution by carrier for which these errors hold")
      .number("baseline_m", "m", &P::baseline_m, between(0.0, 50e3),
              "distance to the base station; adds 1 mm of error per km");
  return table;
}

}  // namespace

const ParameterTable<GnssErrorParams>& gnss_error_table() {
  static const ParameterTable<GnssErrorParams> table = make_gnss_error_table();
  return table;
}

GnssModeErrors GnssErrorParams::resolve() const {
  GnssModeErrors resolved = modes;
  for (std::size_t i = 0; i < resolved.size(); ++i) {
    const bool by_phase = i + 1 >= static_cast<std::size_t>(GnssFix::Mode::kFloat);
    resolved[i].usual_dop = by_phase ? carrier_usual_dop : code_usual_dop;
  }
  const double by_distance_m = kPpm * baseline_m;
  for (const GnssFix::Mode rtk : {GnssFix::Mode::kFloat, GnssFix::Mode::kFixed}) {
    for (double& walk : resolved[static_cast<std::size_t>(rtk) - 1].walk_std_m) {
      walk = std::hypot(walk, by_distance_m);
    }
  }
  return resolved;
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
  // Dilution of one horizontal axis, and of the vertical.
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

}  // namespace vinerow::sensors
