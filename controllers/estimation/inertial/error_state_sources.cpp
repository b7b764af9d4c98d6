#include "controllers/estimation/inertial/error_state_sources.h"

#include <algorithm>
#include <cmath>

#include "controllers/estimation/inertial/navigation_start.h"
#include "controllers/estimation/parts/mounting.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kMinStd_m = 1e-3;           // an ideal receiver states zero
constexpr double kLargestTurn_rad = 0.05;    // 3 deg; up to it the baseline is used as a vector
constexpr double kStationaryPeriod_s = 0.2;  // between zero-velocity updates
constexpr double kRestartVelocityStd_mps = 5.0;
constexpr int kRestartRejections = 5;  // 5 s of a receiver at 1 Hz

}  // namespace

ErrorStateSources::ErrorStateSources(const ErrorStateOptions& options,
                                     const EstimatorContext& context, const Eigen::Vector3d& p_BI_B,
                                     ErrorStateKalman& filter)
    : options_(options),
      filter_(filter),
      gravity_mps2_(context.gravity_mps2),
      stationary_(options.standing_s),
      p_IA_B_(mounting_of(context, options.gps).p - p_BI_B),
      p_I_barometer_B_(mounting_of(context, options.barometer).p - p_BI_B),
      p_I_constraint_B_(options.constraint_point_B - p_BI_B),
      q_BM_(mounting_of(context, options.magnetometer).q),
      baseline_axis_B_(mounting_of(context, options.heading).q * Eigen::Vector3d::UnitX()),
      north_rad_(0.5 * kPi - options.declination_rad) {
  if (!options.wheels.empty()) {
    wheel_speed_ = WheelSpeed(*context.vehicle_description, context.part + " (error_state_kalman)");
  }
}

void ErrorStateSources::connect(Ports& ports) {
  gnss_ = ports.read<GnssFix>(options_.gps);
  if (!options_.barometer.empty()) pressure_ = ports.read<PressureSample>(options_.barometer);
  if (!options_.magnetometer.empty()) field_ = ports.read<MagneticSample>(options_.magnetometer);
  if (!options_.wheels.empty()) wheels_ = ports.read<NamedValues>(options_.wheels);
  if (!options_.heading.empty()) baseline_ = ports.read<GnssHeading>(options_.heading);
}

void ErrorStateSources::start(Time now) {
  for (MeasurementSource& source : sources_) source.reset_rejections(now);
  // Ignore a fix from before the start without counting it as rejected.
  if (gnss_.has_value() && gnss_.stamp() < filter_.time()) seen_fix_ = gnss_.sequence();
}

std::optional<Eigen::Vector3d> ErrorStateSources::field_B() const {
  if (!field_.has_value()) return std::nullopt;
  return q_BM_ * field_.value().field_S_T;
}

void ErrorStateSources::see_reading(const Eigen::Vector3d& w_B, const Eigen::Vector3d& f_B) {
  reading_w_B_ = w_B;
  if (options_.stationary != ErrorStateOptions::Standing::kImu) return;
  stationary_.see_imu(filter_.time(), filter_.w_B(), f_B, filter_.state().v_WI.norm(),
                      gravity_mps2_);
}

void ErrorStateSources::correct(bool has_reading) {
  take_fix();
  take_pressure();
  take_field();
  take_wheels();
  take_baseline();
  if (has_reading) apply_zero_velocity();
}

/// True once for each reading whose time the state has reached and still remembers.
template <class T>
bool ErrorStateSources::is_due(const SignalReader<T>& reader, std::uint64_t& seen,
                               MeasurementSource& source) {
  if (!reader.connected() || !reader.has_value() || reader.stamp() > filter_.time()) return false;
  if (!reader.is_newer_than(seen)) return false;
  if (!source.is_newer(reader.stamp())) return false;
  if (filter_.remembers(reader.stamp())) return true;
  source.reject();
  return false;
}

void ErrorStateSources::correct(Source which, Time stamp, const VectorMeasurement& m,
                                const Eigen::Vector3d& variances) {
  sources_[which].take(
      stamp, filter_.correct_vector(m.innovation, filter_.at_age(m.H, age_s(stamp)), variances,
                                    options_.gate_sigma));
}
void ErrorStateSources::correct(Source which, Time stamp, const ScalarMeasurement& m,
                                double variance) {
  sources_[which].take(
      stamp, filter_.correct_scalar(m.innovation, filter_.at_age(m.H, age_s(stamp)), variance,
                                    options_.gate_sigma));
}

