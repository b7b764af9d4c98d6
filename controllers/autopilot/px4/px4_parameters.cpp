#include "controllers/autopilot/px4/px4_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/autopilot/px4/px4_outputs.h"
#include "engine/api/vehicle.h"
#include "engine/api/vehicle_kinds.h"
#include "engine/core/constants.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Parameters = std::vector<FirmwareParameter>;

void add_outputs(const FirmwareParams& params, const AutopilotContext& context,
                 Parameters& parameters) {
  int reversed = 0;
  // The frame has functions at other outputs.
  for (int output = 1; output <= kPx4Outputs; ++output) {
    parameters.push_back({fmt::format("PWM_MAIN_FUNC{}", output), 0});
  }
  for (const OutputChannel& channel :
       px4_output_channels(params, *context.vehicle_description, context.part)) {
    set_parameter(parameters, {fmt::format("PWM_MAIN_FUNC{}", channel.output),
                               static_cast<double>(px4_function_number(channel.function))});
    // The rear axle follows the same servo and turns the other way.
    const bool turns_back = channel.function == "rear_steering";
    if (channel.is_reversed != turns_back) reversed |= 1 << (channel.output - 1);
  }
  parameters.push_back({"PWM_MAIN_REV", static_cast<double>(reversed)});
}

/// Place of a sensor in the vehicle (forward, right, down), so that turning is not taken for
/// motion.
void add_place(const std::string& sensor, const char* name, const AutopilotContext& context,
               Parameters& parameters) {
  for (const SensorMounting& mounting : context.sensors) {
    if (mounting.name != sensor) continue;
    const Eigen::Vector3d& p_B = mounting.X_BS.p;
    parameters.push_back({fmt::format("EKF2_{}_POS_X", name), p_B.x()});
    parameters.push_back({fmt::format("EKF2_{}_POS_Y", name), -p_B.y()});
    parameters.push_back({fmt::format("EKF2_{}_POS_Z", name), -p_B.z()});
  }
}

void add_copter(const VehicleDescription& vehicle, Parameters& parameters) {
  const Rotorcraft& rotors = *vehicle.rotorcraft;
  constexpr int kMulticopter = 0;
  parameters.push_back({"CA_AIRFRAME", kMulticopter});
  parameters.push_back({"CA_ROTOR_COUNT", static_cast<double>(rotors.rotors.size())});
  const double torque_per_thrust_m = rotors.torque_coefficient_Nms2 / rotors.thrust_coefficient_Ns2;
  for (const RotorPlace& rotor : rotors.rotors) {
    const bool is_front = rotor.p_B.x() > 0.0, is_left = rotor.p_B.y() > 0.0;
    const std::string function =
        fmt::format("motor_{}_{}", is_front ? "front" : "rear", is_left ? "left" : "right");
    const int number = px4_function_number(function) - px4_function_number("motor_front_right");
    const std::string prefix = fmt::format("CA_ROTOR{}_", number);
    parameters.push_back({prefix + "PX", rotor.p_B.x()});
    parameters.push_back({prefix + "PY", -rotor.p_B.y()});
    // Positive: it turns counter-clockwise, and its drag torque turns the body to the right.
    parameters.push_back({prefix + "KM", -rotor.torque_sign * torque_per_thrust_m});
  }
  // Thrust is the square of the output.
  parameters.push_back({"THR_MDL_FAC", 1});
  const double top_N = static_cast<double>(rotors.rotors.size()) * rotors.thrust_coefficient_Ns2 *
                       rotors.max_rotor_radps * rotors.max_rotor_radps;
  parameters.push_back(
      {"MPC_THR_HOVER", std::clamp(vehicle.mass_kg * kStandardGravity_mps2 / top_N, 0.1, 0.8)});
  // Rows are a few metres apart: a waypoint is reached before the corner is cut.
  parameters.push_back({"NAV_ACC_RAD", 0.5});
}

