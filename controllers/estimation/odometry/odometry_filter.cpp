#include "controllers/estimation/odometry/odometry_filter.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "controllers/estimation/odometry/odometry_kalman.h"
#include "controllers/estimation/parts/estimator_events.h"
#include "controllers/estimation/parts/heading_source.h"
#include "controllers/estimation/parts/initial_pose.h"
#include "controllers/estimation/parts/mounting.h"
#include "controllers/estimation/parts/trace.h"
#include "controllers/parts/ground_drive/differential_drive.h"
#include "controllers/parts/paths/pose2.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

struct OdometryFilterParams {
  enum class Source { kCommand, kWheels, kGpsVelocity };

  std::string gps = "gps", wheels = "wheels";  ///< signals
  std::optional<Eigen::Vector3d> p_BA;         ///< antenna in B; absent: as mounted
  Source source = Source::kCommand;
  double odometry_scale = 1.0;
  bool gain_is_fixed = false;
  double position_gain = 0.05;  ///< if the gain is fixed
  OdometryKalmanParams filter;
  double gps_std_m = 0.0;  ///< 0: as the receiver states
  HeadingParams heading;
  InitialPoseParams initial_pose;
};

const ParameterTable<OdometryFilterParams>& odometry_filter_table() {
  using P = OdometryFilterParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("gps", &P::gps, "signal of the satellite receiver")
          .numbers("antenna_m", "m", &P::p_BA, between(-100.0, 100.0),
                   "position of the antenna in B (x, y, z), subtracted from the fix; default: "
                   "where the receiver is mounted")
          .choice(
              "odometry_source", &P::source,
              {{"command", P::Source::kCommand},
               {"wheels", P::Source::kWheels},
               {"gps_velocity", P::Source::kGpsVelocity}},
              "speed that is integrated: the controller's command, the wheels, or the satellite "
              "velocity; only the latter measures the sliding of a skid-steered vehicle")
          .text("wheels", &P::wheels, "signal of the wheel speeds (odometry_source: wheels)")
          .number("odometry_scale", "", &P::odometry_scale, kPositive,
                  "factor on the odometry's speed: calibration, or an error to study")
          .choice(
              "gain", &P::gain_is_fixed, {{"kalman", false}, {"fixed", true}},
              "kalman: from the stated noise, estimates the odometry scale; fixed: position_gain")
          .number("position_gain", "", &P::position_gain, between(0.0, 1.0),
                  "share of the difference that each fix corrects (gain: fixed)")
          .number("drift_m_per_sqrt_m", "m/sqrt(m)",
                  inside(&P::filter, &OdometryKalmanParams::drift_m_per_sqrt_m), kPositive,
                  "1 sigma of the error of dead reckoning over one metre (gain: kalman)")
          .number("scale_std", "", inside(&P::filter, &OdometryKalmanParams::scale_std),
                  between(0.0, 1.0),
                  "1 sigma of the odometry's scale at the start (gain: kalman); 0 = not estimated")
          .number("gps_std_m", "m", &P::gps_std_m, between(0.0, 100.0),
                  "1 sigma of a fix; 0 = as the receiver states")
          .include(&P::heading, heading_table())
          .include(&P::initial_pose, initial_pose_table());
  return table;
}

OdometryKalmanParams make_kalman_params(const OdometryFilterParams& params) {
  OdometryKalmanParams kalman = params.filter;
  if (kalman.scale_std <= 0.0) kalman.scale_drift_per_sqrt_m = 0.0;
  if (params.gain_is_fixed) kalman.fixed_gain = params.position_gain;
  return kalman;
}

