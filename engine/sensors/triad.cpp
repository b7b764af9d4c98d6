#include "engine/sensors/triad.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/sensors/resolution.h"

namespace vinerow {

std::vector<ParameterSpec> triad_parameters(const TriadNames& n, double noise, double range) {
  return {
      number_parameter(n.name + "_noise_" + n.unit_key + "_rtHz", n.unit + "/sqrt(Hz)", noise, 0.0,
                       10.0, "white noise density: Allan deviation at 1 s"),
      number_parameter(n.name + "_bias_std_" + n.unit_key, n.unit, 0.0, 0.0, 100.0,
                       "turn-on bias, constant, drawn once per run and axis"),
      number_parameter(n.name + "_bias_instability_" + n.instability_key, n.instability_unit, 0.0,
                       0.0, 1e5,
                       "in-run bias instability B: least Allan deviation 0.664 B (IEEE 952)"),
      number_parameter(n.name + "_walk_" + n.walk_key + "_rtHz", n.walk_unit + "/sqrt(Hz)", 0.0,
                       0.0, 10.0, "random walk of the bias"),
      number_parameter(n.name + "_scale_error_std", "", 0.0, 0.0, 0.5,
                       "error of scale as a share, drawn once per run and axis"),
      number_list_parameter(n.name + "_scale_errors", "", {0.0, 0.0, 0.0},
                            "errors of scale of x, y, z, added to what is drawn", 3),
      number_parameter(n.name + "_misalignment_std_deg", "deg", 0.0, 0.0, 10.0,
                       "by how much an axis leans towards another, drawn once per run, six angles"),
      number_list_parameter(
          n.name + "_misalignments_deg", "deg", {0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
          "x towards y and z, y towards x and z, z towards x and y, added to what is drawn", 6),
      positive_parameter(n.name + "_range_" + n.unit_key, n.unit, range, "saturation"),
      number_parameter(n.name + "_resolution_" + n.unit_key, n.unit, 0.0, 0.0, 100.0,
                       "step of the reading; 0: none")};
}

TriadFigures triad_figures(const TriadNames& n, const ParameterSet& parameters) {
  TriadFigures f;
  f.allan.white_u_rtHz = n.si * parameters.number(n.name + "_noise_" + n.unit_key + "_rtHz");
  f.allan.instability_u =
      n.instability_si * parameters.number(n.name + "_bias_instability_" + n.instability_key);
  f.allan.walk_u_per_rts = n.si * parameters.number(n.name + "_walk_" + n.walk_key + "_rtHz");
  f.turn_on_bias_std_u = n.si * parameters.number(n.name + "_bias_std_" + n.unit_key);
  f.scale_error_std = parameters.number(n.name + "_scale_error_std");
  const auto& scale = parameters.numbers(n.name + "_scale_errors");
  f.scale_errors = {scale[0], scale[1], scale[2]};
  f.misalignment_std_rad = rad_from_deg(parameters.number(n.name + "_misalignment_std_deg"));
  const auto& m = parameters.numbers(n.name + "_misalignments_deg");
  f.misalignments << 0.0, m[0], m[1], m[2], 0.0, m[3], m[4], m[5], 0.0;
  f.misalignments *= rad_from_deg(1.0);
  f.range_u = n.si * parameters.number(n.name + "_range_" + n.unit_key);
  f.resolution_u = n.si * parameters.number(n.name + "_resolution_" + n.unit_key);
  return f;
}

Triad::Triad(const TriadNames& names, const ParameterSet& parameters, const PartContext& context)
    : figures_(triad_figures(names, parameters)),
      noise_random_(context.random(names.name + "_noise")),
      bias_random_(context.random(names.name + "_bias")) {
  const AllanFigures& allan = figures_.allan;
  const double root_period = std::sqrt(context.period.s());
  white_std_u_ = allan.white_u_rtHz / root_period;
  walk_std_u_ = allan.walk_u_per_rts * root_period;
  const double process_std = calc_instability_std(allan);
  if (process_std < 0.0) {
    const double to_unit = 1.0 / names.instability_si;
    throw ConfigError(fmt::format(
        "{0}_bias_instability_{1} = {2:.6g} {3} asks for a least Allan deviation of {4:.6g} {3}, "
        "but white noise and random walk alone are {5:.6g} {3} or more up to {6:g} s",
        names.name, names.instability_key, allan.instability_u * to_unit, names.instability_unit,
        kInstabilityFactor * allan.instability_u * to_unit,
        calc_least_allan_deviation(allan, 0.0) * to_unit, kLongestAveraging_s));
  }
  wanders_ = process_std > 0.0 || walk_std_u_ > 0.0;
  RandomStream device = context.random(names.name + "_device");
  gain_.setIdentity();
  for (int i = 0; i < 3; ++i) {
    bias_u_[i] = figures_.turn_on_bias_std_u * device.normal();
    for (int j = 0; j < 3; ++j) {
      gain_(i, j) +=
          i == j ? figures_.scale_errors[i] + figures_.scale_error_std * device.normal()
                 : figures_.misalignments(i, j) + figures_.misalignment_std_rad * device.normal();
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

}  // namespace vinerow
