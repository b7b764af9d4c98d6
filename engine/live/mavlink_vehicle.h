#pragma once
/// One vehicle of a run as ground stations see it: telemetry, mission protocol, commands,
/// parameters. Frames in, frames out; no sockets, no threads, no simulation.
///
/// Sources: MAVLink's guide: "Heartbeat", "Mission protocol", "Command protocol", "Parameter
/// protocol".

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/time.h"
#include "engine/mavlink/frame.h"
#include "engine/mavlink/messages.h"

namespace vinerow::live {

/// What a vehicle reports about itself. Frames of MAVLink: north, east, down; forward, right, down.
struct MavlinkState {
  Time time;
  double latitude_rad = 0.0, longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above sea level
  double height_above_home_m = 0.0;
  Eigen::Vector3d position_NED_m = Eigen::Vector3d::Zero();  ///< from the world's origin
  Eigen::Vector3d velocity_NED_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d roll_pitch_yaw_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d rates_FRD_radps = Eigen::Vector3d::Zero();
  double airspeed_mps = 0.0;
  std::optional<double> charge;   ///< of the battery, 0 to 1
  std::optional<double> power_W;  ///< drawn from it
  bool is_at_work = true;         ///< its controller has not finished
  bool has_crashed = false;
};

/// A satellite fix for GPS_RAW_INT.
struct MavlinkFix {
  Time time;
  std::uint8_t type = 1;  ///< GPS_FIX_TYPE: 1 none, 3 position in 3D, 5 float, 6 fixed
  double latitude_rad = 0.0, longitude_rad = 0.0, altitude_m = 0.0;
  Eigen::Vector3d velocity_NED_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d std_NED_m = Eigen::Vector3d::Zero();
  int satellites = 0;
};

/// What a ground station wants of a vehicle and its run.
class MavlinkCommands {
 public:
  virtual ~MavlinkCommands() = default;
  /// Replaces the mission. @returns "" or why it cannot be flown
  virtual std::string take_mission(const std::vector<mavlink::MissionItemInt>& items) = 0;
  /// @returns "" or why not
  virtual std::string start_mission() = 0;
  virtual std::string pause(bool pauses) = 0;
  virtual std::string set_speed(double speed) = 0;
  virtual double speed() const = 0;
};

struct MavlinkVehicleOptions {
  mavlink::Sender sender;  ///< system 1, 2, ... in the scenario's order
  std::uint8_t type = 10;  ///< MAV_TYPE
  std::string name;
  double home_latitude_rad = 0.0, home_longitude_rad = 0.0, home_altitude_m = 0.0;
};

class MavlinkVehicle {
 public:
  using Send = std::function<void(std::span<const std::uint8_t>)>;

  /// @param commands  outlives the vehicle  @param send  to all ground stations
  MavlinkVehicle(MavlinkVehicleOptions options, MavlinkCommands& commands, Send send);

  /// A frame of a ground station; those for other systems are ignored.
  void take(const mavlink::Frame& frame);
  /// Sends the telemetry that is due: heartbeat, status and battery once per second, attitude and
  /// position 10 times, the pilot's display 4 times. Rates count simulated time; a paused run sends
  /// heartbeats by heartbeat().
  void report(const MavlinkState& state);
  void report(const MavlinkFix& fix);
  void heartbeat();
  /// Asks again for the item of an upload that has not come; gives up the upload at the sixth time.
  /// Call once per second of wall time.
  void remind();
  /// A sentence for people, in chunks of 50 characters. @param severity  as in syslog
  void say(std::uint8_t severity, std::string_view sentence);
  /// The plan that the vehicle follows, for download. Items are numbered here.
  void set_mission(std::vector<mavlink::MissionItemInt> items);
  void set_current(int item);
  void reached(int item);

 private:
  bool is_due(Time now, Duration period, Time& last) const;
  bool is_for_us(std::uint8_t system, std::uint8_t component) const;
  template <class M>
  void send(const M& message) {
    send_(writer_.write(message));
  }
  void acknowledge(std::uint16_t command, std::uint8_t result, const mavlink::Sender& to);
  /// @param refusal  "" if accepted; otherwise it is said
  void answer(std::uint16_t command, const std::string& refusal, const mavlink::Sender& to);
  void take_command(std::uint16_t command, double param1, const mavlink::Sender& from);
  void send_message(std::uint32_t id);
  void take_count(const mavlink::MissionCount& count, const mavlink::Sender& from);
  void take_item(const mavlink::MissionItemInt& item, const mavlink::Sender& from);
  void ask_for_item();
  void end_upload(std::uint8_t result);
  void send_item(int number, std::uint8_t mission_type, const mavlink::Sender& to);
  void send_parameter(const mavlink::Sender& to);

  MavlinkVehicleOptions options_;
  MavlinkCommands& commands_;
  Send send_;
  mavlink::FrameWriter writer_;
  mavlink::Heartbeat heartbeat_;
  Time now_, last_second_, last_attitude_, last_display_;
  bool has_reported_ = false;
  std::uint16_t text_id_ = 0;
  int current_ = 0;
  std::vector<mavlink::MissionItemInt> mission_;

  /// An upload that goes on.
  struct Upload {
    mavlink::Sender from;
    std::uint8_t mission_type = 0;
    std::size_t count = 0;
    std::vector<mavlink::MissionItemInt> items;
    int reminders = 0;
  };
  std::optional<Upload> upload_;
};

}  // namespace vinerow::live
