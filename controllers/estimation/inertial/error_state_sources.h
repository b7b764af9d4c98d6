#pragma once
/// Aiding sources of `error_state_kalman`: satellite fixes, barometer, magnetometer, wheels, two
/// antennas, and zero velocity of a stationary vehicle.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "controllers/estimation/inertial/error_state_options.h"
#include "controllers/estimation/inertial/measurement_source.h"
#include "controllers/estimation/inertial/navigation_measurements.h"
#include "controllers/estimation/parts/stationary_detector.h"
#include "controllers/estimation/parts/wheel_speed.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/heading.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

class ErrorStateSources {
 public:
  /// @throws ConfigError if wheels are named and the vehicle has no wheels
  /// @param p_BI_B  the inertial unit in B
  ErrorStateSources(const ErrorStateOptions& options, const EstimatorContext& context,
                    const Eigen::Vector3d& p_BI_B, ErrorStateKalman& filter);

  void connect(Ports& ports);
  /// Starts the clock of rejected fixes.
  void start(Time now);
  /// Passes on a reading of the IMU that the filter used, along B's axes.
  void see_reading(const Eigen::Vector3d& w_B, const Eigen::Vector3d& f_B);
  /// Corrects by readings that are new and not newer than the state. @param has_reading whether the
  /// IMU delivers readings
  void correct(bool has_reading);

  const GnssFix* fix() const { return gnss_.has_value() ? &gnss_.value() : nullptr; }
  const Eigen::Vector3d& p_IA_B() const { return p_IA_B_; }
  bool has_compass() const { return !options_.magnetometer.empty(); }
  /// Magnetic field along B's axes; nullopt before the first reading.
  std::optional<Eigen::Vector3d> field_B() const;
  double north_rad() const { return north_rad_; }
  bool has_antennas() const { return !options_.heading.empty(); }
  /// Heading of the body's x axis from two antennas, for a known tilt; nullopt before the first
  /// reading.
  std::optional<double> heading_rad(const Eigen::Quaterniond& q_level_B) const;

  /// Appends the names nis_, used_, rejected_ of each source, and restarts.
  static void name_report(std::vector<std::string>& names);
  /// @returns how many values were written
  std::size_t fill_report(std::vector<double>& values) const;

 private:
  enum Source {
    kPosition,
    kVelocity,
    kBarometer,
    kMagnetometer,
    kWheels,
    kHeading,
    kStationary,
    kSources
  };

  template <class T>
  bool is_due(const SignalReader<T>& reader, std::uint64_t& seen, MeasurementSource& source);
  double age_s(Time stamp) const { return (filter_.time() - stamp).s(); }
  void correct(Source which, Time stamp, const VectorMeasurement& m,
               const Eigen::Vector3d& variances);
  void correct(Source which, Time stamp, const ScalarMeasurement& m, double variance);
  void take_fix();
  void restart_if_lost(const GnssFix& fix, Time stamp, const Eigen::Vector3d& variances);
  void take_pressure();
  void take_field();
  void take_wheels();
  void take_baseline();
  void apply_zero_velocity();

  const ErrorStateOptions& options_;
  ErrorStateKalman& filter_;
  double gravity_mps2_;
  StationaryDetector stationary_;
  WheelSpeed wheel_speed_;
  Eigen::Vector3d p_IA_B_, p_I_barometer_B_, p_I_constraint_B_;
  Eigen::Quaterniond q_BM_;
  Eigen::Vector3d baseline_axis_B_;  ///< unit, first to second antenna
  double north_rad_;
  std::array<MeasurementSource, kSources> sources_;
  std::int64_t restarts_ = 0;
  Eigen::Vector3d reading_w_B_ = Eigen::Vector3d::Zero();
  Time last_stationary_;
  bool has_pressure_zero_ = false;
  double pressure_zero_m_ = 0.0, pressure_zero_variance_m2_ = 0.0;
  std::uint64_t seen_fix_ = 0, seen_pressure_ = 0, seen_field_ = 0, seen_wheels_ = 0,
                seen_baseline_ = 0;
  SignalReader<GnssFix> gnss_;
  SignalReader<PressureSample> pressure_;
  SignalReader<MagneticSample> field_;
  SignalReader<NamedValues> wheels_;
  SignalReader<GnssHeading> baseline_;
};

}  // namespace vinerow::controllers
