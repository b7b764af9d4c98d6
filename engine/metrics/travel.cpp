#include "engine/metrics/travel.h"

#include <algorithm>

#include "engine/api/messages/sensors.h"
#include "engine/metrics/spread.h"

namespace vinerow::metrics {
namespace {

class Travel final : public Metric {
 public:
  explicit Travel(const MetricContext& context) : vehicle_(context.vehicle_truth) {
    const std::optional<double>& capacity_J = context.vehicle_description->battery_capacity_J;
    if (capacity_J) capacity_J_ = *capacity_J;
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    battery_ = ports.read_optional<BatteryState>("battery");
    follower_ = ports.read_optional<FollowerState>("follower");
  }

  void step(Time now) override {
    const Odometry& truth = truth_.value();
    if (!has_last_) {
      begin_ = slow_since_ = now;
      start_p_W_ = last_p_W_ = truth.X_WB.p;
      start_energy_J_ = battery_.has_value() ? battery_.value().energy_used_J : 0.0;
    }
    distance_m_ += (truth.X_WB.p - last_p_W_).norm();
    last_p_W_ = truth.X_WB.p;
    has_last_ = true;
    const double speed_mps = truth.v_WB_B.norm();
    max_speed_mps_ = std::max(max_speed_mps_, speed_mps);
    watch_stationary(now, truth.X_WB.p, speed_mps);
    now_ = now;
  }

  std::map<std::string, double> results() const override {
    const double time_s = (now_ - begin_).nearest_s();
    const double energy_J =
        battery_.has_value() ? battery_.value().energy_used_J - start_energy_J_ : kNotMeasured;
    const double mean_power_W = time_s > 0.0 ? energy_J / time_s : kNotMeasured;
    // A vehicle that draws no power has no battery life.
    const double battery_hours =
        mean_power_W > 0.0 ? capacity_J_ / mean_power_W / 3600.0 : kNotMeasured;
    return {{"distance_m", distance_m_},
            {"displacement_m", (last_p_W_ - start_p_W_).norm()},
            {"standing_drift_m", stationary_drift_m_},
            {"time_s", time_s},
            {"mean_speed_mps", time_s > 0.0 ? distance_m_ / time_s : 0.0},
            {"max_speed_mps", max_speed_mps_},
            {"energy_J", energy_J},
            {"mean_power_W", mean_power_W},
            {"battery_hours", battery_hours},
            {"finished", finished() ? 1.0 : 0.0}};
  }

 private:
  bool finished() const {
    const bool wrecked = vehicle_ != nullptr && !vehicle_->crash().empty();
    return !wrecked && follower_.has_value() && follower_.value().finished;
  }

  /// The vehicle is stationary once it has been slower than kSlow_mps for kSettle_s, so that its
  /// springs have settled, and until it is faster than kDriving_mps. A creeping vehicle is
  /// therefore stationary, and its creep is measured.
  void watch_stationary(Time now, const Eigen::Vector3d& p_W, double speed_mps) {
    constexpr double kSlow_mps = 0.005, kDriving_mps = 0.05, kSettle_s = 2.0;
    if (speed_mps > kDriving_mps) stands_ = false;
    if (speed_mps > kSlow_mps) slow_since_ = now;
    if (!stands_ && (now - slow_since_).s() >= kSettle_s) {
      stands_ = true;
      stationary_p_W_ = p_W;
      if (!(stationary_drift_m_ >= 0.0)) stationary_drift_m_ = 0.0;
    }
    if (stands_)
      stationary_drift_m_ = std::max(stationary_drift_m_, (p_W - stationary_p_W_).norm());
  }

  const Vehicle* vehicle_;
  SignalReader<Odometry> truth_;
  SignalReader<BatteryState> battery_;
  SignalReader<FollowerState> follower_;
  double capacity_J_ = kNotMeasured;
  Eigen::Vector3d start_p_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_p_W_ = Eigen::Vector3d::Zero();
  bool has_last_ = false;
  Time slow_since_;
  bool stands_ = false;
  Eigen::Vector3d stationary_p_W_ = Eigen::Vector3d::Zero();
  double stationary_drift_m_ = kNotMeasured;
  double distance_m_ = 0.0;
  double max_speed_mps_ = 0.0;
  double start_energy_J_ = 0.0;
  Time begin_, now_;
};

}  // namespace

const std::vector<ResultSpec>& travel_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"distance_m", "m", Range::from_zero(), "distance travelled",
       "Length of the true track, summed at the metric's rate.", ""},
      {"displacement_m", "m", Range::from_zero(), "displacement",
       "Straight-line distance from the first to the last true position.", ""},
      {"standing_drift_m", "m", Range::from_zero(), "drift while stationary",
       "Largest distance from the position at which the vehicle became stationary: slower than 5 "
       "mm/s for 2 s, until it exceeds 5 cm/s.",
       ""},
      {"time_s", "s", Range::from_zero(), "time",
       "Simulated time from the first tick of the vehicle to the last.", ""},
      {"mean_speed_mps", "m/s", Range::from_zero(), "mean speed",
       "Distance travelled divided by time.", ""},
      {"max_speed_mps", "m/s", Range::from_zero(), "max speed", "Largest true speed.", ""},
      {"energy_J", "J", Range::any(), "energy used",
       "Energy drawn from the battery; negative if more was recovered than used. Null if the "
       "vehicle has no battery.",
       ""},
      {"mean_power_W", "W", Range::any(), "mean power", "Energy used divided by time.", ""},
      {"battery_hours", "h", Range::from_zero(), "battery endurance",
       "Battery capacity divided by mean power. Null if the vehicle has no battery or draws no "
       "power.",
       ""},
      {"finished", "1", Range::zero_or_one(), "mission completed",
       "1 if the controller has reported that its task is finished and the vehicle has not "
       "crashed, else 0.",
       ""}};
  return results;
}

PartSpec travel_spec() {
  PartSpec spec;
  spec.name = "travel";
  spec.description = "Distance, time, speed, energy and battery life at the mean power";
  spec.reads = {"truth", "battery (optional)", "follower (optional)"};
  spec.results = travel_results();
  return spec;
}

std::unique_ptr<Metric> make_travel(const ParameterSet&, const MetricContext& context) {
  return std::make_unique<Travel>(context);
}

}  // namespace vinerow::metrics
