#pragma once
/// Quadrotor as a rigid body with four rotors.
///
/// Actuators: rotor_1_speed_radps .. rotor_4_speed_radps (0 .. max), counted counter-clockwise as
/// seen from above, from the front left (X) or the front (+). Signals: "rotors" (NamedValues: speed
/// and thrust of each, wind), "battery", "vehicle_event".
///
/// Equation of body and rotors about the centre of mass, with the sum h of the rotors' angular
/// momenta along z of B:
///   I dw/dt + w x I w = torques of thrust, drag and air - dh/dt e_z - w x h e_z
/// Spinning up turns the body the other way, and a net h makes it precess. Forces are evaluated in
/// the middle of a step: rotor speeds in closed form, attitude and velocities extrapolated by half
/// a step from their last change. The integration is second order in the step. Changes of the
/// rotors' angular momentum are accounted for exactly: the error of the prediction in one step is
/// corrected in the next.
///
/// B: centre of mass, x forward, y left, z up. It spawns on its landing gear with the rotors off.
/// Once wrecked (crash()) the rotors stop and physics goes on.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/registry.h"
#include "engine/physics/physics_world.h"
#include "vehicles/parts/foliage_watch.h"
#include "vehicles/parts/link_shelf.h"
#include "vehicles/parts/mid_step.h"
#include "vehicles/parts/wind_probe.h"
#include "vehicles/quadrotor/quadrotor_params.h"

namespace vinerow::vehicles {

/// A rotor as of the last step.
struct RotorState {
  double speed_radps = 0.0;
  double angle_rad = 0.0;     ///< positive counter-clockwise seen from above; for display
  double thrust_N = 0.0;      ///< mean over the step
  double thrust_ratio = 1.0;  ///< ground effect
};

class Quadrotor final : public Vehicle {
 public:
  /// @throws ConfigError
  Quadrotor(const QuadrotorParams& params, const VehicleContext& context,
            const LinkShelf& links = {});

  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld& world, const Pose& X_WB) override;
  void connect(Ports& ports) override;
  void actuate(std::span<const double> values) override;
  void before_physics(Time now, Duration dt) override;
  void after_physics(Time now, Duration dt) override;
  void read_truth(Odometry& truth) const override;
  Eigen::Vector3d specific_force_B() const override { return specific_force_B_; }
  Eigen::Vector3d air_velocity_B() const override;
  std::span<const double> actuator_states() const override { return actuator_states_; }
  std::string_view crash() const override { return crash_; }
  void read_links(std::vector<Pose>& X_WL) const override;
  void publish(Time now) override;

  /// Starts in flight. @param speeds_radps  of the rotors
  void set_motion(const physics::BodyState& body, const std::array<double, kRotors>& speeds_radps);

  const QuadrotorParams& params() const { return params_; }
  const std::array<RotorState, kRotors>& rotors() const { return rotors_; }
  const physics::BodyState& body() const { return motion_.body(); }
  const BatteryState& battery() const { return battery_; }
  physics::BodyId body_id() const { return body_id_; }
  const FoliageWatch& foliage_watch() const { return foliage_; }
  /// Angular momentum of the rotors' spin along z of B, N m s.
  double rotor_momentum_Nms() const;
  /// Angular momentum of body and rotors about the centre of mass, in W, N m s.
  Eigen::Vector3d angular_momentum_W() const;

 private:
  /// Force and torque of rotors and air in the middle of the step.
  struct Load {
    Eigen::Vector3d force_B = Eigen::Vector3d::Zero();
    Eigen::Vector3d torque_B = Eigen::Vector3d::Zero();
    double shaft_W = 0.0;
  };
  void describe();
  /// Scales the described thrust and drag of the rotors by the density at the start over the rated
  /// one.
  void describe_air(double density_ratio);
  std::vector<VehicleLink> make_links() const;
  void meet_faults(Time now);
  void feel_wind(Time now, Duration dt);
  void feel_ground();
  void press_feet(Eigen::Vector3d& force_W, Eigen::Vector3d& torque_W);
  Load run_rotors(double dt_s, const Eigen::Vector3d& air_B, const Eigen::Vector3d& w_B);
  void report_event(Event::Level level, std::string text);
  double wanted_radps(std::size_t rotor) const;

  QuadrotorParams params_;
  std::string name_;
  RandomStream random_;
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  FoliageWatch foliage_;
  GroundEffect ground_effect_;
  RotorAir rotor_air_;
  std::array<Eigen::Vector3d, kRotors> hubs_B_, feet_B_;
  Duration lags_for_;
  RotorLags lags_;

  physics::PhysicsWorld* world_ = nullptr;
  physics::BodyId body_id_;
  std::optional<WindProbe> probe_;
  MidStep motion_;
  Eigen::Vector3d booked_momentum_W_ = Eigen::Vector3d::Zero();  // of the rotors, given to the body
  Eigen::Vector3d wind_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_B_ = Eigen::Vector3d::Zero();

  std::array<double, kRotors> commands_radps_{};
  std::array<double, kRotors> speed_share_{1.0, 1.0, 1.0, 1.0};  // left after failures
  std::array<RotorState, kRotors> rotors_;
  std::array<LandingFootState, kRotors> feet_;
  bool ground_is_near_ = true;
  std::vector<double> actuator_states_;
  std::vector<bool> fault_met_;
  BatteryState battery_;
  bool powered_ = true;
  std::string crash_;

  std::vector<Event> news_;  // not reported yet
  NamedValues rotors_message_;
  SignalWriter<NamedValues> rotors_writer_;
  SignalWriter<BatteryState> battery_writer_;
  SignalWriter<Event> event_writer_;
};

std::unique_ptr<Vehicle> make_quadrotor(const ParameterSet& parameters,
                                        const VehicleContext& context);

}  // namespace vinerow::vehicles
