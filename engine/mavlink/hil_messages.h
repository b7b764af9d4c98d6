#pragma once
/// Messages of hardware or software in the loop: sensors to an autopilot, actuators from it.
/// Source: message set "common" of MAVLink.

#include <array>
#include <cstdint>

#include "engine/mavlink/message.h"

namespace vinerow::mavlink {

/// Outputs of an autopilot.
struct HilActuatorControls {
  static constexpr std::uint32_t kId = 93;
  static constexpr const char* kName = "HIL_ACTUATOR_CONTROLS";
  std::uint64_t time_usec = 0;       ///< us
  std::array<float, 16> controls{};  ///< -1 to 1, motors 0 to 1
  std::uint8_t mode = 0;             ///< bit 128: armed
  std::uint64_t flags = 0;           ///< bit 1: in lock-step

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_usec"}, self.time_usec);
    f(Field{"controls"}, self.controls);
    f(Field{"mode"}, self.mode);
    f(Field{"flags"}, self.flags);
  }
};

/// Sensors in the body frame (forward, right, down).
struct HilSensor {
  static constexpr std::uint32_t kId = 107;
  static constexpr const char* kName = "HIL_SENSOR";
  std::uint64_t time_usec = 0;  ///< us
  float xacc = 0;               ///< m/s2
  float yacc = 0;               ///< m/s2
  float zacc = 0;               ///< m/s2
  float xgyro = 0;              ///< rad/s
  float ygyro = 0;              ///< rad/s
  float zgyro = 0;              ///< rad/s
  float xmag = 0;               ///< gauss
  float ymag = 0;               ///< gauss
  float zmag = 0;               ///< gauss
  float abs_pressure = 0;       ///< hPa
  float diff_pressure = 0;      ///< hPa
  float pressure_alt = 0;       ///< m
  float temperature = 0;        ///< degC
  std::uint32_t fields_updated = 0;
  std::uint8_t id = 0;

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_usec"}, self.time_usec);
    f(Field{"xacc"}, self.xacc);
    f(Field{"yacc"}, self.yacc);
    f(Field{"zacc"}, self.zacc);
    f(Field{"xgyro"}, self.xgyro);
    f(Field{"ygyro"}, self.ygyro);
    f(Field{"zgyro"}, self.zgyro);
    f(Field{"xmag"}, self.xmag);
    f(Field{"ymag"}, self.ymag);
    f(Field{"zmag"}, self.zmag);
    f(Field{"abs_pressure"}, self.abs_pressure);
    f(Field{"diff_pressure"}, self.diff_pressure);
    f(Field{"pressure_alt"}, self.pressure_alt);
    f(Field{"temperature"}, self.temperature);
    f(Field{"fields_updated"}, self.fields_updated);
    f(Field{"id", true}, self.id);
  }
};

/// A receiver.
struct HilGps {
  static constexpr std::uint32_t kId = 113;
  static constexpr const char* kName = "HIL_GPS";
  std::uint64_t time_usec = 0;  ///< us
  std::uint8_t fix_type = 0;
  std::int32_t lat = 0;   ///< 1e-7 deg
  std::int32_t lon = 0;   ///< 1e-7 deg
  std::int32_t alt = 0;   ///< mm above sea level
  std::uint16_t eph = 0;  ///< HDOP * 100
  std::uint16_t epv = 0;  ///< VDOP * 100
  std::uint16_t vel = 0;  ///< cm/s
  std::int16_t vn = 0;    ///< cm/s
  std::int16_t ve = 0;    ///< cm/s
  std::int16_t vd = 0;    ///< cm/s
  std::uint16_t cog = 0;  ///< 0.01 deg
  std::uint8_t satellites_visible = 0;
  std::uint8_t id = 0;
  std::uint16_t yaw = 0;  ///< 0.01 deg

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
    f(Field{"vn"}, self.vn);
    f(Field{"ve"}, self.ve);
    f(Field{"vd"}, self.vd);
    f(Field{"cog"}, self.cog);
    f(Field{"satellites_visible"}, self.satellites_visible);
    f(Field{"id", true}, self.id);
    f(Field{"yaw", true}, self.yaw);
  }
};

/// Positions of a pilot's sticks and switches.
struct RcChannels {
  static constexpr std::uint32_t kId = 65;
  static constexpr const char* kName = "RC_CHANNELS";
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::uint8_t chancount = 0;
  std::uint16_t chan1_raw = 65535;   ///< us; 65535: not used
  std::uint16_t chan2_raw = 65535;   ///< us
  std::uint16_t chan3_raw = 65535;   ///< us
  std::uint16_t chan4_raw = 65535;   ///< us
  std::uint16_t chan5_raw = 65535;   ///< us
  std::uint16_t chan6_raw = 65535;   ///< us
  std::uint16_t chan7_raw = 65535;   ///< us
  std::uint16_t chan8_raw = 65535;   ///< us
  std::uint16_t chan9_raw = 65535;   ///< us
  std::uint16_t chan10_raw = 65535;  ///< us
  std::uint16_t chan11_raw = 65535;  ///< us
  std::uint16_t chan12_raw = 65535;  ///< us
  std::uint16_t chan13_raw = 65535;  ///< us
  std::uint16_t chan14_raw = 65535;  ///< us
  std::uint16_t chan15_raw = 65535;  ///< us
  std::uint16_t chan16_raw = 65535;  ///< us
  std::uint16_t chan17_raw = 65535;  ///< us
  std::uint16_t chan18_raw = 65535;  ///< us
  std::uint8_t rssi = 255;           ///< 255: unknown

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_boot_ms"}, self.time_boot_ms);
    f(Field{"chancount"}, self.chancount);
    f(Field{"chan1_raw"}, self.chan1_raw);
    f(Field{"chan2_raw"}, self.chan2_raw);
    f(Field{"chan3_raw"}, self.chan3_raw);
    f(Field{"chan4_raw"}, self.chan4_raw);
    f(Field{"chan5_raw"}, self.chan5_raw);
    f(Field{"chan6_raw"}, self.chan6_raw);
    f(Field{"chan7_raw"}, self.chan7_raw);
    f(Field{"chan8_raw"}, self.chan8_raw);
    f(Field{"chan9_raw"}, self.chan9_raw);
    f(Field{"chan10_raw"}, self.chan10_raw);
    f(Field{"chan11_raw"}, self.chan11_raw);
    f(Field{"chan12_raw"}, self.chan12_raw);
    f(Field{"chan13_raw"}, self.chan13_raw);
    f(Field{"chan14_raw"}, self.chan14_raw);
    f(Field{"chan15_raw"}, self.chan15_raw);
    f(Field{"chan16_raw"}, self.chan16_raw);
    f(Field{"chan17_raw"}, self.chan17_raw);
    f(Field{"chan18_raw"}, self.chan18_raw);
    f(Field{"rssi"}, self.rssi);
  }
};

