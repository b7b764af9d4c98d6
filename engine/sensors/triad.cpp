#include "engine/sensors/triad.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/sensors/resolution.h"

namespace vinerow::sensors {

ParameterTable<TriadFigures> make_triad_table(const TriadNames& n) {
  using P = TriadFigures;
  const auto allan = [](auto member) { return inside(&P::allan, member); };
  ParameterTable<P> table;
  table
      .number(n.name + "_noise_" + n.unit_key + "_rtHz", n.unit + "/sqrt(Hz)",
              allan(&AllanFigures::white_u_rtHz), between(0.0, 10.0),
              "white noise density: Allan deviation at 1 s", n.si)
      .number(n.name + "_bias_std_" + n.unit_key, n.unit, &P::turn_on_bias_std_u,
              between(0.0, 100.0), "turn-on bias, constant, drawn once per run and axis", n.si)
      .number(n.name + "_bias_instability_" + n.instability_key, n.instability_unit,
              allan(&AllanFigures::instability_u), between(0.0, 1e5),
              "in-run bias instability B: minimum Allan deviation 0.664 B (IEEE 952)",
              n.instability_si)
      .number(n.name + "_walk_" + n.walk_key + "_rtHz", n.walk_unit + "/sqrt(Hz)",
              allan(&AllanFigures::walk_u_per_rts), between(0.0, 10.0), "random walk of the bias",
              n.si)
      .number(n.name + "_scale_error_std", "", &P::scale_error_std, between(0.0, 0.5),
              "scale error as a share, drawn once per run and axis")
      .numbers(n.name + "_scale_errors", "", &P::scale_errors, kAnyNumber,
               "scale errors of x, y, z, added to the drawn ones")
      .degrees(n.name + "_misalignment_std_deg", &P::misalignment_std_rad, between(0.0, 10.0),
               "misalignment of an axis towards another, drawn once per run, six angles")
      .numbers(n.name + "_misalignments_deg", "deg", &P::misalignments_rad, kAnyNumber,
               "x towards y and z, y towards x and z, z towards x and y, added to the drawn ones",
               6, kDegrees)
      .number(n.name + "_range_" + n.unit_key, n.unit, &P::range_u, kPositive,
              "limit at which readings saturate", n.si)
      .number(n.name + "_resolution_" + n.unit_key, n.unit, &P::resolution_u, between(0.0, 100.0),
              "step of the reading; 0: none", n.si);
  return table;
}

Triad::Triad(const TriadNames& names, const TriadFigures& figures, const PartContext& context)
    : figures_(figures),
      noise_random_(context.random(names.name + "_noise")),
      bias_random_(context.random(names.name + "_bias")) {
  const AllanFigures& allan = figures_.allan;
  const double root_period = std::sqrt(context.period.s());
  white_std_u_ = allan.white_u_rtHz / root_period;
  walk_std_u_ = allan.walk_u_per_rts * root_period;
  const double process_std = calc_instability_std(allan);
  if (process_std < 0.0) {
    const double to_unit =
        1.0 / (names.instability_si.to_member ? names.instability_si.to_member(1.0) : 1.0);
    throw ConfigError(fmt::format(
        "{0}_bias_instability_{1} = {2:.6g} {3} requires a minimum Allan deviation of {4:.6g} {3}, "
        "but white noise and random walk alone are {5:.6g} {3} or more up to {6:g} s",
        names.name, names.instability_key, allan.instability_u * to_unit, names.instability_unit,
        kInstabilityFactor * allan.instability_u * to_unit,
        calc_min_allan_deviation(allan, 0.0) * to_unit, kLongestAveraging_s));
  }
  wanders_ = process_std > 0.0 || walk_std_u_ > 0.0;
  RandomStream device = context.random(names.name + "_device");
  const std::array<double, 6>& m = figures_.misalignments_rad;
  Eigen::Matrix3d misalignments;
  misalignments << 0.0, m[0], m[1], m[2], 0.0, m[3], m[4], m[5], 0.0;
  gain_.setIdentity();
  for (int i = 0; i < 3; ++i) {
    bias_u_[i] = figures_.turn_on_bias_std_u * device.normal();
    for (int j = 0; j < 3; ++j) {
      gain_(i, j) += i == j ? figures_.scale_errors[i] + figures_.scale_error_std * device.normal()
                            : misalignments(i, j) + figures_.misalignment_std_rad * device.normal();
    }
    instability_[i] = BiasInstability(process_std, context.period.s());
    instability_[i].start(bias_random_);
  }
}

Eigen::Vector3d Triad::read(const Eigen::Vector3d& truth) {
  Eigen::Vector3d reading = gain_ * truth;
  for (int i = 0; i < 3; ++i) {
    double& u = reading[i];
    if (wanders_) {
      bias_u_[i] += walk_std_u_ * bias_random_.normal();
      u += instability_[i].step(bias_random_);
    }
    u += bias_u_[i] + white_std_u_ * noise_random_.normal();
    u = std::clamp(round_to_step(u, figures_.resolution_u), -figures_.range_u, figures_.range_u);
  }
  return reading;
}

}  // namespace vinerow::sensors
