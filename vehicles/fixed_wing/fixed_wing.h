#pragma once
/// Flying wing as a rigid body: lift, drag and moments by coefficients with stall
/// (parts/wing_aerodynamics.h), a propeller with motor, elevons with servos.
///
/// Actuators: throttle (0..1), elevon_left_rad, elevon_right_rad (trailing edge down > 0). Signals:
/// "air" (NamedValues: airspeed, angles, actuator states, thrust, wind), "battery",
/// "vehicle_event".
///
/// Loads are evaluated in the middle of a step: throttle and servos in closed form, motion
/// extrapolated by half a step from its last change. The integration is second order in the step.
///
/// It spawns on its launcher above the spawn point and stays there until the throttle command first
/// exceeds `launch_throttle`; then it is accelerated evenly and flies. With `launch: air` it flies
/// from the start, trimmed. It lands on its belly. Once wrecked (crash()) the motor stops and
/// physics goes on. B: centre of mass, x forward, y left, z up.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/registry.h"
#include "engine/physics/physics_world.h"
#include "vehicles/fixed_wing/fixed_wing_model.h"
#include "vehicles/fixed_wing/fixed_wing_params.h"
#include "vehicles/fixed_wing/launcher.h"
#include "vehicles/parts/foliage_watch.h"
#include "vehicles/parts/link_shelf.h"
#include "vehicles/parts/mid_step.h"
#include "vehicles/parts/rotor.h"
#include "vehicles/parts/wind_probe.h"

namespace vinerow::vehicles {

class FixedWing final : public Vehicle {
 public:
  /// Actuators: throttle, left elevon, right elevon.
  static constexpr std::size_t kActuators = 3;
  using Actuators = std::array<double, kActuators>;

  /// @throws ConfigError
  FixedWing(const FixedWingParams& params, const VehicleContext& context,
            const LinkShelf& links = {});

  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  /// @throws ConfigError "plane: start_speed_mps = 7 allows no level flight: ..."
  void spawn(physics::PhysicsWorld& world, const Pose& X_WB) override;
  void connect(Ports& ports) override;
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void after_physics(Time now, Duration dt) override;
  void read_truth(Odometry& truth) const override;
  Eigen::Vector3d specific_force_B() const override { return specific_force_B_; }
  std::span<const double> actuator_states() const override { return states_; }
  Eigen::Vector3d air_velocity_B() const override;
  std::string_view crash() const override { return crash_; }
  void read_links(std::vector<Pose>& X_WL) const override;
  void publish(Time now) override;

  /// Starts in flight. @param actuators  states and commands
  void set_motion(const physics::BodyState& body, const Actuators& actuators);

  const FixedWingParams& params() const { return params_; }
  const FixedWingModel& model() const { return *model_; }
  const physics::BodyState& body() const { return motion_.body(); }
  const BatteryState& battery() const { return battery_; }
  physics::BodyId body_id() const { return body_id_; }
  bool is_on_launcher() const { return launcher_.holds(); }
  const Eigen::Vector3d& wind_W() const { return wind_W_; }

 private:
  void describe();
  /// Adds the air density at the start, for which the described numbers are valid.
  void describe_air(double density_kgm3);
  std::vector<VehicleLink> make_links() const;
  void start_in_air(const Pose& X_WB, const Eigen::Vector3d& ground_W);
  void meet_faults(Time now);
  /// Advances motor and servos. @returns the mean of the throttle squared over the step
  double move_actuators(Duration dt, Elevons& middle);
  void report_event(Event::Level level, std::string text);
  double wanted_throttle() const;

  FixedWingParams params_;
  std::string name_;
  double gravity_mps2_;
  RandomStream random_;
  std::shared_ptr<const FixedWingModel> model_;
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  FoliageWatch foliage_;
  Pose hinge_left_X_BE_, hinge_right_X_BE_;
  Duration lag_for_;
  SpeedLag throttle_lag_;

  physics::PhysicsWorld* world_ = nullptr;
  physics::BodyId body_id_;
  std::optional<WindProbe> probe_;
  Launcher launcher_;
  MidStep motion_;
  Eigen::Vector3d wind_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_B_ = Eigen::Vector3d::Zero();

  Actuators commands_{}, states_{};
  std::array<bool, 2> stuck_{};  // elevons, left and right
  bool motor_runs_ = true;
  double thrust_N_ = 0.0;
  double propeller_rad_ = 0.0;  // for display
  std::vector<bool> fault_met_;
  BatteryState battery_;
  std::string crash_;

  std::vector<Event> news_;  // not reported yet
  NamedValues air_message_;
  SignalWriter<NamedValues> air_writer_;
  SignalWriter<BatteryState> battery_writer_;
  SignalWriter<Event> event_writer_;
};

std::unique_ptr<Vehicle> make_fixed_wing(const ParameterSet& parameters,
                                         const VehicleContext& context);

}  // namespace vinerow::vehicles
