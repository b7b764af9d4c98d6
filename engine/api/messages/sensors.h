#pragma once
/// Messages of sensors: readings as a vehicle gets them.
/// Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/math/pose.h"

namespace vinerow {

/// Inertial measurement. ROS 2: sensor_msgs/msg/Imu.
struct ImuSample {
  static constexpr const char* kType = "ImuSample";
  Eigen::Vector3d w_WS_S = Eigen::Vector3d::Zero();  ///< rate gyro, rad/s
  Eigen::Vector3d f_WS_S =
      Eigen::Vector3d::Zero();  ///< specific force (at rest on level ground: +g along z), m/s2

  template <class F>
  void fields(F&& f) {
    f(w_WS_S), f(f_WS_S);
  }
};

/// Satellite position fix, both in WGS84 and in W. ROS 2: sensor_msgs/msg/NavSatFix.
struct GnssFix {
  static constexpr const char* kType = "GnssFix";
  enum class Mode : std::uint8_t {
    kNone = 0,
    kStandalone = 1,  ///< code measurements alone
    kSbas = 2,        ///< with corrections from satellites
    kFloat = 3,       ///< carrier phase, ambiguities not resolved
    kFixed = 4        ///< carrier phase, ambiguities resolved
  };
  bool valid = false;
  Mode mode = Mode::kNone;      ///< kNone too where the receiver's model knows no modes
  std::int32_t satellites = 0;  ///< used; 0 where the model knows none
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;                          ///< above the ellipsoid
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();    ///< antenna, m
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();    ///< m/s
  Eigen::Vector3d std_m = Eigen::Vector3d::Zero();  ///< 1 sigma east, north, up
  double velocity_std_mps = 0.0;                    ///< 1 sigma of each component; 0: not told

  template <class F>
  void fields(F&& f) {
    f(valid), f(mode), f(satellites), f(velocity_std_mps), f(latitude_rad), f(longitude_rad),
        f(altitude_m), f(p_W), f(v_W), f(std_m);
  }
};

/// One range reading along x of S. ROS 2: sensor_msgs/msg/Range.
struct RangeSample {
  static constexpr const char* kType = "RangeSample";
  double range_m = 0.0;  ///< +infinity if nothing was seen
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double half_angle_rad = 0.0;
  Pose X_WS;  ///< true pose of the sensor at the reading, for pictures and checks

  template <class F>
  void fields(F&& f) {
    f(range_m), f(min_range_m), f(max_range_m), f(half_angle_rad), f(X_WS.p), f(X_WS.q);
  }
};

/// Static pressure of the air. ROS 2: sensor_msgs/msg/FluidPressure.
struct PressureSample {
  static constexpr const char* kType = "PressureSample";
  double pressure_Pa = 0.0;
  double std_Pa = 0.0;

  template <class F>
  void fields(F&& f) {
    f(pressure_Pa), f(std_Pa);
  }
};

/// Flux density of the magnetic field. ROS 2: sensor_msgs/msg/MagneticField.
struct MagneticSample {
  static constexpr const char* kType = "MagneticSample";
  Eigen::Vector3d field_S_T = Eigen::Vector3d::Zero();  ///< tesla, in S
  double std_T = 0.0;                                   ///< 1 sigma of each component

  template <class F>
  void fields(F&& f) {
    f(field_S_T), f(std_T);
  }
};

/// One turn of a scanning rangefinder in the plane z = 0 of S. ROS 2: sensor_msgs/msg/LaserScan.
struct LaserScan {
  static constexpr const char* kType = "LaserScan";
  double first_angle_rad = 0.0;  ///< of ranges_m[0], from x of S towards y
  double angle_step_rad = 0.0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  std::vector<double> ranges_m;  ///< +infinity where nothing was seen; constant in number
  Pose X_WS;                     ///< true pose of the sensor at the stamp, for pictures and checks

  template <class F>
  void fields(F&& f) {
    f(first_angle_rad), f(angle_step_rad), f(min_range_m), f(max_range_m), f(ranges_m);
    f(X_WS.p), f(X_WS.q);
  }
};

/// Velocity through the air, as a pitot tube with vanes tells it. ROS 2:
/// geometry_msgs/msg/Vector3Stamped.
struct AirData {
  static constexpr const char* kType = "AirData";
  Eigen::Vector3d v_air_B = Eigen::Vector3d::Zero();  ///< of the vehicle through the air, m/s

  template <class F>
  void fields(F&& f) {
    f(v_air_B);
  }
};

/// One picture taken from above. ROS 2: vinerow_msgs/msg/CameraShot.
struct CameraShot {
  static constexpr const char* kType = "CameraShot";
  std::int32_t index = -1;  ///< counted from 0; -1: none yet
  Pose X_WS;                ///< x of S along the optical axis, y to the picture's left, z up in it
  /// Where the picture's corners meet the ground: upper left, upper right, lower right, lower left,
  /// m. Only where `on_ground`.
  std::array<Eigen::Vector3d, 4> corners_W = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                              Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  bool on_ground = false;   ///< every corner meets the ground
  double distance_m = 0.0;  ///< to the ground along the optical axis
  double gsd_m = 0.0;       ///< ground sampling distance there

  template <class F>
  void fields(F&& f) {
    f(index), f(X_WS.p), f(X_WS.q);
    for (Eigen::Vector3d& corner : corners_W) f(corner);
    f(on_ground), f(distance_m), f(gsd_m);
  }
};

/// Electric energy. ROS 2: sensor_msgs/msg/BatteryState.
struct BatteryState {
  static constexpr const char* kType = "BatteryState";
  double power_W = 0.0;        ///< drawn now, positive when discharging
  double energy_used_J = 0.0;  ///< since the start
  double charge = 1.0;         ///< remaining share of the capacity

  template <class F>
  void fields(F&& f) {
    f(power_W), f(energy_used_J), f(charge);
  }
};

}  // namespace vinerow