void ErrorStateSources::take_fix() {
  if (!is_due(gnss_, seen_fix_, sources_[kPosition])) return;
  const GnssFix& fix = gnss_.value();
  if (!fix.valid) return;
  const Time stamp = gnss_.stamp();
  const Eigen::Vector3d std_m = options_.gnss_std_m > 0.0
                                    ? Eigen::Vector3d::Constant(options_.gnss_std_m)
                                    : Eigen::Vector3d(fix.std_m.cwiseMax(kMinStd_m));
  const Eigen::Vector3d variances =
      sources_[kPosition].inflation(stamp, options_.gnss_correlation_s) * std_m.cwiseAbs2();
  correct(kPosition, stamp, place_measurement(filter_.past(stamp), p_IA_B_, fix.p_W), variances);
  restart_if_lost(fix, stamp, variances);

  const double velocity_std_mps =
      options_.gnss_velocity_std_mps > 0.0 ? options_.gnss_velocity_std_mps : fix.velocity_std_mps;
  if (velocity_std_mps == 0.0) return;
  correct(kVelocity, stamp, velocity_measurement(filter_.past(stamp), p_IA_B_, fix.v_W),
          Eigen::Vector3d::Constant(velocity_std_mps * velocity_std_mps));
}

/// If every fix is rejected for several seconds, the filter itself has diverged: restart.
void ErrorStateSources::restart_if_lost(const GnssFix& fix, Time stamp,
                                        const Eigen::Vector3d& variances) {
  MeasurementSource& source = sources_[kPosition];
  const bool lost = source.rejected_in_a_row() >= kRestartRejections &&
                    (stamp - source.last_used()).s() > options_.restart_after_s;
  if (!lost || !fix.p_W.allFinite() || !variances.allFinite()) return;
  const bool has_velocity = fix.v_W.allFinite() && fix.velocity_std_mps > 0.0;
  const Eigen::Vector3d v_W = has_velocity ? fix.v_W : Eigen::Vector3d::Zero();
  const double v_std_mps = has_velocity ? fix.velocity_std_mps : kRestartVelocityStd_mps;
  filter_.restart_at(fix.p_W - filter_.state().q_WB * p_IA_B_ + age_s(stamp) * v_W,
                     variances + Eigen::Vector3d::Constant(std::pow(age_s(stamp) * v_std_mps, 2)),
                     v_W, v_std_mps * v_std_mps);
  filter_.loosen_attitude(std::pow(options_.start_tilt_std_rad, 2),
                          std::pow(options_.start_yaw_std_rad, 2));
  for (MeasurementSource& each : sources_) each.reset_rejections(stamp);
  ++restarts_;
}

/// Height relative to the first reading, whose height is the estimate at that time.
void ErrorStateSources::take_pressure() {
  if (!is_due(pressure_, seen_pressure_, sources_[kBarometer])) return;
  const double height_m = standard_height_m(pressure_.value().pressure_Pa);
  if (!std::isfinite(height_m)) {
    sources_[kBarometer].reject();
    return;
  }
  const Time stamp = pressure_.stamp();
  const ScalarMeasurement at_zero = height_measurement(filter_.past(stamp), p_I_barometer_B_, 0.0);
  if (!has_pressure_zero_) {
    has_pressure_zero_ = true;
    pressure_zero_m_ = height_m + at_zero.innovation;
    pressure_zero_variance_m2_ =
        filter_.covariance()(ErrorIndex::kPosition + 2, ErrorIndex::kPosition + 2);
    return;
  }
  ScalarMeasurement m = at_zero;
  m.innovation += height_m - pressure_zero_m_;
  const double own =
      options_.barometer_std_m * options_.barometer_std_m + pressure_zero_variance_m2_;
  correct(kBarometer, stamp, m,
          own * sources_[kBarometer].inflation(stamp, options_.barometer_correlation_s));
}

void ErrorStateSources::take_field() {
  if (!is_due(field_, seen_field_, sources_[kMagnetometer])) return;
  const Time stamp = field_.stamp();
  const double std_rad = options_.magnetometer_std_rad;
  correct(kMagnetometer, stamp,
          magnetic_measurement(filter_.past(stamp), q_BM_ * field_.value().field_S_T, north_rad_),
          std_rad * std_rad *
              sources_[kMagnetometer].inflation(stamp, options_.magnetometer_correlation_s));
}

