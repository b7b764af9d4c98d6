#pragma once
/// Position and velocity errors of a GNSS receiver in each of its modes.
///
/// Per axis: error = s (white_std n + walk_std g). n is white. g is a first-order Gauss-Markov
/// process of unit variance and the mode's `walk_time_s`; each mode has its own g, which also
/// advances while another mode is active. s is the dilution of that axis relative to the usual one,
/// for which the mode's figures hold: that of code for standalone and SBAS, of carrier phase for
/// float and fixed. Velocity: white, with s from the dilution of position as a whole. RTK's walk
/// includes an additional 1 mm per km of `baseline_m` (ZED-F9P data sheet: 1 ppm).

#include <array>

#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"
#include "engine/sensors/gauss_markov.h"
#include "engine/sensors/gnss_geometry.h"

namespace vinerow::sensors {

/// Horizontal (each axis), vertical.
using GnssPair = std::array<double, 2>;

/// Errors of one mode at the usual dilution.
struct GnssModeError {
  GnssPair white_std_m;
  GnssPair walk_std_m;
  double walk_time_s;
  double velocity_std_mps;
  GnssPair usual_dop{};  ///< dilution for which these figures hold
};

/// Indexed by mode - 1: standalone, SBAS, float, fixed.
using GnssModeErrors = std::array<GnssModeError, 4>;

/// Defaults: u-blox ZED-F9P-04B data sheet (UBX-21044850 R05), table 3, GPS + Galileo. Circular
/// error probable / 1.1774 and median of the height's error / 0.6745 are standard deviations: PVT
/// 1.5 m and 2.0 m, SBAS 1.0 m and 1.5 m, RTK 0.01 m and 0.01 m; velocity 0.05 m/s (50 %) / 1.1774.
/// Shares: white noise by code and 1100 s from Beard, McLain, Small Unmanned Aircraft, 2012, table
/// 7.1; other times, float, and the white share of fixed are chosen. Dilutions: means over ten days
/// under an open sky at 38 to 53 deg of latitude, with the other defaults.
struct GnssErrorParams {
  GnssModeErrors modes{{{{0.21, 0.40}, {1.257, 2.938}, 1100.0, 0.042},
                        {{0.21, 0.40}, {0.823, 2.188}, 300.0, 0.042},
                        {{0.02, 0.04}, {0.25, 0.40}, 60.0, 0.042},
                        {{0.005, 0.009}, {0.0069, 0.0118}, 60.0, 0.042}}};
  GnssPair code_usual_dop{0.8, 1.2};
  GnssPair carrier_usual_dop{1.0, 1.45};
  double baseline_m = 1000.0;

  /// Errors of the modes, each with its usual dilution and, for RTK, with the baseline's
  /// contribution.
  GnssModeErrors resolve() const;
};

/// `standalone_white_std_m` [horizontal, vertical], `standalone_walk_std_m`,
/// `standalone_walk_time_s`, `standalone_velocity_std_mps`, the same for `sbas`, `float` and
/// `fixed`; `code_usual_dop` [horizontal, vertical], `carrier_usual_dop`, `baseline_m`.
const ParameterTable<GnssErrorParams>& gnss_error_table();

class GnssError {
 public:
  GnssError(const GnssModeErrors& modes, double period_s, RandomStream random);

  /// Advances by one tick, with or without a fix: always draws the same count of numbers.
  void draw();

  /// Adds errors to an exact fix and sets its standard deviations.
  /// @param fix  its mode is not kNone
  void apply(const Dilution& dilution, GnssFix& fix) const;

 private:
  GnssModeErrors modes_;
  RandomStream random_;
  std::array<std::array<GaussMarkov, 3>, 4> walks_;  ///< of mode and axis
  Eigen::Vector3d white_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_white_ = Eigen::Vector3d::Zero();
};

}  // namespace vinerow::sensors
