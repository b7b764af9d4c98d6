#include "engine/live/mavlink_vehicle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/io/missions/mission_items.h"
#include "engine/math/angles.h"
#include "engine/mavlink/enums.h"

namespace vinerow::live {
namespace {

using namespace mavlink;

constexpr Duration kSecond{1'000'000'000}, kAttitudePeriod{100'000'000},
    kDisplayPeriod{250'000'000};
constexpr std::size_t kMaxItems = 10'000;
constexpr const char* kSpeedParameter = "SIM_SPEED";

/// A number in the range of an integer field.
template <class T>
T clamped(double value) {
  const double low = static_cast<double>(std::numeric_limits<T>::lowest());
  const double high = static_cast<double>(std::numeric_limits<T>::max());
  if (std::isnan(value)) return 0;
  return static_cast<T>(std::lround(std::clamp(value, low, high)));
}

/// 0 to 360 deg.
double compass_deg(double yaw_rad) {
  const double degrees = std::fmod(deg_from_rad(yaw_rad), 360.0);
  return degrees < 0.0 ? degrees + 360.0 : degrees;
}

}  // namespace

MavlinkVehicle::MavlinkVehicle(MavlinkVehicleOptions options, MavlinkCommands& commands, Send send)
    : options_(std::move(options)),
      commands_(commands),
      send_(std::move(send)),
      writer_(options_.sender) {
  heartbeat_.type = options_.type;
  heartbeat_.autopilot = kAutopilotGeneric;
  heartbeat_.system_status = kStateStandby;
}

bool MavlinkVehicle::is_due(Time now, Duration period, Time& last) const {
  if (has_reported_ && (now - last).ns < period.ns) return false;
  last = now;
  return true;
}

void MavlinkVehicle::heartbeat() {
  send(heartbeat_);
}

void MavlinkVehicle::report(const MavlinkState& state) {
  now_ = state.time;
  const auto boot_ms = static_cast<std::uint32_t>(state.time.ns / 1'000'000);
  // Armed and guided by itself while it works.
  constexpr std::uint8_t kAuto = 4, kGuided = 8;
  heartbeat_.base_mode = state.is_at_work ? kModeFlagArmed | kAuto | kGuided : 0;
  heartbeat_.system_status = state.has_crashed  ? kStateEmergency
                             : state.is_at_work ? kStateActive
                                                : kStateStandby;
  const bool is_first = !has_reported_;
  if (is_due(state.time, kAttitudePeriod, last_attitude_)) {
    Attitude attitude;
    attitude.time_boot_ms = boot_ms;
    attitude.roll = static_cast<float>(state.roll_pitch_yaw_rad.x());
    attitude.pitch = static_cast<float>(state.roll_pitch_yaw_rad.y());
    attitude.yaw = static_cast<float>(state.roll_pitch_yaw_rad.z());
    attitude.rollspeed = static_cast<float>(state.rates_FRD_radps.x());
    attitude.pitchspeed = static_cast<float>(state.rates_FRD_radps.y());
    attitude.yawspeed = static_cast<float>(state.rates_FRD_radps.z());
    send(attitude);

    GlobalPositionInt global;
    global.time_boot_ms = boot_ms;
    const io::PlaceE7 place = io::place_e7({state.latitude_rad, state.longitude_rad, 0.0});
    global.lat = place.latitude;
    global.lon = place.longitude;
    global.alt = clamped<std::int32_t>(1000.0 * state.altitude_m);
    global.relative_alt = clamped<std::int32_t>(1000.0 * state.height_above_home_m);
    global.vx = clamped<std::int16_t>(100.0 * state.velocity_NED_mps.x());
    global.vy = clamped<std::int16_t>(100.0 * state.velocity_NED_mps.y());
    global.vz = clamped<std::int16_t>(100.0 * state.velocity_NED_mps.z());
    global.hdg = clamped<std::uint16_t>(100.0 * compass_deg(state.roll_pitch_yaw_rad.z()));
    send(global);

    LocalPositionNed local;
    local.time_boot_ms = boot_ms;
    local.x = static_cast<float>(state.position_NED_m.x());
    local.y = static_cast<float>(state.position_NED_m.y());
    local.z = static_cast<float>(state.position_NED_m.z());
    local.vx = static_cast<float>(state.velocity_NED_mps.x());
    local.vy = static_cast<float>(state.velocity_NED_mps.y());
    local.vz = static_cast<float>(state.velocity_NED_mps.z());
    send(local);
  }
  if (is_due(state.time, kDisplayPeriod, last_display_)) {
    VfrHud display;
    display.airspeed = static_cast<float>(state.airspeed_mps);
    display.groundspeed = static_cast<float>(state.velocity_NED_mps.head<2>().norm());
    display.heading = clamped<std::int16_t>(compass_deg(state.roll_pitch_yaw_rad.z()));
    display.alt = static_cast<float>(state.altitude_m);
    display.climb = static_cast<float>(-state.velocity_NED_mps.z());
    send(display);
  }
  if (is_due(state.time, kSecond, last_second_)) {
    heartbeat();
    SysStatus status;
    // Gyro, accelerometer, attitude, position: present and healthy unless it has crashed.
    constexpr std::uint32_t kSensors = 0x1 | 0x2 | 0x20 | kSensorPrearmCheck;
    status.onboard_control_sensors_present = status.onboard_control_sensors_enabled = kSensors;
    status.onboard_control_sensors_health = state.has_crashed ? 0 : kSensors;
    if (state.charge) status.battery_remaining = clamped<std::int8_t>(100.0 * *state.charge);
    send(status);
    MissionCurrent current;
    current.seq = static_cast<std::uint16_t>(current_);
    current.total = static_cast<std::uint16_t>(mission_.size());
    send(current);
  }
  if (is_first) {
    has_reported_ = true;
    send_message(HomePosition::kId);
  }
}

void MavlinkVehicle::report(const MavlinkFix& fix) {
  GpsRawInt raw;
  raw.time_usec = static_cast<std::uint64_t>(fix.time.ns / 1000);
  raw.fix_type = fix.type;
  const io::PlaceE7 place = io::place_e7({fix.latitude_rad, fix.longitude_rad, 0.0});
  raw.lat = place.latitude;
  raw.lon = place.longitude;
  raw.alt = raw.alt_ellipsoid = clamped<std::int32_t>(1000.0 * fix.altitude_m);
  const Eigen::Vector2d velocity = fix.velocity_NED_mps.head<2>();
  raw.vel = clamped<std::uint16_t>(100.0 * velocity.norm());
  raw.cog = clamped<std::uint16_t>(100.0 * compass_deg(std::atan2(velocity.y(), velocity.x())));
  raw.satellites_visible = clamped<std::uint8_t>(fix.satellites);
  raw.h_acc = clamped<std::uint32_t>(1000.0 * fix.std_NED_m.head<2>().norm());
  raw.v_acc = clamped<std::uint32_t>(1000.0 * fix.std_NED_m.z());
  send(raw);
}

void MavlinkVehicle::say(std::uint8_t severity, std::string_view sentence) {
  StatusText text;
  text.severity = severity;
  constexpr std::size_t kChunk = std::tuple_size_v<decltype(text.text)>;
  if (sentence.size() > kChunk) text.id = ++text_id_ == 0 ? text_id_ = 1 : text_id_;
  // A chunk that is not full ends the sentence.
  do {
    sentence = mavlink::set_text(text.text, sentence);
    send(text);
    ++text.chunk_seq;
  } while (!sentence.empty());
}

void MavlinkVehicle::set_mission(std::vector<MissionItemInt> items) {
  mission_ = std::move(items);
  for (std::size_t i = 0; i < mission_.size(); ++i) {
    mission_[i].seq = static_cast<std::uint16_t>(i);
  }
}

void MavlinkVehicle::set_current(int item) {
  current_ = item;
}

void MavlinkVehicle::reached(int item) {
  MissionItemReached message;
  message.seq = static_cast<std::uint16_t>(item);
  send(message);
}

bool MavlinkVehicle::is_for_us(std::uint8_t system, std::uint8_t component) const {
  return (system == 0 || system == options_.sender.system) &&
         (component == 0 || component == options_.sender.component);
}

void MavlinkVehicle::acknowledge(std::uint16_t command, std::uint8_t result, const Sender& to) {
  CommandAck ack;
  ack.command = command;
  ack.result = result;
  ack.target_system = to.system;
  ack.target_component = to.component;
  send(ack);
}

void MavlinkVehicle::answer(std::uint16_t command, const std::string& refusal, const Sender& to) {
  if (!refusal.empty()) say(kSeverityWarning, refusal);
  acknowledge(command, refusal.empty() ? kResultAccepted : kResultDenied, to);
}

void MavlinkVehicle::send_message(std::uint32_t id) {
  if (id == AutopilotVersion::kId) {
    constexpr std::uint64_t kMissionInt = 4, kCommandInt = 8, kMavlink2 = 8192;
    AutopilotVersion version;
    version.capabilities = kMissionInt | kCommandInt | kMavlink2;
    version.uid = options_.sender.system;
    send(version);
  } else if (id == HomePosition::kId) {
    HomePosition home;
    const io::PlaceE7 place =
        io::place_e7({options_.home_latitude_rad, options_.home_longitude_rad, 0.0});
    home.latitude = place.latitude;
    home.longitude = place.longitude;
    home.altitude = clamped<std::int32_t>(1000.0 * options_.home_altitude_m);
    home.q = {1.0F, 0.0F, 0.0F, 0.0F};
    send(home);
  }
}

void MavlinkVehicle::take_command(std::uint16_t command, double param1, const Sender& from) {
  switch (command) {
    case kCommandMissionStart:
      return answer(command, commands_.start_mission(), from);
    case kCommandPauseContinue:
      return answer(command, commands_.pause(param1 == 0.0), from);
    case kCommandRequestMessage: {
      const auto id = clamped<std::uint32_t>(param1);
      const bool is_known = id == AutopilotVersion::kId || id == HomePosition::kId;
      acknowledge(command, is_known ? kResultAccepted : kResultUnsupported, from);
      return send_message(id);
    }
    case kCommandRequestCapabilities:
      acknowledge(command, kResultAccepted, from);
      return send_message(AutopilotVersion::kId);
    case kCommandGetHome:
      acknowledge(command, kResultAccepted, from);
      return send_message(HomePosition::kId);
    case kCommandArm:
      return answer(
          command, param1 == 1.0 ? "" : "it cannot be disarmed: the run's scenario moves it", from);
    default:
      return acknowledge(command, kResultUnsupported, from);
  }
}

void MavlinkVehicle::take(const mavlink::Frame& frame) {
  if (const auto command = read<CommandLong>(frame)) {
    if (!is_for_us(command->target_system, command->target_component)) return;
    take_command(command->command, command->param1, frame.sender);
  } else if (const auto placed = read<CommandInt>(frame)) {
    if (!is_for_us(placed->target_system, placed->target_component)) return;
    take_command(placed->command, placed->param1, frame.sender);
  } else if (const auto count = read<MissionCount>(frame)) {
    if (is_for_us(count->target_system, count->target_component)) take_count(*count, frame.sender);
  } else if (const auto item = read<MissionItemInt>(frame)) {
    if (is_for_us(item->target_system, item->target_component)) take_item(*item, frame.sender);
  } else if (const auto list = read<MissionRequestList>(frame)) {
    if (!is_for_us(list->target_system, list->target_component)) return;
    MissionCount answer;
    answer.target_system = frame.sender.system;
    answer.target_component = frame.sender.component;
    answer.mission_type = list->mission_type;  // fences and rally points: none
    answer.count = list->mission_type == 0 ? static_cast<std::uint16_t>(mission_.size()) : 0;
    send(answer);
  } else if (const auto wanted = read<MissionRequestInt>(frame)) {
    if (!is_for_us(wanted->target_system, wanted->target_component)) return;
    send_item(wanted->seq, wanted->mission_type, frame.sender);
  } else if (const auto wanted_float = read<MissionRequest>(frame)) {
    if (!is_for_us(wanted_float->target_system, wanted_float->target_component)) return;
    send_item(wanted_float->seq, wanted_float->mission_type, frame.sender);
  } else if (const auto clear = read<MissionClearAll>(frame)) {
    if (!is_for_us(clear->target_system, clear->target_component)) return;
    MissionCount none;
    none.mission_type = clear->mission_type;
    take_count(none, frame.sender);
  } else if (const auto parameters = read<ParamRequestList>(frame)) {
    if (is_for_us(parameters->target_system, parameters->target_component)) {
      send_parameter(frame.sender);
    }
  } else if (const auto parameter = read<ParamRequestRead>(frame)) {
    if (is_for_us(parameter->target_system, parameter->target_component)) {
      send_parameter(frame.sender);
    }
  } else if (const auto set = read<ParamSet>(frame)) {
    if (!is_for_us(set->target_system, set->target_component)) return;
    const std::string refusal =
        mavlink::text_of(set->param_id) == kSpeedParameter
            ? commands_.set_speed(set->param_value)
            : fmt::format("there is only the parameter {}", kSpeedParameter);
    if (!refusal.empty()) say(kSeverityWarning, refusal);
    send_parameter(frame.sender);
  }
}

void MavlinkVehicle::send_parameter(const Sender& /*to*/) {
  ParamValue value;
  mavlink::set_text(value.param_id, kSpeedParameter);
  value.param_value = static_cast<float>(commands_.speed());
  value.param_type = kParameterReal32;
  value.param_count = 1;
  send(value);
}

void MavlinkVehicle::take_count(const MissionCount& count, const Sender& from) {
  upload_ = Upload{from, count.mission_type, count.count, {}};
  if (count.mission_type != 0) {
    // Fences and rally points: only their absence can be accepted.
    return end_upload(count.count == 0 ? kMissionAccepted : kMissionUnsupported);
  }
  if (count.count > kMaxItems) return end_upload(kMissionNoSpace);
  ask_for_item();
}

void MavlinkVehicle::ask_for_item() {
  if (upload_->items.size() < upload_->count) {
    MissionRequestInt request;
    request.target_system = upload_->from.system;
    request.target_component = upload_->from.component;
    request.seq = static_cast<std::uint16_t>(upload_->items.size());
    return send(request);
  }
  const std::string refusal = commands_.take_mission(upload_->items);
  if (!refusal.empty()) {
    say(kSeverityWarning, refusal);
    return end_upload(kMissionDenied);
  }
  set_mission(std::move(upload_->items));
  current_ = 0;
  end_upload(kMissionAccepted);
}

void MavlinkVehicle::remind() {
  constexpr int kMostReminders = 5;
  if (!upload_) return;
  if (++upload_->reminders > kMostReminders) return upload_.reset();
  ask_for_item();
}

void MavlinkVehicle::end_upload(std::uint8_t result) {
  MissionAck ack;
  ack.target_system = upload_->from.system;
  ack.target_component = upload_->from.component;
  ack.type = result;
  ack.mission_type = upload_->mission_type;
  upload_.reset();
  send(ack);
}

void MavlinkVehicle::take_item(const MissionItemInt& item, const Sender& from) {
  if (!upload_ || !(upload_->from == from)) return;
  // A repeated item is of a request that was answered twice; a later one was lost before.
  if (item.seq == upload_->items.size()) upload_->items.push_back(item);
  upload_->reminders = 0;
  ask_for_item();
}

void MavlinkVehicle::send_item(int number, std::uint8_t mission_type, const Sender& to) {
  if (mission_type != 0 || number >= static_cast<int>(mission_.size())) {
    MissionAck ack;
    ack.target_system = to.system;
    ack.target_component = to.component;
    ack.type = kMissionInvalidSequence;
    ack.mission_type = mission_type;
    return send(ack);
  }
  MissionItemInt item = mission_[static_cast<std::size_t>(number)];
  item.target_system = to.system;
  item.target_component = to.component;
  send(item);
}

}  // namespace vinerow::live
