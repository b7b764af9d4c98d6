#include "engine/sim/metrics/travel.h"

#include <algorithm>
#include <limits>

namespace vinerow {
namespace {

class Travel final : public Metric {
 public:
  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    battery_ = ports.read_optional<BatteryState>("battery");
    follower_ = ports.read_optional<FollowerState>("follower");
  }

  void step(Time now) override {
    const Odometry& truth = truth_.value();
    if (has_last_) distance_m_ += (truth.X_WB.p - last_p_W_).norm();
    last_p_W_ = truth.X_WB.p;
    has_last_ = true;
    max_speed_mps_ = std::max(max_speed_mps_, truth.v_WB_B.norm());
    now_ = now;
  }

  std::map<std::string, double> results() const override {
    const double time_s = now_.s();
    return {{"distance_m", distance_m_},
            {"time_s", time_s},
            {"mean_speed_mps", time_s > 0.0 ? distance_m_ / time_s : 0.0},
            {"max_speed_mps", max_speed_mps_},
            {"energy_J", battery_.has_value() ? battery_.value().energy_used_J
                                              : std::numeric_limits<double>::quiet_NaN()},
            {"finished", follower_.has_value() && follower_.value().finished ? 1.0 : 0.0}};
  }

 private:
  SignalReader<Odometry> truth_;
  SignalReader<BatteryState> battery_;
  SignalReader<FollowerState> follower_;
  Eigen::Vector3d last_p_W_ = Eigen::Vector3d::Zero();
  bool has_last_ = false;
  double distance_m_ = 0.0;
  double max_speed_mps_ = 0.0;
  Time now_;
};

}  // namespace

PartSpec travel_spec() {
  PartSpec spec;
  spec.name = "travel";
  spec.description = "Distance, time, speed and energy";
  spec.reads = {"truth", "battery (optional)", "follower (optional)"};
  spec.writes = {"distance_m", "time_s", "mean_speed_mps", "max_speed_mps", "energy_J", "finished"};
  return spec;
}

std::unique_ptr<Metric> make_travel(const ParameterSet&, const MetricContext&) {
  return std::make_unique<Travel>();
}

}  // namespace vinerow
