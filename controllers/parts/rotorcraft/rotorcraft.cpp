#include "controllers/parts/rotorcraft/rotorcraft.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::controllers {

double RotorcraftModel::hover_rotor_radps() const {
  return std::sqrt(mass_kg * gravity_mps2 /
                   (static_cast<double>(rotors.size()) * thrust_coefficient_Ns2));
}

RotorcraftModel read_rotorcraft(const VehicleDescription& description, double gravity_mps2,
                                const std::string& who) {
  RotorcraftModel craft{description.need_rotorcraft(who), description.mass_kg, gravity_mps2};
  const auto demand = [&](double value, const char* name) {
    description.need_positive(value, name, who);
  };
  demand(static_cast<double>(craft.rotors.size()), "rotors");
  if (!(craft.mass_kg > 0.0)) {
    throw ConfigError(fmt::format("{} needs a mass > 0 kg, but vehicle type '{}' has {:g} kg", who,
                                  description.type, craft.mass_kg));
  }
  demand(craft.inertia_kgm2.x(), "inertia_kgm2.x");
  demand(craft.inertia_kgm2.y(), "inertia_kgm2.y");
  demand(craft.inertia_kgm2.z(), "inertia_kgm2.z");
  demand(craft.thrust_coefficient_Ns2, "thrust_coefficient_Ns2");
  demand(craft.max_rotor_radps, "max_rotor_radps");
  const double weight_N = craft.mass_kg * gravity_mps2;
  if (craft.max_thrust_N() <= weight_N) {
    throw ConfigError(
        fmt::format("{} cannot hover: the rotors of vehicle type '{}' lift {:.4g} N at most, its "
                    "weight is {:.4g} N",
                    who, description.type, craft.max_thrust_N(), weight_N));
  }
  if (craft.min_rotor_radps < 0.0 || craft.min_rotor_radps >= craft.hover_rotor_radps()) {
    throw ConfigError(
        fmt::format("{} cannot hover: the rotors of vehicle type '{}' turn at {:.4g} rad/s or "
                    "more, hovering needs {:.4g} rad/s",
                    who, description.type, craft.min_rotor_radps, craft.hover_rotor_radps()));
  }
  return craft;
}

HoverModel make_hover_model(const RotorcraftModel& craft, bool with_lag) {
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
  // Air drag; forward pitch accelerates forwards, roll to the right accelerates to the right.
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
  if (craft.rotor_inertia_kgm2 > 0.0 && craft.torque_coefficient_Nms2 > 0.0) {
    const double lead_s = craft.rotor_inertia_kgm2 /
                          (2.0 * craft.hover_rotor_radps() * craft.torque_coefficient_Nms2);
    const double at_once = lead_s / craft.rotor_lag_s / craft.inertia_kgm2.z();
    model.A(kRate + 2, kWrench + 3) -= at_once;
    model.B(kRate + 2, 3) = at_once;
  }
  return model;
}

}  // namespace vinerow::controllers
