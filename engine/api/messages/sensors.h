#pragma once
/// Sensor messages: readings as a vehicle gets them. Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/api/field.h"
#include "engine/math/pose.h"

namespace vinerow {

/// Inertial measurement. ROS 2: sensor_msgs/msg/Imu.
struct ImuSample {
  static constexpr const char* kType = "ImuSample";
  static constexpr MessageFrame kFrame = MessageFrame::kOwn;
  Eigen::Vector3d w_WS_S = Eigen::Vector3d::Zero();  ///< rate gyro, rad/s
  Eigen::Vector3d f_WS_S =
      Eigen::Vector3d::Zero();  ///< specific force (at rest on level ground: +g along z), m/s2

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"angular_velocity", "rad/s", "in the sensor"}, self.w_WS_S);
    f({"specific_force", "m/s^2", "in the sensor"}, self.f_WS_S);
  }
};

/// Satellite position fix, both in WGS84 and in W. ROS 2: sensor_msgs/msg/NavSatFix.
struct GnssFix {
  static constexpr const char* kType = "GnssFix";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  enum class Mode : std::uint8_t {
    kNone = 0,
    kStandalone = 1,  ///< code measurements alone
    kSbas = 2,        ///< with corrections from satellites
    kFloat = 3,       ///< carrier phase, ambiguities not resolved
    kFixed = 4        ///< carrier phase, ambiguities resolved
  };
  bool valid = false;
  Mode mode = Mode::kNone;      ///< also kNone if the receiver's model has no modes
  std::int32_t satellites = 0;  ///< used; 0 if the model does not count them
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;                          ///< above the ellipsoid
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();    ///< antenna, m
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();    ///< m/s
  Eigen::Vector3d std_m = Eigen::Vector3d::Zero();  ///< 1 sigma east, north, up
  double velocity_std_mps = 0.0;                    ///< 1 sigma of each component; 0: unknown

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"valid"}, self.valid);
    f({"mode"}, self.mode);
    f({"satellites", "", "used; 0: unknown"}, self.satellites);
    f({"velocity_std", "m/s", "of each component; 0: unknown"}, self.velocity_std_mps);
    f({"latitude", "rad"}, self.latitude_rad);
    f({"longitude", "rad"}, self.longitude_rad);
    f({"altitude", "m", "above the ellipsoid"}, self.altitude_m);
    f({"position", "m", "of the antenna in header.frame_id: east, north, up"}, self.p_W);
    f({"velocity", "m/s"}, self.v_W);
    f({"position_std", "m", "1 sigma east, north, up"}, self.std_m);
  }
};

inline std::span<const EnumName> enum_names(GnssFix::Mode) {
  using enum GnssFix::Mode;
  static constexpr EnumName kNames[] = {
      enum_name(kNone, "NONE"), enum_name(kStandalone, "STANDALONE"), enum_name(kSbas, "SBAS"),
      enum_name(kFloat, "FLOAT"), enum_name(kFixed, "FIXED")};
  return kNames;
}

/// One range reading along x of S. ROS 2: sensor_msgs/msg/Range.
struct RangeSample {
  static constexpr const char* kType = "RangeSample";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  double range_m = 0.0;  ///< +infinity if nothing was seen
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double half_angle_rad = 0.0;
  Pose X_WS;  ///< true pose of the sensor at the time of the reading, for pictures and checks

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"range", "m", "+inf: nothing seen"}, self.range_m);
    f({"min_range", "m"}, self.min_range_m);
    f({"max_range", "m"}, self.max_range_m);
    f({"half_angle", "rad", "half of the cone"}, self.half_angle_rad);
    f({"sensor", "", "it looks along its x", true}, self.X_WS);
  }
};

/// Static pressure of the air. ROS 2: sensor_msgs/msg/FluidPressure.
struct PressureSample {
  static constexpr const char* kType = "PressureSample";
  static constexpr MessageFrame kFrame = MessageFrame::kOwn;
  double pressure_Pa = 0.0;
  double std_Pa = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"pressure", "Pa"}, self.pressure_Pa);
    f({"std", "Pa"}, self.std_Pa);
  }
};

/// Flux density of the magnetic field. ROS 2: sensor_msgs/msg/MagneticField.
struct MagneticSample {
  static constexpr const char* kType = "MagneticSample";
  static constexpr MessageFrame kFrame = MessageFrame::kOwn;
  Eigen::Vector3d field_S_T = Eigen::Vector3d::Zero();  ///< tesla, in S
  double std_T = 0.0;                                   ///< 1 sigma of each component

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"field", "T", "in the sensor"}, self.field_S_T);
    f({"std", "T", "of each component"}, self.std_T);
  }
};

