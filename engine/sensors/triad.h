#pragma once
/// Three-axis sensor of an inertial unit, with its errors.
///
/// reading = limit(round((I + E) truth + turn-on bias + in-run bias + white noise)). E has the
/// scale errors on its diagonal and the misalignments off it: axis i senses m_ij of axis j.
/// Properties of the device (turn-on bias, E) are drawn once per run.

#include <Eigen/Core>
#include <array>
#include <string>

#include "engine/api/parameter_table.h"
#include "engine/api/part.h"
#include "engine/sensors/bias_instability.h"

namespace vinerow::sensors {

/// Errors of one triad, in SI units and radians; u is rad/s or m/s2.
struct TriadFigures {
  AllanFigures allan;
  double turn_on_bias_std_u = 0.0;
  double scale_error_std = 0.0;                            ///< share
  Eigen::Vector3d scale_errors = Eigen::Vector3d::Zero();  ///< added to the drawn errors
  double misalignment_std_rad = 0.0;                       ///< of each of the six angles
  /// Added to the drawn angles, rad: x towards y and z, y towards x and z, z towards x and y.
  std::array<double, 6> misalignments_rad{};
  double range_u = 1.0;       ///< > 0
  double resolution_u = 0.0;  ///< 0: continuous
};

/// Parameter names of one triad: `<name>_noise_<unit>_rtHz`, ...
struct TriadNames {
  std::string name;                               ///< "gyro"
  std::string unit, unit_key;                     ///< "deg/s", "dps"
  std::string walk_unit, walk_key;                ///< "deg/s2", "dps2"
  std::string instability_unit, instability_key;  ///< "deg/h", "dph"
  ParameterConversion si;                         ///< from `unit` to SI
  ParameterConversion instability_si;             ///< from `instability_unit` to SI
};

/// @returns a new table, which the caller keeps
ParameterTable<TriadFigures> make_triad_table(const TriadNames& names);

class Triad {
 public:
  /// @param context  its part, e.g. "rover.imu", names the random streams
  /// "<part>.<names.name>_noise" (white), "_bias" (in-run) and "_device" (drawn once)
  /// @throws ConfigError if white noise and random walk alone exceed the bias instability
  Triad(const TriadNames& names, const TriadFigures& figures, const PartContext& context);

  Eigen::Vector3d read(const Eigen::Vector3d& truth);

 private:
  TriadFigures figures_;
  RandomStream noise_random_, bias_random_;
  double white_std_u_ = 0.0;  ///< per sample
  double walk_std_u_ = 0.0;   ///< change of the bias per sample
  bool wanders_ = false;
  std::array<BiasInstability, 3> instability_;
  Eigen::Vector3d bias_u_;  ///< turn-on and random walk
  Eigen::Matrix3d gain_;    ///< I + E
};

}  // namespace vinerow::sensors