class OdometryFilter final : public Estimator {
 public:
  OdometryFilter(const OdometryFilterParams& params, const EstimatorContext& context)
      : gps_name_(params.gps),
        source_(params.source),
        wheels_name_(params.wheels),
        odometry_scale_(params.odometry_scale),
        gps_std_m_(params.gps_std_m),
        period_s_(context.period.s()),
        filter_(make_kalman_params(params)),
        heading_(params.heading, context),
        initial_pose_(params.initial_pose),
        p_BA_(antenna_of(context, params.gps, params.p_BA)) {
    if (source_ == Source::kWheels) {
      const std::string who = context.part + " (odometry_filter)";
      const VehicleDescription& vehicle = *context.vehicle_description;
      wheel_radius_m_ =
          vehicle.need_positive(vehicle.need_wheeled(who).wheel_radius_m, "wheel_radius_m", who);
      for (const ActuatorSpec& actuator : context.vehicle_description->actuators) {
        const double side = side_of_wheel(actuator.name);
        if (side != 0.0) wheels_.push_back({actuator.name, side, -1});
      }
      if (wheels_.empty()) {
        throw ConfigError(
            fmt::format("{} (odometry_filter): odometry_source = wheels, but vehicle type '{}' has "
                        "no wheel speeds",
                        context.part, context.vehicle_description->type));
      }
    }
  }

  void connect(Ports& ports) override {
    gps_ = ports.read<GnssFix>(gps_name_);
    heading_.connect(ports);
    if (source_ == Source::kWheels) wheel_speeds_ = ports.read<NamedValues>(wheels_name_);
    if (source_ == Source::kCommand) command_ = ports.read<VelocityCommand>("command");
    estimate_ = ports.write<Odometry>("estimate");
    initial_pose_.connect(ports);
    events_.connect(ports);
  }

  void step(Time now) override {
    const bool is_new = gps_.is_newer_than(seen_fix_) && gps_.value().valid;
    const bool was_ready = heading_.ready();
    const double yaw_before = heading_.yaw_rad();
    heading_.step(is_new ? &gps_.value() : nullptr);
    if (!heading_.ready()) return;
    if (const auto pose = initial_pose_.take()) restart_at(now, *pose);

    const Eigen::Vector2d v_B = odometry_scale_ * read_velocity_B();
    if (filter_.ready() && was_ready && now != restarted_) {
      // An arc: the velocity turns with the heading, so its chord has the mean heading.
      const double turn = wrap_angle(heading_.yaw_rad() - yaw_before);
      const double slide_rad = std::atan2(v_B.y(), v_B.x());
      const double distance_m = v_B.norm() * period_s_;
      filter_.predict(advance({{0.0, 0.0}, yaw_before + slide_rad}, distance_m, turn).p);
      trace_.add(now, filter_.p());
    }
    if (is_new) take_fix(now);
    if (filter_.ready()) write_estimate(now, v_B);
    events_.write(now);
  }

 private:
  using Source = OdometryFilterParams::Source;

  /// The height stays. What was measured before is compared with the new position.
  void restart_at(Time now, const InitialPose::Value& pose) {
    heading_.restart(pose.yaw_rad);
    filter_.start(pose.p_W, pose.std_m);
    trace_.clear();
    trace_.add(now, filter_.p());
    restarted_ = now;
    events_.report_event(Event::Level::kInfo, InitialPose::describe(pose));
  }

  void take_fix(Time now) {
    const GnssFix& fix = gps_.value();
    const Eigen::Vector3d p_B = fix.p_W - heading_.q_WB() * p_BA_;
    height_m_ = p_B.z();
    const Eigen::Vector2d std_m = gps_std_m_ > 0.0
                                      ? Eigen::Vector2d(gps_std_m_, gps_std_m_)
                                      : Eigen::Vector2d(fix.std_m.head<2>().cwiseMax(kMinStd_m));
    if (!filter_.ready()) {
      filter_.start(p_B.head<2>(), std_m);
      trace_.add(now, filter_.p());
      return;
    }
    const Eigen::Vector2d was = trace_.empty() ? filter_.p() : trace_.at(gps_.stamp());
    filter_.correct(p_B.head<2>() - was, std_m);
  }

