#pragma once
/// ArduPilot's JSON interface: the state as a line, the outputs as pulses.

#include <optional>
#include <string>
#include <vector>

#include "controllers/autopilot/ardupilot/servo_packet.h"
#include "controllers/autopilot/ardupilot/state_line.h"
#include "controllers/autopilot/firmware/dialect.h"
#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/outputs/output_channels.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/stepped_parts.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

class ArdupilotDialect final : public Dialect {
 public:
  /// @throws ConfigError if the parameters do not fit the vehicle
  ArdupilotDialect(FirmwareParams params, const AutopilotContext& context, const std::string& who);

  void connect(Ports& ports) override;
  std::string_view missing_sensor() const override {
    return imu_.connected() && !imu_.has_value() ? params_.imu : std::string_view();
  }
  /// It boots without states.
  FirmwareState boot_state(std::uint64_t /*number*/) override { return {}; }
  std::string begin(Time now, Bytes outputs) override;
  Result<FirmwareState> write_state(Time now) override;
  NamedValues make_actuators() const override { return outputs_.make_actuators(); }
  std::string take_outputs(Bytes outputs, NamedValues& actuators) override;
  const NamedValues& outputs() const override { return pulses_; }

 private:
  void measure_motion(Time now, const Odometry& truth);
  void fill(Time now);

  FirmwareParams params_;
  Duration period_;
  const Vehicle& vehicle_;
  Eigen::Quaterniond q_B_imu_;
  OutputMap outputs_;
  NamedValues pulses_;
  ArdupilotState state_;
  StateLine line_;
  std::uint64_t steps_ = 0;
  Time begin_;
  std::size_t next_stick_ = 0;
  Time last_time_;  ///< of the last state
  Eigen::Quaterniond last_q_WB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d last_v_W_ = Eigen::Vector3d::Zero();

  SignalReader<Odometry> truth_;
  SignalReader<ImuSample> imu_;
  std::vector<SignalReader<RangeSample>> ranges_;
  SignalReader<AirData> airspeed_;
  SignalReader<BatteryState> battery_;
};

}  // namespace vinerow::controllers
