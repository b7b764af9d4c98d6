#pragma once
/// Flight mechanics of the flying wing, for its physics, for trim and for linear models.

#include <optional>

#include "engine/api/flight_model.h"
#include "vehicles/fixed_wing/fixed_wing_params.h"

namespace vinerow::vehicles {

class FixedWingModel final : public FlightModel {
 public:
  explicit FixedWingModel(const FixedWingParams& params)
      : wing_(params.wing),
        propeller_(params.propeller),
        mass_kg_(params.mass_kg),
        inertia_B_(params.inertia_B()) {}

  /// @param actuators  throttle, left and right elevon in rad
  AirLoad load(const AirPoint& air, std::span<const double> actuators) const override;
  double mass_kg() const override { return mass_kg_; }
  Eigen::Matrix3d inertia_B() const override { return inertia_B_; }

  /// Load with the mean of the throttle squared over a step.
  AirLoad load(const AirPoint& air, double throttle_square, const Elevons& elevons) const;

 private:
  WingParams wing_;
  PropellerParams propeller_;
  double mass_kg_;
  Eigen::Matrix3d inertia_B_;
};

/// Straight level flight through calm air.
struct LevelFlight {
  double alpha_rad = 0.0;
  double throttle = 0.0;
  double elevator_rad = 0.0;
};

/// Finds level flight by bisection over the angle of attack below stall.
/// @returns null if lift, throttle or elevons do not suffice
std::optional<LevelFlight> find_level_flight(const FixedWingParams& params, double airspeed_mps,
                                             double gravity_mps2, double air_density_kgm3);

}  // namespace vinerow::vehicles