void add_rover(const VehicleDescription& vehicle, Parameters& parameters) {
  constexpr int kAckermann = 5, kDifferential = 6;
  parameters.push_back(
      {"CA_AIRFRAME", static_cast<double>(vehicle.steers_by_axles() ? kAckermann : kDifferential)});
  // Wheels turn both ways.
  parameters.push_back({"CA_R_REV", vehicle.steers_by_axles() ? 1.0 : 3.0});
  // A share of the throttle is that share of the top speed: our drives follow their set speed. So
  // the speed's controller gives the share at once and integrates the rest. A quarter of the range
  // is left for turning.
  const double top_mps = vehicle.max_speed_mps.value_or(2.0);
  constexpr double kShare = 0.75;
  parameters.push_back({"GND_SP_CTRL_MODE", 1});
  parameters.push_back({"GND_SPEED_TRIM", kShare * top_mps});
  parameters.push_back({"GND_SPEED_MAX", top_mps});
  parameters.push_back({"GND_SPEED_THR_SC", 1});
  parameters.push_back({"GND_SPEED_P", 0.5 / top_mps});
  parameters.push_back({"GND_SPEED_I", 1.0 / top_mps});
  parameters.push_back({"GND_SPEED_D", 0});
  parameters.push_back({"GND_SPEED_IMAX", 1});
  parameters.push_back({"GND_THR_MAX", kShare});
  parameters.push_back({"GND_THR_CRUISE", kShare});
  parameters.push_back({"GND_THR_MIN", 0});
  // It steers by the angle that a car with this wheel base would need; the largest one is the full
  // output. A car turns with base / tan(angle). A rover with two sides turns on the spot: there a
  // right angle is the full output, which keeps it from swinging.
  const double base_m = vehicle.wheeled ? vehicle.wheeled->wheel_base_m : 1.0;
  const double radius_m = vehicle.min_turning_radius_m.value_or(0.0);
  const double angle_rad = vehicle.steers_by_axles() ? std::atan2(base_m, radius_m) : 0.5 * kPi;
  parameters.push_back({"GND_WHEEL_BASE", base_m});
  parameters.push_back({"GND_MAX_ANG", angle_rad});
  parameters.push_back({"GND_L1_PERIOD", 5});
  parameters.push_back({"GND_L1_DIST", 1});
  // It stops within the second radius of a waypoint, so the first must be larger.
  parameters.push_back({"NAV_ACC_RAD", 0.5});
  parameters.push_back({"NAV_LOITER_RAD", 0.25});
}