/// True state, for the log of the autopilot.
struct HilStateQuaternion {
  static constexpr std::uint32_t kId = 115;
  static constexpr const char* kName = "HIL_STATE_QUATERNION";
  std::uint64_t time_usec = 0;                 ///< us
  std::array<float, 4> attitude_quaternion{};  ///< w, x, y, z
  float rollspeed = 0;                         ///< rad/s
  float pitchspeed = 0;                        ///< rad/s
  float yawspeed = 0;                          ///< rad/s
  std::int32_t lat = 0;                        ///< 1e-7 deg
  std::int32_t lon = 0;                        ///< 1e-7 deg
  std::int32_t alt = 0;                        ///< mm
  std::int16_t vx = 0;                         ///< cm/s
  std::int16_t vy = 0;                         ///< cm/s
  std::int16_t vz = 0;                         ///< cm/s
  std::uint16_t ind_airspeed = 0;              ///< cm/s
  std::uint16_t true_airspeed = 0;             ///< cm/s
  std::int16_t xacc = 0;                       ///< mG
  std::int16_t yacc = 0;                       ///< mG
  std::int16_t zacc = 0;                       ///< mG

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_usec"}, self.time_usec);
    f(Field{"attitude_quaternion"}, self.attitude_quaternion);
    f(Field{"rollspeed"}, self.rollspeed);
    f(Field{"pitchspeed"}, self.pitchspeed);
    f(Field{"yawspeed"}, self.yawspeed);
    f(Field{"lat"}, self.lat);
    f(Field{"lon"}, self.lon);
    f(Field{"alt"}, self.alt);
    f(Field{"vx"}, self.vx);
    f(Field{"vy"}, self.vy);
    f(Field{"vz"}, self.vz);
    f(Field{"ind_airspeed"}, self.ind_airspeed);
    f(Field{"true_airspeed"}, self.true_airspeed);
    f(Field{"xacc"}, self.xacc);
    f(Field{"yacc"}, self.yacc);
    f(Field{"zacc"}, self.zacc);
  }
};

/// A receiver whose readings an autopilot takes as its own.
struct GpsInput {
  static constexpr std::uint32_t kId = 232;
  static constexpr const char* kName = "GPS_INPUT";
  std::uint64_t time_usec = 0;  ///< us
  std::uint8_t gps_id = 0;
  std::uint16_t ignore_flags = 0;
  std::uint32_t time_week_ms = 0;  ///< ms
  std::uint16_t time_week = 0;
  std::uint8_t fix_type = 0;
  std::int32_t lat = 0;  ///< 1e-7 deg
  std::int32_t lon = 0;  ///< 1e-7 deg
  float alt = 0;         ///< m above sea level
  float hdop = 0;
  float vdop = 0;
  float vn = 0;              ///< m/s
  float ve = 0;              ///< m/s
  float vd = 0;              ///< m/s
  float speed_accuracy = 0;  ///< m/s
  float horiz_accuracy = 0;  ///< m
  float vert_accuracy = 0;   ///< m
  std::uint8_t satellites_visible = 0;
  std::uint16_t yaw = 0;  ///< 0.01 deg

  template <class Self, class F>
  static constexpr void fields(Self& self, F&& f) {
    f(Field{"time_usec"}, self.time_usec);
    f(Field{"gps_id"}, self.gps_id);
    f(Field{"ignore_flags"}, self.ignore_flags);
    f(Field{"time_week_ms"}, self.time_week_ms);
    f(Field{"time_week"}, self.time_week);
    f(Field{"fix_type"}, self.fix_type);
    f(Field{"lat"}, self.lat);
    f(Field{"lon"}, self.lon);
    f(Field{"alt"}, self.alt);
    f(Field{"hdop"}, self.hdop);
    f(Field{"vdop"}, self.vdop);
    f(Field{"vn"}, self.vn);
    f(Field{"ve"}, self.ve);
    f(Field{"vd"}, self.vd);
    f(Field{"speed_accuracy"}, self.speed_accuracy);
    f(Field{"horiz_accuracy"}, self.horiz_accuracy);
    f(Field{"vert_accuracy"}, self.vert_accuracy);
    f(Field{"satellites_visible"}, self.satellites_visible);
    f(Field{"yaw", true}, self.yaw);
  }
};

}  // namespace vinerow::mavlink
