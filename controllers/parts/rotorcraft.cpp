#include "controllers/parts/rotorcraft.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow {
namespace {

/// A number of the description that must be > 0.
double read_positive(const VehicleDescription& description, const std::string& name,
                     const std::string& who) {
  const double value = description.number(name, who);
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw ConfigError(fmt::format("{} needs '{}' > 0, but vehicle type '{}' tells {:g}", who, name,
                                  description.type, value));
  }
  return value;
}

}  // namespace

double Rotorcraft::hover_rotor_radps() const {
  return std::sqrt(mass_kg * gravity_mps2 /
                   (static_cast<double>(rotors.size()) * thrust_coefficient));
}

Rotorcraft read_rotorcraft(const VehicleDescription& description, double gravity_mps2,
                           const std::string& who) {
  Rotorcraft craft;
  const double count = read_positive(description, "rotor_count", who);
  craft.gravity_mps2 = gravity_mps2;
  craft.mass_kg = description.mass_kg;
  if (!(craft.mass_kg > 0.0)) {
    throw ConfigError(fmt::format("{} needs a mass > 0 kg, but vehicle type '{}' tells {:g} kg",
                                  who, description.type, craft.mass_kg));
  }
  craft.inertia_kgm2 = {read_positive(description, "inertia_xx_kgm2", who),
                        read_positive(description, "inertia_yy_kgm2", who),
                        read_positive(description, "inertia_zz_kgm2", who)};
  for (int i = 1; i <= static_cast<int>(count); ++i) {
    RotorPlace rotor;
    rotor.p_B = {description.number(fmt::format("rotor_{}_x_m", i), who),
                 description.number(fmt::format("rotor_{}_y_m", i), who)};
    rotor.torque_sign = description.number(fmt::format("rotor_{}_torque_sign", i), who);
    craft.rotors.push_back(rotor);
  }
  craft.thrust_coefficient = read_positive(description, "rotor_thrust_coefficient", who);
  craft.torque_coefficient = description.number("rotor_torque_coefficient", who);
  craft.min_rotor_radps = description.number("rotor_min_radps", who);
  craft.max_rotor_radps = read_positive(description, "rotor_max_radps", who);
  craft.rotor_lag_s = description.number("rotor_lag_s", who);
  craft.rotor_drag_Ns_per_m = description.number("rotor_drag_Ns_per_m", who);
  const auto inertia = description.numbers.find("rotor_inertia_kgm2");
  if (inertia != description.numbers.end()) craft.rotor_inertia_kgm2 = inertia->second;
  const double weight_N = craft.mass_kg * gravity_mps2;
  if (craft.max_thrust_N() <= weight_N) {
    throw ConfigError(
        fmt::format("{} cannot hover: the rotors of vehicle type '{}' lift {:.4g} N at most, its "
                    "weight is {:.4g} N",
                    who, description.type, craft.max_thrust_N(), weight_N));
  }
  if (craft.min_rotor_radps < 0.0 || craft.min_rotor_radps >= craft.hover_rotor_radps()) {
    throw ConfigError(
        fmt::format("{} cannot hover: the rotors of vehicle type '{}' turn at {:.4g} rad/s at "
                    "least, hovering asks for {:.4g} rad/s",
                    who, description.type, craft.min_rotor_radps, craft.hover_rotor_radps()));
  }
  return craft;
}

HoverModel make_hover_model(const Rotorcraft& craft, bool with_lag) {
  if (with_lag && !(craft.rotor_lag_s > 0.0)) {
    throw ConfigError(fmt::format(
        "a hover model with rotor lag needs rotor_lag_s > 0 s, not {:g} s", craft.rotor_lag_s));
  }
  constexpr int kPosition = 0, kVelocity = 3, kAngle = 6, kRate = 9, kWrench = 12;
  const int n = with_lag ? HoverModel::kStatesWithLag : HoverModel::kStates;
  HoverModel model;
  model.A = Eigen::MatrixXd::Zero(n, n);
  model.B = Eigen::MatrixXd::Zero(n, HoverModel::kInputs);
  model.A.block<3, 3>(kPosition, kVelocity).setIdentity();
  // The air brakes; leaning forwards (pitch) pushes forwards, leaning right (roll) to the right.
  model.A.block<3, 3>(kVelocity, kVelocity)
      .diagonal()
      .setConstant(-craft.rotor_drag_Ns_per_m / craft.mass_kg);
  model.A(kVelocity + 0, kAngle + 1) = craft.gravity_mps2;
  model.A(kVelocity + 1, kAngle + 0) = -craft.gravity_mps2;
  model.A.block<3, 3>(kAngle, kRate).setIdentity();
  Eigen::MatrixXd effect = Eigen::MatrixXd::Zero(n, HoverModel::kInputs);
  effect(kVelocity + 2, 0) = 1.0 / craft.mass_kg;
  effect.block<3, 3>(kRate, 1) = craft.inertia_kgm2.cwiseInverse().asDiagonal();
  if (!with_lag) {
    model.B = effect;
    return model;
  }
  // Thrust k w^2 about hover lags as the speed w does.
  model.A.middleCols<4>(kWrench) = effect;
  model.A.block<4, 4>(kWrench, kWrench).diagonal().setConstant(-1.0 / craft.rotor_lag_s);
  model.B.middleRows<4>(kWrench).diagonal().setConstant(1.0 / craft.rotor_lag_s);
  if (craft.rotor_inertia_kgm2 > 0.0 && craft.torque_coefficient > 0.0) {
    const double lead_s = craft.rotor_inertia_kgm2 /
                          (2.0 * craft.hover_rotor_radps() * craft.torque_coefficient);
    const double at_once = lead_s / craft.rotor_lag_s / craft.inertia_kgm2.z();
    model.A(kRate + 2, kWrench + 3) -= at_once;
    model.B(kRate + 2, 3) = at_once;
  }
  return model;
}

}  // namespace vinerow