void add_plane(const VehicleDescription& vehicle, Parameters& parameters) {
  const FixedWingAircraft& plane = *vehicle.fixed_wing;
  constexpr int kFixedWing = 1, kLeftElevon = 5, kRightElevon = 6;
  parameters.push_back({"CA_AIRFRAME", kFixedWing});
  parameters.push_back({"CA_ROTOR_COUNT", 1});
  parameters.push_back({"CA_SV_CS_COUNT", 2});
  // An elevon that goes up raises the nose and lowers its own wing.
  parameters.push_back({"CA_SV_CS0_TYPE", kLeftElevon});
  parameters.push_back({"CA_SV_CS0_TRQ_R", -0.5});
  parameters.push_back({"CA_SV_CS0_TRQ_P", 0.5});
  parameters.push_back({"CA_SV_CS0_TRQ_Y", 0});
  parameters.push_back({"CA_SV_CS1_TYPE", kRightElevon});
  parameters.push_back({"CA_SV_CS1_TRQ_R", 0.5});
  parameters.push_back({"CA_SV_CS1_TRQ_P", 0.5});
  parameters.push_back({"CA_SV_CS1_TRQ_Y", 0});
  const double top_mps = vehicle.max_speed_mps.value_or(1.5 * plane.cruise_speed_mps);
  parameters.push_back({"FW_AIRSPD_STALL", plane.stall_speed_mps});
  parameters.push_back({"FW_AIRSPD_MIN", 1.15 * plane.stall_speed_mps});
  parameters.push_back({"FW_AIRSPD_TRIM", plane.cruise_speed_mps});
  parameters.push_back({"FW_AIRSPD_MAX", top_mps});
  parameters.push_back({"FW_R_LIM", std::floor(deg_from_rad(plane.max_bank_rad))});
  // Our launcher waits for the throttle, as a runway does; PX4's launch by hand waits for the
  // throw. So it takes off as from a runway: with its nose up, free as soon as it flies.
  parameters.push_back({"RWTO_TKOFF", 1});
  parameters.push_back({"RWTO_RAMP_TIME", 1});
  parameters.push_back({"RWTO_PSP", 15});
  parameters.push_back({"RWTO_ROT_AIRSPD", plane.stall_speed_mps});
  // The frame is tuned for a heavier aircraft with a tail: PX4's own defaults instead.
  for (const auto& [name, value] :
       std::initializer_list<std::pair<const char*, double>>{{"TRIM_PITCH", 0},
                                                             {"FW_PSP_OFF", 0},
                                                             {"FW_P_LIM_MIN", -30},
                                                             {"FW_THR_MIN", 0},
                                                             {"FW_THR_MAX", 1},
                                                             {"FW_THR_TRIM", 0.6},
                                                             {"FW_T_CLMB_MAX", 5},
                                                             {"FW_T_SINK_MAX", 5},
                                                             {"FW_T_SINK_MIN", 2},
                                                             {"FW_PR_P", 0.08},
                                                             {"FW_PR_I", 0.1},
                                                             {"FW_PR_FF", 0.5},
                                                             {"FW_RR_P", 0.05},
                                                             {"FW_RR_I", 0.1},
                                                             {"FW_RR_FF", 0.5},
                                                             {"FW_YR_P", 0.05},
                                                             {"FW_YR_I", 0.1},
                                                             {"FW_YR_FF", 0.3},
                                                             {"FW_W_EN", 0}}) {
    parameters.push_back({name, value});
  }
}

}  // namespace

Parameters px4_parameters(const FirmwareParams& params, const AutopilotContext& context) {
  const VehicleDescription& vehicle = *context.vehicle_description;
  Parameters parameters;
  constexpr double kNoLog = -1, kNoSticks = 4, kReceiver = 0, kNoAction = 0;
  parameters.push_back({"SDLOG_MODE", kNoLog});
  parameters.push_back({"COM_RC_IN_MODE", params.sticks.empty() ? kNoSticks : kReceiver});
  // The ground station is the run itself.
  parameters.push_back({"NAV_DLL_ACT", kNoAction});
  parameters.push_back({"MIS_TKO_LAND_REQ", 0});
  parameters.push_back({"IMU_INTEG_RATE", 1.0 / context.period.s()});
  add_place(params.imu, "IMU", context, parameters);
  add_place(params.gnss, "GPS", context, parameters);
  add_outputs(params, context, parameters);
  if (vehicle.rotorcraft) {
    add_copter(vehicle, parameters);
  } else if (vehicle.fixed_wing) {
    add_plane(vehicle, parameters);
  } else {
    add_rover(vehicle, parameters);
  }
  // Without a pitot tube its checks would wait for one.
  if (params.airspeed.empty()) parameters.push_back({"CBRK_AIRSPD_CHK", 162128});
  return parameters;
}

int px4_airframe(const VehicleDescription& vehicle) {
  // Frames that set nothing but parameters: none_iris, gazebo-classic's plane, rover and r1_rover.
  constexpr int kQuadrotor = 10016, kPlane = 1030, kAckermannRover = 1060,
                kDifferentialRover = 1061;
  if (vehicle.rotorcraft) return kQuadrotor;
  if (vehicle.fixed_wing) return kPlane;
  return vehicle.steers_by_axles() ? kAckermannRover : kDifferentialRover;
}

}  // namespace vinerow::controllers
