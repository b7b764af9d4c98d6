#pragma once
/// What a ground station does with an autopilot: sets parameters, waits until it is ready, uploads
/// a mission, arms, starts the mission and watches it. All waiting is in simulated time, and
/// everything is sent between two steps, so a run repeats.
///
/// Sources: MAVLink's guide, "Mission protocol" and "Command protocol"; ArduPilot 4.6.3.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "controllers/autopilot/mavlink/parameter_file.h"
#include "controllers/autopilot/mavlink/parameter_value.h"
#include "controllers/autopilot/mavlink/status_texts.h"
#include "engine/core/time.h"
#include "engine/mavlink/frame.h"
#include "engine/mavlink/messages.h"

namespace vinerow::controllers {

/// A command of the user's, at a time since the ground station's first step.
struct ScheduledCommand {
  double at_s = 0.0;
  int command = 0;             ///< MAV_CMD
  std::vector<double> params;  ///< at most 7; missing ones are 0
};

struct GroundStationOptions {
  std::vector<FirmwareParameter> parameters;  ///< set one by one before anything else
  std::vector<ScheduledCommand> commands;     ///< in order of time
  /// MAV_TYPE of the vehicle; firmware of another one is refused. Absent: any.
  std::optional<std::uint8_t> vehicle_type;
  bool expects_mission = false;    ///< fly() will be called
  double report_rate_Hz = 10.0;    ///< of attitude and position
  double ready_timeout_s = 120.0;  ///< until its own checks let it be armed
  double answer_timeout_s = 10.0;  ///< of each request, which is repeated every second
};

/// The firmware's own estimate.
struct FirmwareEstimate {
  Time time;
  mavlink::LocalPositionNed position;
  mavlink::Attitude attitude;
  mavlink::GpsGlobalOrigin origin;  ///< of the position
};

class GroundStation {
 public:
  using Send = std::function<void(std::span<const std::uint8_t>)>;

  /// @param send  sends a frame to the autopilot
  GroundStation(GroundStationOptions options, Send send);

  /// A frame of the autopilot.
  void take(Time now, const mavlink::Frame& frame);
  /// Sends what is due.
  void step(Time now);

  /// Items with their numbers. It uploads them as soon as the vehicle is ready, and starts them.
  void fly(std::vector<mavlink::MissionItemInt> mission) { mission_ = std::move(mission); }

  /// The last item of the mission was reached, or the vehicle was disarmed after its flight.
  bool finished() const { return stage_ == Stage::kDone; }
  /// Why the mission cannot be flown, one sentence without subject; empty: no reason.
  const std::string& failure() const { return failure_; }
  /// The latest estimate, if attitude, position and its origin have come.
  const std::optional<FirmwareEstimate>& estimate() const { return estimate_; }
  /// Its way to the next item: number, and cross-track error in its own sign.
  int current_item() const { return current_item_; }
  const std::optional<mavlink::NavControllerOutput>& navigation() const { return navigation_; }
  /// Sentences of the autopilot since the last call.
  std::vector<SpokenText> take_texts();
  /// Number of items that were reached.
  int items_reached() const { return items_reached_; }

 private:
  enum class Stage {
    kListen,
    kParameters,
    kReady,
    kUpload,
    kMode,
    kArm,
    kStart,
    kFlight,
    kDone,
    kFailed
  };

  void enter(Time now, Stage stage);
  void meet(Time now, const mavlink::Frame& frame);
  void fail(const std::string& reason);
  /// True once per second of a stage: the request is sent (again).
  bool is_due(Time now);
  void request(const mavlink::CommandLong& command);
  /// Attitude, position and status, at their rates.
  void request_streams();
  void request_origin();
  void take_ekf_status(const mavlink::EkfStatusReport& status);
  void take_text(const mavlink::StatusText& piece);
  ParameterEncoding encoding() const;
  void send_parameter();
  void next_parameter(Time now);
  void send_commands(Time now);
  void send_item(Time now, int number);
  void take_parameter(Time now, const mavlink::ParamValue& value);
  void take_heartbeat(Time now, const mavlink::Frame& frame);
  void take_ack(Time now, const mavlink::CommandAck& ack);
  void take_mission_ack(Time now, const mavlink::MissionAck& ack);
  /// What the autopilot said last, for reasons: " (PreArm: ...)".
  std::string last_complaint() const;
  std::optional<std::uint32_t> arming_mode() const;

  GroundStationOptions options_;
  std::vector<mavlink::MissionItemInt> mission_;
  Send send_;
  mavlink::FrameWriter writer_{mavlink::Sender{255, 190}};  // as ground stations have
  Stage stage_ = Stage::kListen;
  Time stage_begin_, last_request_;
  std::optional<Time> begin_;
  bool has_requested_ = false;
  std::size_t next_parameter_ = 0, next_command_ = 0;
  /// Of the parameter that is set now, if the encoding depends on it.
  std::optional<std::uint8_t> parameter_type_;
  std::string failure_, complaint_;
  mavlink::Sender vehicle_;
  mavlink::Heartbeat heartbeat_;
  bool was_armed_ = false, is_ready_ = false, knows_place_ = true;
  int items_reached_ = 0, current_item_ = 0;
  std::optional<mavlink::NavControllerOutput> navigation_;
  std::optional<mavlink::Attitude> attitude_;
  std::optional<mavlink::GpsGlobalOrigin> origin_;
  std::optional<FirmwareEstimate> estimate_;
  StatusTexts pieces_;
  std::vector<SpokenText> texts_;
};

}  // namespace vinerow::controllers
