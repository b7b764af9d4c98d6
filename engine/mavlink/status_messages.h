#pragma once
/// Messages about the state of a vehicle: heartbeat, attitude, position, battery, text.
/// Source: message set "common" of MAVLink.

#include <array>
#include <cstdint>

#include "engine/mavlink/message.h"

namespace vinerow::mavlink {

/// Sent once per second: who is there, in which mode.
struct Heartbeat {
  static constexpr std::uint32_t kId = 0;
  static constexpr const char* kName = "HEARTBEAT";
  std::uint8_t type = 0;
  std::uint8_t autopilot = 0;
  std::uint8_t base_mode = 0;
  std::uint32_t custom_mode = 0;
  std::uint8_t system_status = 0;
  std::uint8_t mavlink_version = 3;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"type"}, self.type);
    f(Field{"autopilot"}, self.autopilot);
    f(Field{"base_mode"}, self.base_mode);
    f(Field{"custom_mode"}, self.custom_mode);
    f(Field{"system_status"}, self.system_status);
    f(Field{"mavlink_version"}, self.mavlink_version);
  }
};

/// Sensors, battery, load. -1 or 65535: unknown.
struct SysStatus {
  static constexpr std::uint32_t kId = 1;
  static constexpr const char* kName = "SYS_STATUS";
  std::uint32_t onboard_control_sensors_present = 0;
  std::uint32_t onboard_control_sensors_enabled = 0;
  std::uint32_t onboard_control_sensors_health = 0;
  std::uint16_t load = 0;                 ///< 0.1 %
  std::uint16_t voltage_battery = 65535;  ///< mV
  std::int16_t current_battery = -1;      ///< cA
  std::int8_t battery_remaining = -1;     ///< %
  std::uint16_t drop_rate_comm = 0;       ///< 0.01 %
  std::uint16_t errors_comm = 0;
  std::uint16_t errors_count1 = 0;
  std::uint16_t errors_count2 = 0;
  std::uint16_t errors_count3 = 0;
  std::uint16_t errors_count4 = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"onboard_control_sensors_present"}, self.onboard_control_sensors_present);
    f(Field{"onboard_control_sensors_enabled"}, self.onboard_control_sensors_enabled);
    f(Field{"onboard_control_sensors_health"}, self.onboard_control_sensors_health);
    f(Field{"load"}, self.load);
    f(Field{"voltage_battery"}, self.voltage_battery);
    f(Field{"current_battery"}, self.current_battery);
    f(Field{"battery_remaining"}, self.battery_remaining);
    f(Field{"drop_rate_comm"}, self.drop_rate_comm);
    f(Field{"errors_comm"}, self.errors_comm);
    f(Field{"errors_count1"}, self.errors_count1);
    f(Field{"errors_count2"}, self.errors_count2);
    f(Field{"errors_count3"}, self.errors_count3);
    f(Field{"errors_count4"}, self.errors_count4);
  }
};

/// Clock of the sender.
struct SystemTime {
  static constexpr std::uint32_t kId = 2;
  static constexpr const char* kName = "SYSTEM_TIME";
  std::uint64_t time_unix_usec = 0;  ///< us
  std::uint32_t time_boot_ms = 0;    ///< ms

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_unix_usec"}, self.time_unix_usec);
    f(Field{"time_boot_ms"}, self.time_boot_ms);
  }
};

