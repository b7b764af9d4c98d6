#include "controllers/estimation/inertial/error_state_estimator.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/estimation/inertial/error_state_sources.h"
#include "controllers/estimation/inertial/navigation_start.h"
#include "controllers/estimation/parts/estimator_events.h"
#include "controllers/estimation/parts/mounting.h"

namespace vinerow::controllers {
namespace {

class ErrorStateEstimator final : public Estimator {
 public:
  ErrorStateEstimator(const ParameterSet& parameters, const EstimatorContext& context)
      : options_(ErrorStateOptions::read(parameters, context.part)),
        filter_(filter_params(options_, context)),
        start_covariance_(start_covariance(options_)),
        random_(context.random("start")),
        initial_pose_(options_.initial_pose),
        X_BI_(mounting_of(context, options_.imu)),
        sources_(options_, context, X_BI_.p, filter_) {
    sources_.name_report(report_.names);
    for (const char* name : {"imu_refused", "imu_gaps", "covariance_repairs"}) {
      report_.names.push_back(name);
    }
    report_.values.assign(report_.names.size(), 0.0);
  }

  void connect(Ports& ports) override {
    imu_ = ports.read<ImuSample>(options_.imu);
    sources_.connect(ports);
    initial_pose_.connect(ports);
    if (!options_.starts_level) truth_ = ports.read<Odometry>("truth");
    estimate_ = ports.write<Odometry>("estimate");
    state_ = ports.write<NamedValues>("estimator_state");
    events_.connect(ports);
  }

  void step(Time now) override {
    events_.write(now);
    if (!filter_.started() && !try_to_start(now)) return;
    predict(now);
    if (const auto pose = initial_pose_.take()) {
      const NavStart moved = moved_start(filter_.state(), filter_.covariance(), *pose, X_BI_.p);
      filter_.start(filter_.time(), moved.state, moved.covariance);
      events_.report_event(Event::Level::kInfo, InitialPose::describe(*pose));
    }
    sources_.correct(!is_silent_);
    write_estimate(now);
    write_report(now);
  }

 private:
  static ErrorStateKalmanParams filter_params(const ErrorStateOptions& options,
                                              const EstimatorContext& context) {
    ErrorStateKalmanParams params = options.filter;
    params.gravity_mps2 = context.gravity_mps2;
    return params;
  }
  bool try_to_start(Time now) {
    if (!options_.starts_level) {
      if (!truth_.has_value()) return false;
      filter_.start(now, draw_start(truth_.value(), X_BI_.p, start_covariance_, random_),
                    start_covariance_);
    } else if (!try_to_level(now)) {
      return false;
    }
    sources_.start(now);
    return true;
  }

  bool try_to_level(Time now) {
    if (imu_.is_newer_than(seen_imu_)) {
      const Eigen::Vector3d f_B = X_BI_.q * imu_.value().f_WS_S;
      if (f_B.allFinite()) {
        if (level_count_ == 0) level_since_ = imu_.stamp();
        level_sum_ += f_B;
        ++level_count_;
      }
    }
    const GnssFix* fix = sources_.fix();
    const std::optional<Eigen::Vector3d> field_B = sources_.field_B();
    const bool is_long =
        level_count_ > 0 && (imu_.stamp() - level_since_).s() >= options_.levelling_s;
    const bool waits_for_field = sources_.has_compass() && !field_B.has_value();
    const bool waits_for_antennas =
        sources_.has_antennas() && !sources_.heading_rad(Eigen::Quaterniond::Identity());
    const bool has_heading = sources_.has_antennas() ? !waits_for_antennas : !waits_for_field;
    if (!is_long || fix == nullptr || !fix->valid || !has_heading) return false;
    const Eigen::Vector3d f_B = level_sum_ / level_count_;
    double yaw_rad = options_.start_yaw_rad;
    if (const auto by_antennas = sources_.heading_rad(level_attitude(f_B, 0.0))) {
      yaw_rad = *by_antennas;
    } else if (field_B) {
      yaw_rad = heading_from_field(f_B, *field_B, sources_.north_rad());
    }
    NavState state;
    state.q_WB = level_attitude(f_B, yaw_rad);
    state.p_WI = fix->p_W - state.q_WB * sources_.p_IA_B();
    if (!state.is_finite()) return false;
    filter_.start(std::min(now, imu_.stamp()), state, start_covariance_);
    return true;
  }

