#include "engine/sim/metrics/path_deviation.h"

#include <cmath>
#include <optional>
#include <set>

#include "engine/math/angles.h"
#include "engine/math/deviation.h"
#include "engine/api/plan_stretch.h"
#include "engine/sim/metrics/spread.h"

namespace vinerow {
namespace {

class PathDeviation final : public Metric {
 public:
  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    plan_.connect(ports);
  }

  void step(Time) override {
    if (plan_.take_over()) take_over_plan();
    if (!meter_) return;
    const Odometry& truth = truth_.value();
    const PlanStretch::Place nearest = plan_.find(truth.X_WB.p);
    meter_->add(nearest.distance_m);
    if (!plan_.is_leg(nearest.segment)) {
      if (plan_.is_turn(nearest.segment)) {
        turns_.add(plan_.curve_distance_m(nearest, truth.X_WB.p.head<2>()));
      }
      return;
    }
    legs_.add(nearest.lateral_m);
    headings_.add(wrap_angle(yaw_from_quaternion(truth.X_WB.q) - segment_yaw_[nearest.segment]));
    const int alley = plan_.points()[nearest.segment].alley;
    if (alley >= 0 && leg_share_[nearest.segment] > 0.9) alleys_.insert(alley);
  }

  std::map<std::string, double> results() const override {
    return {
        {"average_deviation_m", meter_ ? meter_->average_m() : kNotMeasured},
        {"deviation_max_m", meter_ ? meter_->max_m() : kNotMeasured},
        {"oscillation_count", meter_ ? static_cast<double>(meter_->oscillations()) : kNotMeasured},
        {"relative_accuracy_per_m", meter_ ? meter_->relative_accuracy_per_m() : kNotMeasured},
        {"cross_track_rms_m", legs_.rms()},
        {"cross_track_max_m", legs_.max_or_nan()},
        {"heading_error_rms_rad", headings_.rms()},
        {"leg_samples", static_cast<double>(legs_.count)},
        {"turn_deviation_rms_m", turns_.rms()},
        {"turn_deviation_max_m", turns_.max_or_nan()},
        {"planned_length_m", plan_.has_plan() ? plan_.length_m() : kNotMeasured},
        {"alleys_driven", static_cast<double>(alleys_.size())}};
  }

 private:
  void take_over_plan() {
    const std::vector<PathPoint>& points = plan_.points();
    const std::vector<Eigen::Vector2d>& line = plan_.line().points();
    segment_yaw_.clear();
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d along = line[i + 1] - line[i];
      segment_yaw_.push_back(std::atan2(along.y(), along.x()));
    }
    segment_yaw_.push_back(segment_yaw_.back());
    // How far each point lies along its own alley, 0 to 1.
    leg_share_.assign(points.size(), 0.0);
    for (std::size_t begin = 0; begin < points.size();) {
      std::size_t end = begin;
      while (end < points.size() && points[end].alley == points[begin].alley) ++end;
      for (std::size_t i = begin; i < end; ++i) {
        leg_share_[i] = static_cast<double>(i - begin + 1) / static_cast<double>(end - begin);
      }
      begin = end;
    }
    meter_.emplace();
  }

  SignalReader<Odometry> truth_;
  PlanStretch plan_;
  std::optional<DeviationStatistics> meter_;
  std::vector<double> segment_yaw_;
  std::vector<double> leg_share_;
  Spread legs_, turns_, headings_;
  std::set<int> alleys_;
};

}  // namespace

PartSpec path_deviation_spec() {
  PartSpec spec;
  spec.name = "path_deviation";
  spec.description =
      "Deviation from the plan: ATD, OF, RA of paper B (eq. 8), cross-track and heading error on "
      "the legs, deviation from the planned arcs in the turns";
  spec.reads = {"truth", "plan (optional)"};
  spec.writes = {"average_deviation_m",     "deviation_max_m",   "oscillation_count",
                 "relative_accuracy_per_m", "cross_track_rms_m", "cross_track_max_m",
                 "heading_error_rms_rad",   "leg_samples",       "turn_deviation_rms_m",
                 "turn_deviation_max_m",    "planned_length_m",  "alleys_driven"};
  return spec;
}

std::unique_ptr<Metric> make_path_deviation(const ParameterSet&, const MetricContext&) {
  return std::make_unique<PathDeviation>();
}

}  // namespace vinerow