/// A receiver's own position.
struct GpsRawInt {
  static constexpr std::uint32_t kId = 24;
  static constexpr const char* kName = "GPS_RAW_INT";
  std::uint64_t time_usec = 0;  ///< us
  std::uint8_t fix_type = 0;
  std::int32_t lat = 0;       ///< 1e-7 deg
  std::int32_t lon = 0;       ///< 1e-7 deg
  std::int32_t alt = 0;       ///< mm above sea level
  std::uint16_t eph = 65535;  ///< HDOP * 100
  std::uint16_t epv = 65535;  ///< VDOP * 100
  std::uint16_t vel = 65535;  ///< cm/s
  std::uint16_t cog = 65535;  ///< 0.01 deg
  std::uint8_t satellites_visible = 255;
  std::int32_t alt_ellipsoid = 0;  ///< mm
  std::uint32_t h_acc = 0;         ///< mm
  std::uint32_t v_acc = 0;         ///< mm
  std::uint32_t vel_acc = 0;       ///< mm/s
  std::uint32_t hdg_acc = 0;       ///< 1e-5 deg
  std::uint16_t yaw = 0;           ///< 0.01 deg; 0: none

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_usec"}, self.time_usec);
    f(Field{"fix_type"}, self.fix_type);
    f(Field{"lat"}, self.lat);
    f(Field{"lon"}, self.lon);
    f(Field{"alt"}, self.alt);
    f(Field{"eph"}, self.eph);
    f(Field{"epv"}, self.epv);
    f(Field{"vel"}, self.vel);
    f(Field{"cog"}, self.cog);
    f(Field{"satellites_visible"}, self.satellites_visible);
    f(Field{"alt_ellipsoid", true}, self.alt_ellipsoid);
    f(Field{"h_acc", true}, self.h_acc);
    f(Field{"v_acc", true}, self.v_acc);
    f(Field{"vel_acc", true}, self.vel_acc);
    f(Field{"hdg_acc", true}, self.hdg_acc);
    f(Field{"yaw", true}, self.yaw);
  }
};

/// Attitude of the body (forward, right, down) to north, east, down.
struct Attitude {
  static constexpr std::uint32_t kId = 30;
  static constexpr const char* kName = "ATTITUDE";
  std::uint32_t time_boot_ms = 0;  ///< ms
  float roll = 0;                  ///< rad
  float pitch = 0;                 ///< rad
  float yaw = 0;                   ///< rad
  float rollspeed = 0;             ///< rad/s
  float pitchspeed = 0;            ///< rad/s
  float yawspeed = 0;              ///< rad/s

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_boot_ms"}, self.time_boot_ms);
    f(Field{"roll"}, self.roll);
    f(Field{"pitch"}, self.pitch);
    f(Field{"yaw"}, self.yaw);
    f(Field{"rollspeed"}, self.rollspeed);
    f(Field{"pitchspeed"}, self.pitchspeed);
    f(Field{"yawspeed"}, self.yawspeed);
  }
};

/// Estimated position and velocity: north, east, down of the origin.
struct LocalPositionNed {
  static constexpr std::uint32_t kId = 32;
  static constexpr const char* kName = "LOCAL_POSITION_NED";
  std::uint32_t time_boot_ms = 0;  ///< ms
  float x = 0;                     ///< m
  float y = 0;                     ///< m
  float z = 0;                     ///< m
  float vx = 0;                    ///< m/s
  float vy = 0;                    ///< m/s
  float vz = 0;                    ///< m/s

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_boot_ms"}, self.time_boot_ms);
    f(Field{"x"}, self.x);
    f(Field{"y"}, self.y);
    f(Field{"z"}, self.z);
    f(Field{"vx"}, self.vx);
    f(Field{"vy"}, self.vy);
    f(Field{"vz"}, self.vz);
  }
};

/// Estimated position on Earth.
struct GlobalPositionInt {
  static constexpr std::uint32_t kId = 33;
  static constexpr const char* kName = "GLOBAL_POSITION_INT";
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::int32_t lat = 0;            ///< 1e-7 deg
  std::int32_t lon = 0;            ///< 1e-7 deg
  std::int32_t alt = 0;            ///< mm above sea level
  std::int32_t relative_alt = 0;   ///< mm above home
  std::int16_t vx = 0;             ///< cm/s north
  std::int16_t vy = 0;             ///< cm/s east
  std::int16_t vz = 0;             ///< cm/s down
  std::uint16_t hdg = 65535;       ///< 0.01 deg

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_boot_ms"}, self.time_boot_ms);
    f(Field{"lat"}, self.lat);
    f(Field{"lon"}, self.lon);
    f(Field{"alt"}, self.alt);
    f(Field{"relative_alt"}, self.relative_alt);
    f(Field{"vx"}, self.vx);
    f(Field{"vy"}, self.vy);
    f(Field{"vz"}, self.vz);
    f(Field{"hdg"}, self.hdg);
  }
};

