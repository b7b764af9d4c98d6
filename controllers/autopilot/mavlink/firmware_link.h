#pragma once
/// What a vehicle exchanges with its firmware by MAVLink: the mission, the readings of our
/// receiver, the firmware's own estimate and what it says.

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "controllers/autopilot/frames/firmware_frame.h"
#include "controllers/autopilot/mavlink/ground_station.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/path.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/signal.h"
#include "engine/api/vehicle.h"
#include "engine/io/missions/mission_file.h"

namespace vinerow::controllers {

struct FirmwareLinkOptions {
  std::optional<io::MissionFile> mission;  ///< absent: the vehicle's plan, if it has one
  double tolerance_m = 0.05;               ///< farthest that its legs may be from a plan
  std::string gps_input;                   ///< sensor whose readings it gets as GPS_INPUT
  FirmwareFrame::Receiver receiver = FirmwareFrame::Receiver::kOfFirmware;
  bool has_home_item = true;  ///< missions begin with home
  GroundStationOptions station;
};

class FirmwareLink {
 public:
  using Send = GroundStation::Send;

  /// @param part  for events
  FirmwareLink(FirmwareLinkOptions options, const GeoOrigin& origin,
               const VehicleDescription& vehicle, std::string part, Send send);

  /// Writes "estimate" and "follower"; reads the plan and the receiver.
  void connect(Ports& ports);
  /// Bytes from the firmware.
  void take(Time now, std::span<const std::uint8_t> bytes);
  /// Sends what is due. Nothing before the firmware has sent something: its address is unknown.
  void step(Time now);
  /// What the firmware said since the last call.
  std::vector<Event> take_events();

  bool finished() const { return station_.finished(); }
  const std::string& failure() const { return station_.failure(); }
  const FirmwareFrame& frame() const { return frame_; }

 private:
  void begin_mission(const io::MissionFile& mission);
  void write_estimate(Time now);
  void write_follower(Time now);

  FirmwareLinkOptions options_;
  const VehicleDescription& vehicle_;
  std::string part_;
  Send send_;
  FirmwareFrame frame_;
  GroundStation station_;
  mavlink::FrameReader reader_;
  mavlink::FrameWriter receiver_{mavlink::Sender{255, 220}};  // MAV_COMP_ID_GPS
  bool has_heard_ = false, has_mission_ = false, has_complained_ = false;
  std::optional<Time> begin_;
  std::vector<Event> events_;
  Time last_estimate_;
  std::uint64_t last_fix_ = 0;
  SignalReader<PlannedPath> plan_;
  SignalReader<GnssFix> gnss_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<FollowerState> follower_writer_;
  FollowerState follower_;
};

}  // namespace vinerow::controllers