  void predict(Time now) {
    const std::uint64_t before = seen_imu_;
    if (imu_.is_newer_than(seen_imu_)) {
      lag_ = now - imu_.stamp();
      const ImuSample& sample = imu_.value();
      const Eigen::Vector3d w_B = X_BI_.q * sample.w_WS_S, f_B = X_BI_.q * sample.f_WS_S;
      const int samples = before == 0 ? 1 : static_cast<int>(seen_imu_ - before);
      if (filter_.predict(imu_.stamp(), w_B, f_B, samples)) {
        is_silent_ = false;
        sources_.see_reading(w_B, f_B);
      }
    }
    // The motion is unknown while the IMU is silent. Coast with the same delay as its readings.
    const Time until = now - lag_;
    const double silent_s = (until - filter_.time()).s();
    if (silent_s > options_.filter.longest_step_s || (is_silent_ && silent_s > 0.0)) {
      is_silent_ = true;
      filter_.coast(until);
    }
  }

  void write_estimate(Time now) {
    const NavState& state = filter_.state();
    const double ahead_s = std::max(0.0, (now - filter_.time()).s());
    const Eigen::Vector3d w_B = filter_.w_B();
    const Eigen::Vector3d p_IB_B = -X_BI_.p;
    Odometry estimate;
    estimate.X_WB.q = (state.q_WB * exp_rotation(ahead_s * w_B)).normalized();
    estimate.X_WB.p = state.p_WI + ahead_s * state.v_WI + estimate.X_WB.q * p_IB_B;
    estimate.v_WB_B = estimate.X_WB.q.conjugate() * state.v_WI + w_B.cross(p_IB_B);
    estimate.w_WB_B = w_B;
    const ErrorCovariance& P = filter_.covariance();
    const auto H = place_measurement(filter_.past(filter_.time()), p_IB_B, estimate.X_WB.p).H;
    estimate.set_position_covariance(H * P * H.transpose());
    const ErrorRow heading = heading_row(state.q_WB);
    estimate.yaw_std_rad = std::sqrt(std::max(0.0, (heading * P).dot(heading)));
    estimate_.write(now, estimate);
  }

  void write_report(Time now) {
    std::size_t i = sources_.fill_report(report_.values);
    report_.values[i++] = static_cast<double>(filter_.refused_readings());
    report_.values[i++] = static_cast<double>(filter_.gaps());
    report_.values[i++] = static_cast<double>(filter_.repairs());
    state_.write(now, report_);
  }

  ErrorStateOptions options_;
  ErrorStateKalman filter_;
  ErrorCovariance start_covariance_;
  RandomStream random_;
  InitialPose initial_pose_;
  Pose X_BI_;
  ErrorStateSources sources_;
  Duration lag_;
  bool is_silent_ = false;
  Eigen::Vector3d level_sum_ = Eigen::Vector3d::Zero();
  int level_count_ = 0;
  Time level_since_;
  NamedValues report_;
  std::uint64_t seen_imu_ = 0;
  SignalReader<Odometry> truth_;
  SignalReader<ImuSample> imu_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<NamedValues> state_;
  EstimatorEvents events_;
};

}  // namespace

PartSpec error_state_kalman_spec() {
  PartSpec spec;
  spec.name = "error_state_kalman";
  spec.description =
      "Inertial navigation aided by satellite fixes: error-state Kalman filter with 15 states "
      "(Sola 2017); optionally barometer, magnetometer, wheels and two antennas.";
  ErrorStateOptions::add_parameters(spec);
  spec.default_rate_Hz = 100.0;
  spec.reads = {"<imu>",
                "<gps>",
                "<barometer> (optional)",
                "<magnetometer> (optional)",
                "<wheels> (optional)",
                "<heading> (optional)",
                "truth (start: drawn)",
                "initialpose (from outside)"};
  spec.writes = {"estimate", "estimator_state", "estimator_event"};
  return spec;
}

std::unique_ptr<Estimator> make_error_state_kalman(const ParameterSet& parameters,
                                                   const EstimatorContext& context) {
  return std::make_unique<ErrorStateEstimator>(parameters, context);
}

}  // namespace vinerow::controllers