/// What a pilot's display shows.
/// Where the local coordinates of a vehicle's estimate begin.
struct GpsGlobalOrigin {
  static constexpr std::uint32_t kId = 49;
  static constexpr const char* kName = "GPS_GLOBAL_ORIGIN";
  std::int32_t latitude = 0;    ///< 1e-7 deg
  std::int32_t longitude = 0;   ///< 1e-7 deg
  std::int32_t altitude = 0;    ///< mm above sea level
  std::uint64_t time_usec = 0;  ///< us

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"latitude"}, self.latitude);
    f(Field{"longitude"}, self.longitude);
    f(Field{"altitude"}, self.altitude);
    f(Field{"time_usec", true}, self.time_usec);
  }
};

/// Where an autopilot's navigation is on its way to the next item.
struct NavControllerOutput {
  static constexpr std::uint32_t kId = 62;
  static constexpr const char* kName = "NAV_CONTROLLER_OUTPUT";
  float nav_roll = 0;               ///< deg
  float nav_pitch = 0;              ///< deg
  std::int16_t nav_bearing = 0;     ///< deg
  std::int16_t target_bearing = 0;  ///< deg
  std::uint16_t wp_dist = 0;        ///< m
  float alt_error = 0;              ///< m
  float aspd_error = 0;             ///< m/s
  float xtrack_error = 0;           ///< m

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"nav_roll"}, self.nav_roll);
    f(Field{"nav_pitch"}, self.nav_pitch);
    f(Field{"nav_bearing"}, self.nav_bearing);
    f(Field{"target_bearing"}, self.target_bearing);
    f(Field{"wp_dist"}, self.wp_dist);
    f(Field{"alt_error"}, self.alt_error);
    f(Field{"aspd_error"}, self.aspd_error);
    f(Field{"xtrack_error"}, self.xtrack_error);
  }
};

struct VfrHud {
  static constexpr std::uint32_t kId = 74;
  static constexpr const char* kName = "VFR_HUD";
  float airspeed = 0;          ///< m/s
  float groundspeed = 0;       ///< m/s
  std::int16_t heading = 0;    ///< deg
  std::uint16_t throttle = 0;  ///< %
  float alt = 0;               ///< m above sea level
  float climb = 0;             ///< m/s

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"airspeed"}, self.airspeed);
    f(Field{"groundspeed"}, self.groundspeed);
    f(Field{"heading"}, self.heading);
    f(Field{"throttle"}, self.throttle);
    f(Field{"alt"}, self.alt);
    f(Field{"climb"}, self.climb);
  }
};

/// One range.
struct DistanceSensor {
  static constexpr std::uint32_t kId = 132;
  static constexpr const char* kName = "DISTANCE_SENSOR";
  std::uint32_t time_boot_ms = 0;      ///< ms
  std::uint16_t min_distance = 0;      ///< cm
  std::uint16_t max_distance = 0;      ///< cm
  std::uint16_t current_distance = 0;  ///< cm
  std::uint8_t type = 0;
  std::uint8_t id = 0;
  std::uint8_t orientation = 0;
  std::uint8_t covariance = 255;  ///< cm2; 255: unknown

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_boot_ms"}, self.time_boot_ms);
    f(Field{"min_distance"}, self.min_distance);
    f(Field{"max_distance"}, self.max_distance);
    f(Field{"current_distance"}, self.current_distance);
    f(Field{"type"}, self.type);
    f(Field{"id"}, self.id);
    f(Field{"orientation"}, self.orientation);
    f(Field{"covariance"}, self.covariance);
  }
};

/// A battery.
struct BatteryStatus {
  static constexpr std::uint32_t kId = 147;
  static constexpr const char* kName = "BATTERY_STATUS";
  std::uint8_t id = 0;
  std::uint8_t battery_function = 0;
  std::uint8_t type = 0;
  std::int16_t temperature = 32767;          ///< cdegC; 32767: unknown
  std::array<std::uint16_t, 10> voltages{};  ///< mV; 65535: no cell
  std::int16_t current_battery = -1;         ///< cA
  std::int32_t current_consumed = -1;        ///< mAh
  std::int32_t energy_consumed = -1;         ///< hJ
  std::int8_t battery_remaining = -1;        ///< %

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"id"}, self.id);
    f(Field{"battery_function"}, self.battery_function);
    f(Field{"type"}, self.type);
    f(Field{"temperature"}, self.temperature);
    f(Field{"voltages"}, self.voltages);
    f(Field{"current_battery"}, self.current_battery);
    f(Field{"current_consumed"}, self.current_consumed);
    f(Field{"energy_consumed"}, self.energy_consumed);
    f(Field{"battery_remaining"}, self.battery_remaining);
  }
};

