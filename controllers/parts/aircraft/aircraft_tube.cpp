#include "controllers/parts/aircraft/aircraft_tube.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

using GainByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct AxisWords {
  const char* name;      ///< "longitudinal"
  const char* gain_key;  ///< for errors
  std::vector<std::string> states, inputs;
};

/// Rounded down, so that it is feasible as printed.
std::string describe_gust(double largest_mps) {
  if (largest_mps < 0.01) return "below 0.01 m/s";
  return fmt::format("{:.2f} m/s", std::floor(100.0 * largest_mps) / 100.0);
}

/// Linear programmes that fail count as a reason too.
Result<TubeSets> find_sets(const TubeModel& model, TubeShape shape) {
  try {
    return make_tube_sets(model, shape);
  } catch (const ConfigError& error) {
    return Failure{error.what()};
  }
}

AxisTube make_axis(const AxisLaw& law, const Eigen::VectorXd& state_limit,
                   const Eigen::VectorXd& input_limit, const std::vector<double>& gain,
                   const AxisWords& words, const AircraftTubeParams& params,
                   const std::string& who) {
  const SampledAxis& sampled = law.model;
  TubeModel model;
  model.A = sampled.A;
  model.B = sampled.B;
  model.E = sampled.E;
  model.K = law.K;
  if (!gain.empty()) {
    model.K = Eigen::Map<const GainByRows>(gain.data(), law.K.rows(), law.K.cols());
  }
  model.gust = Eigen::VectorXd::Constant(sampled.E.cols(), params.gust_mps);
  model.state_limit = state_limit;
  model.input_limit = input_limit;
  model.state_names = words.states;
  model.input_names = words.inputs;

  const Result<GustMargin> gust_margin = calc_gust_margin(model);
  if (!gust_margin && gain.empty()) {
    throw ConfigError(fmt::format(
        "{}: the feedback that follows from 'weights' hardly steadies the {} axis: they are too "
        "far apart in size ({})",
        who, words.name, gust_margin.reason()));
  }
  if (!gust_margin) {
    throw ConfigError(fmt::format("{}: {} does not stabilise the {} axis: {}", who, words.gain_key,
                                  words.name, gust_margin.reason()));
  }
  const double largest_mps =
      params.gust_mps > 0.0 ? gust_margin->factor * params.gust_mps : gust_margin->factor;
  if (!(gust_margin->factor > 1.0)) {
    throw ConfigError(fmt::format(
        "{}: gust_mps = {:g} m/s: gusts alone take {:.0f} % of the limit of {}; the largest "
        "feasible gust is {} ({})",
        who, params.gust_mps, std::ceil(100.0 / gust_margin->factor), gust_margin->binding,
        describe_gust(largest_mps), words.name));
  }
  const Result<TubeSets> sets = find_sets(model, params.shape);
  if (!sets) {
    const bool has_tube = params.gust_mps > 0.0 && params.shape == TubeShape::kInvariant;
    throw ConfigError(fmt::format(
        "{}: no set of states of the {} axis stays within 'limits' at this rate_Hz; take {}limits "
        "and weights nearer to the defaults ({})",
        who, words.name, has_tube ? "a lower rate_Hz, tube_shape: box, or " : "", sets.reason()));
  }
  const TubeCost cost{law.Q, law.R, params.horizon};
  TubeMpc mpc(model, *sets, cost, {.law = params.law}, who);
  return {model, *sets, std::move(mpc), largest_mps};
}

AxisTube make_lon(const AircraftLaws& laws, const AircraftTubeParams& params,
                  const std::string& who) {
  const AircraftLimits& limits = params.limits;
  return make_axis(laws.lon, limits.lon, Eigen::Vector2d(limits.throttle, limits.elevator_rad),
                   params.longitudinal_gain,
                   {"longitudinal",
                    "longitudinal_gain",
                    {"speed ahead", "speed down", "pitch rate", "pitch", "altitude"},
                    {"throttle", "elevator"}},
                   params, who);
}

AxisTube make_lat(const AircraftLaws& laws, const AircraftTubeParams& params,
                  const std::string& who) {
  const AircraftLimits& limits = params.limits;
  return make_axis(laws.lat, limits.lat, Eigen::VectorXd::Constant(1, limits.aileron_rad),
                   params.lateral_gain,
                   {"lateral",
                    "lateral_gain",
                    {"speed aside", "roll rate", "yaw rate", "roll", "heading"},
                    {"aileron"}},
                   params, who);
}

}  // namespace

std::string AxisTube::describe_violation() const {
  const TubeRow& row = mpc.worst_row();
  const double percent = 100.0 * mpc.soft_violation();
  if (row.kind == TubeRow::Kind::kTerminal) {
    return fmt::format("{:.1f} % of its terminal set", percent);
  }
  return fmt::format("{:.1f} % of the limit of {}", percent,
                     model.state_names[static_cast<std::size_t>(row.index)]);
}

AircraftTube::AircraftTube(const Aircraft& aircraft, const Trim& trim, double period_s,
                           const AircraftTubeParams& params, const std::string& who)
    : AircraftTube(make_aircraft_laws(aircraft, trim, period_s, params.weights, who), params, who) {
}

AircraftTube::AircraftTube(const AircraftLaws& laws, const AircraftTubeParams& params,
                           const std::string& who)
    : lon_(make_lon(laws, params, who)), lat_(make_lat(laws, params, who)) {}

AircraftControls AircraftTube::step(const AircraftDeviation& deviation) {
  lon_status_ = lon_.mpc.solve(deviation.lon);
  lat_status_ = lat_.mpc.solve(deviation.lat);
  return {lon_.mpc.u()[0], lon_.mpc.u()[1], lat_.mpc.u()[0]};
}

void AircraftTube::reset() {
  lon_.mpc.cold_start();
  lat_.mpc.cold_start();
}

}  // namespace vinerow::controllers
