#include "engine/metrics/path_deviation.h"

#include <cmath>
#include <optional>
#include <set>

#include "engine/api/plan_stretch.h"
#include "engine/math/angles.h"
#include "engine/math/deviation.h"
#include "engine/metrics/spread.h"
#include "engine/metrics/tenths.h"

namespace vinerow::metrics {
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
    const double moved_m = before_ ? (truth.X_WB.p - *before_).norm() : 0.0;
    before_ = truth.X_WB.p;
    const PlanStretch::Place nearest = plan_.find(truth.X_WB.p);
    meter_->add(nearest.distance_m);
    if (!plan_.is_leg(nearest.segment)) {
      leave_leg();
      if (plan_.is_turn(nearest.segment)) {
        turns_.add(plan_.curve_distance_m(nearest, truth.X_WB.p.head<2>()));
      }
      return;
    }
    legs_.add(nearest.lateral_m);
    headings_.add(wrap_angle(yaw_from_quaternion(truth.X_WB.q) - segment_yaw_[nearest.segment]));
    pass_leg(nearest, moved_m);
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
    const std::vector<Eigen::Vector2d>& line = plan_.line().points();
    segment_yaw_.clear();
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d along = line[i + 1] - line[i];
      segment_yaw_.push_back(std::atan2(along.y(), along.x()));
    }
    segment_yaw_.push_back(segment_yaw_.back());
    find_legs();
    meter_.emplace();
  }

  /// Legs as they follow each other: segments of kind leg in one alley.
  void find_legs() {
    const std::vector<PathPoint>& points = plan_.points();
    const std::vector<Eigen::Vector2d>& line = plan_.line().points();
    legs_of_plan_.clear();
    leg_of_segment_.assign(points.size(), -1);
    at_leg_ = -1;
    s_m_.assign(1, 0.0);
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      s_m_.push_back(s_m_.back() + (line[i + 1] - line[i]).norm());
      const int alley = points[i].alley;
      if (!plan_.is_leg(static_cast<int>(i)) || alley < 0) continue;
      const bool goes_on = i > 0 && leg_of_segment_[i - 1] >= 0 && points[i - 1].alley == alley;
      if (!goes_on) legs_of_plan_.push_back({alley, s_m_[i], s_m_[i], {}});
      legs_of_plan_.back().end_m = s_m_.back();
      leg_of_segment_[i] = static_cast<int>(legs_of_plan_.size()) - 1;
    }
  }

  void pass_leg(const PlanStretch::Place& at, double moved_m) {
    const auto i = static_cast<std::size_t>(at.segment);
    const int index = leg_of_segment_[i];
    if (index != at_leg_) leave_leg();
    at_leg_ = index;
    if (index < 0) return;
    Leg& leg = legs_of_plan_[static_cast<std::size_t>(index)];
    const double length_m = leg.end_m - leg.begin_m;
    if (!(length_m > 0.0)) return;
    const double s_m = s_m_[i] + at.fraction * (s_m_[i + 1] - s_m_[i]);
    leg.passed.look((s_m - leg.begin_m) / length_m, moved_m / length_m);
    if (leg.passed.all()) alleys_.insert(leg.alley);
  }

  void leave_leg() {
    if (at_leg_ >= 0) legs_of_plan_[static_cast<std::size_t>(at_leg_)].passed.leave();
    at_leg_ = -1;
  }

  struct Leg {
    int alley;
    double begin_m, end_m;
    Tenths passed;
  };

  SignalReader<Odometry> truth_;
  PlanStretch plan_;
  std::optional<DeviationStatistics> meter_;
  std::vector<double> segment_yaw_;
  std::vector<double> s_m_;  ///< of the plan's points
  std::vector<Leg> legs_of_plan_;
  std::vector<int> leg_of_segment_;  ///< -1: none
  int at_leg_ = -1;
  std::optional<Eigen::Vector3d> before_;  ///< at the last tick
  Spread legs_, turns_, headings_;
  std::set<int> alleys_;
};

}  // namespace

const std::vector<MetricNumber>& path_deviation_numbers() {
  static const std::vector<MetricNumber> numbers = {
      from_zero("average_deviation_m"),      from_zero("deviation_max_m"),
      count_number("oscillation_count"),     from_zero("relative_accuracy_per_m"),
      from_zero("cross_track_rms_m"),        from_zero("cross_track_max_m"),
      zero_to(kPi, "heading_error_rms_rad"), count_number("leg_samples"),
      from_zero("turn_deviation_rms_m"),     from_zero("turn_deviation_max_m"),
      from_zero("planned_length_m"),         count_number("alleys_driven")};
  return numbers;
}

PartSpec path_deviation_spec() {
  PartSpec spec;
  spec.name = "path_deviation";
  spec.description =
      "Deviation from the plan: ATD, OF, RA of paper B (eq. 8), cross-track and heading error on "
      "the legs, deviation from the planned arcs in the turns";
  spec.reads = {"truth", "plan (optional)"};
  spec.writes = written(path_deviation_numbers());
  return spec;
}

std::unique_ptr<Metric> make_path_deviation(const ParameterSet&, const MetricContext&) {
  return std::make_unique<PathDeviation>();
}

}  // namespace vinerow::metrics