/// Abilities and version of an autopilot.
struct AutopilotVersion {
  static constexpr std::uint32_t kId = 148;
  static constexpr const char* kName = "AUTOPILOT_VERSION";
  std::uint64_t capabilities = 0;
  std::uint32_t flight_sw_version = 0;
  std::uint32_t middleware_sw_version = 0;
  std::uint32_t os_sw_version = 0;
  std::uint32_t board_version = 0;
  std::array<std::uint8_t, 8> flight_custom_version{};
  std::array<std::uint8_t, 8> middleware_custom_version{};
  std::array<std::uint8_t, 8> os_custom_version{};
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint64_t uid = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"capabilities"}, self.capabilities);
    f(Field{"flight_sw_version"}, self.flight_sw_version);
    f(Field{"middleware_sw_version"}, self.middleware_sw_version);
    f(Field{"os_sw_version"}, self.os_sw_version);
    f(Field{"board_version"}, self.board_version);
    f(Field{"flight_custom_version"}, self.flight_custom_version);
    f(Field{"middleware_custom_version"}, self.middleware_custom_version);
    f(Field{"os_custom_version"}, self.os_custom_version);
    f(Field{"vendor_id"}, self.vendor_id);
    f(Field{"product_id"}, self.product_id);
    f(Field{"uid"}, self.uid);
  }
};

/// Where the vehicle returns to.
struct HomePosition {
  static constexpr std::uint32_t kId = 242;
  static constexpr const char* kName = "HOME_POSITION";
  std::int32_t latitude = 0;   ///< 1e-7 deg
  std::int32_t longitude = 0;  ///< 1e-7 deg
  std::int32_t altitude = 0;   ///< mm above sea level
  float x = 0;                 ///< m
  float y = 0;                 ///< m
  float z = 0;                 ///< m
  std::array<float, 4> q{};    ///< w, x, y, z of the surface
  float approach_x = 0;        ///< m
  float approach_y = 0;        ///< m
  float approach_z = 0;        ///< m

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"latitude"}, self.latitude);
    f(Field{"longitude"}, self.longitude);
    f(Field{"altitude"}, self.altitude);
    f(Field{"x"}, self.x);
    f(Field{"y"}, self.y);
    f(Field{"z"}, self.z);
    f(Field{"q"}, self.q);
    f(Field{"approach_x"}, self.approach_x);
    f(Field{"approach_y"}, self.approach_y);
    f(Field{"approach_z"}, self.approach_z);
  }
};

/// A sentence for people; longer ones in chunks of one id.
/// State of ArduPilot's estimator (message set "ardupilotmega").
struct EkfStatusReport {
  static constexpr std::uint32_t kId = 193;
  static constexpr const char* kName = "EKF_STATUS_REPORT";
  std::uint16_t flags = 0;
  float velocity_variance = 0;
  float pos_horiz_variance = 0;
  float pos_vert_variance = 0;
  float compass_variance = 0;
  float terrain_alt_variance = 0;
  float airspeed_variance = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"flags"}, self.flags);
    f(Field{"velocity_variance"}, self.velocity_variance);
    f(Field{"pos_horiz_variance"}, self.pos_horiz_variance);
    f(Field{"pos_vert_variance"}, self.pos_vert_variance);
    f(Field{"compass_variance"}, self.compass_variance);
    f(Field{"terrain_alt_variance"}, self.terrain_alt_variance);
    f(Field{"airspeed_variance", true}, self.airspeed_variance);
  }
};

struct StatusText {
  static constexpr std::uint32_t kId = 253;
  static constexpr const char* kName = "STATUSTEXT";
  std::uint8_t severity = 0;  ///< as in syslog: 3 error, 4 warning, 6 information
  std::array<char, 50> text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"severity"}, self.severity);
    f(Field{"text"}, self.text);
    f(Field{"id", true}, self.id);
    f(Field{"chunk_seq", true}, self.chunk_seq);
  }
};

}  // namespace vinerow::mavlink