void ErrorStateSources::take_wheels() {
  if (!is_due(wheels_, seen_wheels_, sources_[kWheels])) return;
  const Time stamp = wheels_.stamp();
  const double speed_mps = wheel_speed_.read_mps(wheels_.value());
  if (options_.stationary == ErrorStateOptions::Standing::kWheels && std::isfinite(speed_mps)) {
    stationary_.see_wheels(stamp, speed_mps);
  }
  const Eigen::Vector3d std_mps(options_.wheel_std_mps, options_.lateral_std_mps,
                                options_.vertical_std_mps);
  correct(kWheels, stamp,
          body_velocity_measurement(filter_.past(stamp), p_I_constraint_B_, {speed_mps, 0.0, 0.0}),
          sources_[kWheels].inflation(stamp, options_.wheel_correlation_s) * std_mps.cwiseAbs2());
}

/// The baseline between two antennas rotates with the body: z = R l a, with a along the baseline.
void ErrorStateSources::take_baseline() {
  if (!is_due(baseline_, seen_baseline_, sources_[kHeading])) return;
  const GnssHeading& reading = baseline_.value();
  if (!reading.valid) return;
  const Time stamp = baseline_.stamp();
  const PastState past = filter_.past(stamp);
  const double inflation = sources_[kHeading].inflation(stamp, options_.heading_correlation_s);
  // With a large heading error the difference of the vectors is not linear in it; that of the
  // headings is.
  const ScalarMeasurement heading =
      magnetic_measurement(past, baseline_axis_B_, reading.heading_rad);
  const double variance_rad2 = (heading.H * filter_.covariance()).dot(heading.H);
  if (variance_rad2 > kLargestTurn_rad * kLargestTurn_rad) {
    const double std_rad = std::max(reading.heading_std_rad, kMinStd_m / reading.length_m);
    correct(kHeading, stamp, heading, inflation * std_rad * std_rad);
    return;
  }
  const Eigen::Vector3d std_m = reading.std_m.cwiseMax(kMinStd_m);
  correct(kHeading, stamp,
          direction_measurement(past, reading.length_m * baseline_axis_B_, reading.baseline_W),
          inflation * std_m.cwiseAbs2());
}

std::optional<double> ErrorStateSources::heading_rad(const Eigen::Quaterniond& q_level_B) const {
  if (!baseline_.connected() || !baseline_.has_value() || !baseline_.value().valid) {
    return std::nullopt;
  }
  const Eigen::Vector3d axis = q_level_B * baseline_axis_B_;
  return wrap_angle(baseline_.value().heading_rad - std::atan2(axis.y(), axis.x()));
}

void ErrorStateSources::apply_zero_velocity() {
  const Time now = filter_.time();
  const bool due = options_.stationary != ErrorStateOptions::Standing::kOff &&
                   stationary_.stands(now) && (now - last_stationary_).s() >= kStationaryPeriod_s;
  if (!due) return;
  last_stationary_ = now;
  const double std_mps = options_.standing_std_mps;
  correct(kStationary, now,
          velocity_measurement(filter_.past(now), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()),
          Eigen::Vector3d::Constant(std_mps * std_mps));
  // The noise of one gyro reading is density / sqrt(period); a short period bounds it from above.
  constexpr double kShortestPeriod_s = 1e-3;
  const double density = options_.filter.imu.gyro_radps_rtHz;
  const VectorMeasurement rate =
      stationary_rate_measurement(reading_w_B_, filter_.state().gyro_bias_B);
  filter_.correct_vector(rate.innovation, rate.H,
                         Eigen::Vector3d::Constant(density * density / kShortestPeriod_s),
                         options_.gate_sigma);
}

void ErrorStateSources::name_report(std::vector<std::string>& names) {
  for (const char* name : {"gnss_position", "gnss_velocity", "barometer", "magnetometer", "wheels",
                           "heading", "zero_velocity"}) {
    for (const char* what : {"nis_", "used_", "rejected_"}) {
      names.push_back(std::string(what) + name);
    }
  }
  names.push_back("restarts");
}

std::size_t ErrorStateSources::fill_report(std::vector<double>& values) const {
  std::size_t i = 0;
  for (const MeasurementSource& source : sources_) {
    values[i++] = source.nis();
    values[i++] = static_cast<double>(source.used());
    values[i++] = static_cast<double>(source.rejected());
  }
  values[i++] = static_cast<double>(restarts_);
  return i;
}

}  // namespace vinerow::controllers
