#pragma once
/// PX4's interface to simulators (HIL): readings of sensors as MAVLink, outputs as shares.
///
/// HIL_SENSOR moves PX4's clock and comes last in a state. Outputs carry the stamp of the state
/// that they answer.
/// Source: PX4 1.14.3, src/modules/simulation/simulator_mavlink.

#include <optional>
#include <string>
#include <vector>

#include "controllers/autopilot/firmware/dialect.h"
#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/outputs/output_channels.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/stepped_parts.h"
#include "engine/math/geo.h"
#include "engine/mavlink/frame.h"
#include "engine/mavlink/messages.h"

namespace vinerow::controllers {

class Px4Dialect final : public Dialect {
 public:
  /// @throws ConfigError if the parameters do not fit the vehicle or a sensor is missing
  Px4Dialect(FirmwareParams params, const AutopilotContext& context, const std::string& who);

  void connect(Ports& ports) override;
  std::string_view missing_sensor() const override;
  FirmwareState boot_state(std::uint64_t number) override;
  std::string begin(Time now, Bytes outputs) override;
  Result<FirmwareState> write_state(Time now) override;
  NamedValues make_actuators() const override { return outputs_.make_actuators(); }
  std::string take_outputs(Bytes outputs, NamedValues& actuators) override;
  const NamedValues& outputs() const override { return shares_; }

 private:
  static constexpr mavlink::Sender kSimulator{1, 200};  // as PX4's own simulators

  /// A reading is sent once.
  struct Rangefinder {
    SignalReader<RangeSample> reader;
    std::uint8_t orientation = 0;
    std::uint64_t last = 0;
  };

  template <class M>
  void add(const M& message);
  /// @param sends_all  also readings that were sent before
  mavlink::HilSensor read_sensors(std::uint64_t stamp_us, bool sends_all);
  void add_truth(std::uint64_t stamp_us);
  void add_ranges(std::uint64_t stamp_us);
  void add_sticks(Time now, std::uint64_t stamp_us);
  FirmwareState finish(std::uint64_t stamp_us) const { return {bytes_, stamp_us}; }

  FirmwareParams params_;
  Duration period_;
  LocalFrame frame_;
  Eigen::Quaterniond q_B_imu_, q_B_magnetometer_;
  OutputMap outputs_;
  NamedValues shares_;
  mavlink::FrameWriter writer_{kSimulator};
  mavlink::FrameReader reader_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t boot_us_ = 0;   ///< PX4's clock when the run began
  std::uint64_t stamp_us_ = 0;  ///< of the last state
  Time begin_;
  std::size_t next_stick_ = 0;
  std::uint64_t states_ = 0;
  mavlink::RcChannels pilot_;
  std::uint64_t last_field_ = 0, last_pressure_ = 0, last_air_ = 0, last_fix_ = 0;

  SignalReader<Odometry> truth_;
  SignalReader<ImuSample> imu_;
  SignalReader<MagneticSample> magnetometer_;
  SignalReader<PressureSample> barometer_;
  SignalReader<GnssFix> gnss_;
  SignalReader<AirData> airspeed_;
  std::vector<Rangefinder> ranges_;
  std::vector<std::uint8_t> orientations_;
};

}  // namespace vinerow::controllers