  /// Velocity in the plane of B, m/s. Wheels and command do not contain sideways sliding.
  Eigen::Vector2d read_velocity_B() {
    if (source_ == Source::kWheels) return {read_wheel_speed_mps(), 0.0};
    if (source_ == Source::kCommand)
      return {command_.has_value() ? command_.value().v_mps : 0.0, 0.0};
    if (!gps_.has_value() || !gps_.value().valid) return velocity_B_;
    const Eigen::Vector3d v_B =
        heading_.q_WB().conjugate() * gps_.value().v_W - heading_.w_WB_B().cross(p_BA_);
    return velocity_B_ = v_B.head<2>();
  }

  double read_wheel_speed_mps() {
    if (!wheel_speeds_.has_value()) return 0.0;
    const NamedValues& speeds = wheel_speeds_.value();
    double left = 0.0, right = 0.0;
    int lefts = 0, rights = 0;
    for (Wheel& wheel : wheels_) {
      if (wheel.index < 0) find_wheel(speeds, wheel);
      if (wheel.index < 0) continue;
      (wheel.side > 0.0 ? right : left) += speeds.values[wheel.index];
      ++(wheel.side > 0.0 ? rights : lefts);
    }
    if (lefts == 0 || rights == 0) return 0.0;
    return 0.5 * wheel_radius_m_ * (left / lefts + right / rights);
  }

  struct Wheel {
    std::string name;
    double side;
    int index;
  };
  static void find_wheel(const NamedValues& speeds, Wheel& wheel) {
    for (std::size_t i = 0; i < speeds.names.size(); ++i) {
      if (speeds.names[i] == wheel.name) wheel.index = static_cast<int>(i);
    }
  }

  void write_estimate(Time now, const Eigen::Vector2d& v_B) {
    Odometry estimate;
    estimate.X_WB.q = heading_.q_WB();
    estimate.X_WB.p = {filter_.p().x(), filter_.p().y(), height_m_};
    estimate.v_WB_B.head<2>() = filter_.scale() * v_B;
    estimate.w_WB_B = heading_.w_WB_B();
    estimate.position_variance_m2.head<2>() = filter_.covariance().diagonal().head<2>();
    estimate.position_covariance_m2.x() = filter_.covariance()(0, 1);
    estimate_.write(now, estimate);
  }

  static constexpr double kMinStd_m = 1e-3;  // an ideal receiver states zero

  std::string gps_name_;
  Source source_;
  std::string wheels_name_;
  double odometry_scale_;
  double gps_std_m_;
  double period_s_;
  OdometryKalman filter_;
  HeadingSource heading_;
  InitialPose initial_pose_;
  std::optional<Time> restarted_;  ///< by a pose from outside
  EstimatorEvents events_;
  Eigen::Vector3d p_BA_;
  double wheel_radius_m_ = 0.0;
  std::vector<Wheel> wheels_;
  double height_m_ = 0.0;
  Eigen::Vector2d velocity_B_ = Eigen::Vector2d::Zero();  ///< from the last valid fix
  RecentTrace<Eigen::Vector2d> trace_;                    ///< of the estimate
  std::uint64_t seen_fix_ = 0;
  SignalReader<GnssFix> gps_;
  SignalReader<VelocityCommand> command_;
  SignalReader<NamedValues> wheel_speeds_;
  SignalWriter<Odometry> estimate_;
};

}  // namespace

PartSpec odometry_filter_spec() {
  PartSpec spec;
  spec.name = "odometry_filter";
  spec.description =
      "Dead reckoning along the heading with wheel, commanded or satellite speed, corrected by "
      "satellite fixes with a Kalman gain (position and odometry scale) or a fixed gain.";
  odometry_filter_table().add_to(spec);
  spec.default_rate_Hz = 40.0;
  spec.reads = {"<gps>", "<imu>", "command or <wheels>", "truth (start; heading: truth)",
                "initialpose (from outside)"};
  spec.writes = {"estimate", "estimator_event"};
  return spec;
}

std::unique_ptr<Estimator> make_odometry_filter(const ParameterSet& parameters,
                                                const EstimatorContext& context) {
  return std::make_unique<OdometryFilter>(
      odometry_filter_table().read(parameters, context.part + " (odometry_filter)"), context);
}

}  // namespace vinerow::controllers
