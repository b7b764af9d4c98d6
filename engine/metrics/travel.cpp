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
    watch_standing(now, truth.X_WB.p, speed_mps);
    now_ = now;
  }

  std::map<std::string, double> results() const override {
    const double time_s = (now_ - begin_).s();
    const double energy_J =
        battery_.has_value() ? battery_.value().energy_used_J - start_energy_J_ : kNotMeasured;
    const double mean_power_W = time_s > 0.0 ? energy_J / time_s : kNotMeasured;
    // Who only takes in, or draws nothing, works for ever.
    const double battery_hours =
        mean_power_W > 0.0 ? capacity_J_ / mean_power_W / 3600.0 : kNotMeasured;
    return {{"distance_m", distance_m_},
            {"displacement_m", (last_p_W_ - start_p_W_).norm()},
            {"standing_drift_m", standing_drift_m_},
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

  /// A stand begins where the vehicle has been slower than 5 mm/s for 2 s, its springs settled, and
  /// ends above 5 cm/s. A creeping vehicle stands, so that its creep is seen.
  void watch_standing(Time now, const Eigen::Vector3d& p_W, double speed_mps) {
    constexpr double kSlow_mps = 0.005, kDriving_mps = 0.05, kSettle_s = 2.0;
    if (speed_mps > kDriving_mps) stands_ = false;
    if (speed_mps > kSlow_mps) slow_since_ = now;
    if (!stands_ && (now - slow_since_).s() >= kSettle_s) {
      stands_ = true;
      stand_p_W_ = p_W;
      if (!(standing_drift_m_ >= 0.0)) standing_drift_m_ = 0.0;
    }
    if (stands_) standing_drift_m_ = std::max(standing_drift_m_, (p_W - stand_p_W_).norm());
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
  Eigen::Vector3d stand_p_W_ = Eigen::Vector3d::Zero();
  double standing_drift_m_ = kNotMeasured;
  double distance_m_ = 0.0;
  double max_speed_mps_ = 0.0;
  double start_energy_J_ = 0.0;
  Time begin_, now_;
};

}  // namespace

const std::vector<MetricNumber>& travel_numbers() {
  static const std::vector<MetricNumber> numbers = {
      from_zero("distance_m"),   from_zero("displacement_m"),   from_zero("standing_drift_m"),
      from_zero("time_s"),       from_zero("mean_speed_mps"),   from_zero("max_speed_mps"),
      signed_number("energy_J"), signed_number("mean_power_W"), from_zero("battery_hours"),
      flag_number("finished")};
  return numbers;
}

PartSpec travel_spec() {
  PartSpec spec;
  spec.name = "travel";
  spec.description = "Distance, time, speed, energy and how long the battery lasts at that";
  spec.reads = {"truth", "battery (optional)", "follower (optional)"};
  spec.writes = written(travel_numbers());
  return spec;
}

std::unique_ptr<Metric> make_travel(const ParameterSet&, const MetricContext& context) {
  return std::make_unique<Travel>(context);
}

}  // namespace vinerow::metrics