/// One turn of a scanning rangefinder in the plane z = 0 of S. ROS 2: sensor_msgs/msg/LaserScan.
struct LaserScan {
  static constexpr const char* kType = "LaserScan";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  double first_angle_rad = 0.0;  ///< of ranges_m[0], from x of S towards y
  double angle_step_rad = 0.0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  std::vector<double> ranges_m;  ///< +infinity if nothing was seen; constant in number
  Pose X_WS;                     ///< true pose of the sensor at the stamp, for pictures and checks

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"first_angle", "rad", "in the plane z = 0 of the sensor, from its x"}, self.first_angle_rad);
    f({"angle_step", "rad"}, self.angle_step_rad);
    f({"min_range", "m"}, self.min_range_m);
    f({"max_range", "m"}, self.max_range_m);
    f({"ranges", "m", "+inf: nothing seen"}, self.ranges_m);
    f({"sensor", "", "", true}, self.X_WS);
  }
};

/// Points of a scanning laser or of a depth camera, in the sensor's own frame at the instant of
/// each measurement: those of a moving sensor are not corrected for its motion. All lists have the
/// same length. What was not seen is left out, except in an organised cloud: there its
/// return_number is 0, and so are its coordinates and its intensity. ROS 2:
/// sensor_msgs/msg/PointCloud2 with the fields x, y, z, intensity, time (float32), ring (uint16),
/// return_number (uint8); an organised one also has t, range (uint32) and reflectivity (uint16),
/// and NaN where nothing was seen.
struct PointCloud {
  static constexpr const char* kType = "PointCloud";
  static constexpr MessageFrame kFrame = MessageFrame::kOwn;
  /// Of an organised cloud, whose points are in rows one after the other; 0: a list of points.
  std::uint32_t rows = 0;
  std::vector<float> x, y, z;       ///< m
  std::vector<float> intensity;     ///< received power; 1: see the sensor
  std::vector<float> time_s;        ///< from the stamp, not negative
  std::vector<std::uint16_t> ring;  ///< number of the laser
  /// 1: the strongest echo of its pulse, 2: the last one, 0: not seen
  std::vector<std::uint8_t> return_number;
  /// Truth: what was met (Label), and the number of the thing. Empty: the sensor does not give
  /// them.
  std::vector<std::uint8_t> label;
  std::vector<std::uint32_t> instance;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"x", "m"}, self.x);
    f({"y", "m"}, self.y);
    f({"z", "m"}, self.z);
    f({"intensity", "", "received power"}, self.intensity);
    f({"time", "s", "from the stamp, not negative"}, self.time_s);
    f({"ring", "", "number of the laser"}, self.ring);
    f({"return_number", "", "1: strongest echo of its pulse, 2: last one, 0: not seen"},
      self.return_number);
    f({"rows", "", "of an organised cloud, one after the other; 0: a list"}, self.rows);
    f({"label", "", "what was met, as cameras label it; empty: not given"}, self.label);
    f({"instance", "", "number of the thing, as cameras number it; empty: not given"},
      self.instance);
  }
};

/// Velocity through the air, measured by a pitot tube with vanes. ROS 2:
/// geometry_msgs/msg/Vector3Stamped.
struct AirData {
  static constexpr const char* kType = "AirData";
  Eigen::Vector3d v_air_B = Eigen::Vector3d::Zero();  ///< of the vehicle through the air, m/s

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"velocity", "m/s", "of the vehicle through the air, in the body"}, self.v_air_B);
  }
};

/// One picture taken from above. ROS 2: vinerow_msgs/msg/CameraShot.
struct CameraShot {
  static constexpr const char* kType = "CameraShot";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  std::int32_t index = -1;  ///< counted from 0; -1: none yet
  Pose X_WS;                ///< x of S along the optical axis, y to the picture's left, z up in it
  /// Points at which the picture's corners meet the ground: upper left, upper right, lower right,
  /// lower left, m. Valid only if `on_ground`.
  std::array<Eigen::Vector3d, 4> corners_W = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                              Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  bool on_ground = false;   ///< every corner meets the ground
  double distance_m = 0.0;  ///< to the ground along the optical axis
  double gsd_m = 0.0;       ///< ground sampling distance there

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"index", "", "counted from 0; -1: none yet"}, self.index);
    f({"camera", "", "it looks along its x, z up in the picture"}, self.X_WS);
    f({"corners", "m", "on the ground: upper left, upper right, lower right, lower left"},
      self.corners_W);
    f({"on_ground", "", "every corner meets the ground"}, self.on_ground);
    f({"distance", "m", "to the ground along the optical axis"}, self.distance_m);
    f({"ground_sampling_distance", "m", "of a pixel there"}, self.gsd_m);
  }
};

/// Electric energy. ROS 2: sensor_msgs/msg/BatteryState.
struct BatteryState {
  static constexpr const char* kType = "BatteryState";
  double power_W = 0.0;        ///< drawn now, positive when discharging
  double energy_used_J = 0.0;  ///< since the start
  double charge = 1.0;         ///< remaining share of the capacity

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"power", "W", "drawn now"}, self.power_W);
    f({"energy_used", "J", "since the start"}, self.energy_used_J);
    f({"charge", "", "remaining share of the capacity, 0 to 1"}, self.charge);
  }
};

}  // namespace vinerow
