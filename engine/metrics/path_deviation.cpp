#include "engine/metrics/path_deviation.h"

#include <cmath>
#include <optional>
#include <set>

#include "engine/api/plan_stretch.h"
#include "engine/math/angles.h"
#include "engine/math/deviation.h"
#include "engine/metrics/spread.h"
#include "engine/metrics/tenths.h"

// Derivation. The plan is the polyline of its points p_0 .. p_n in the plane. At each tick the true
// position p has a nearest place on it: segment i, fraction f and distance d (`nearest`).
//
//   ATD = mean of d, OF = number of local maxima of d, RA = 1 / (ATD OF)  (paper B, eq. 8), over
//     all ticks; for a flight, d is the distance in space
//   lateral error e: signed distance from segment i in the plane, left positive, on legs only
//   heading error: wrap(yaw - psi_i), psi_i = atan2(y_{i+1} - y_i, x_{i+1} - x_i), on legs only
//   turn deviation: distance from the exact arc in place of the chord, in turns only
//   distance along the polyline: s = s_i + f (s_{i+1} - s_i), s_{i+1} = s_i + |p_{i+1} - p_i|
//
// A leg of the plan is a run of leg segments in one alley, from start_m to end_m. The vehicle is at
// (s - start_m) / (end_m - start_m) of it. An alley counts as driven when all tenths of a leg of it
// were passed (tenths.h). A place outside the legs ends the current pass, so that a vehicle that
// leaves a leg and comes back elsewhere has not passed the part between.

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
    // ATD, OF and RA: everywhere.
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
    // One value for each point, so that the index of the last point is valid too.
    segment_yaw_.push_back(segment_yaw_.back());
    find_legs();
    meter_.emplace();
  }

  /// Finds the legs: runs of segments of kind leg in one alley.
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
    const double length_m = leg.end_m - leg.start_m;
    if (!(length_m > 0.0)) return;
    // s = s_i + f (s_{i+1} - s_i)
    const double s_m = s_m_[i] + at.fraction * (s_m_[i + 1] - s_m_[i]);
    leg.passed.look((s_m - leg.start_m) / length_m, moved_m / length_m);
    if (leg.passed.all()) alleys_.insert(leg.alley);
  }

  void leave_leg() {
    if (at_leg_ >= 0) legs_of_plan_[static_cast<std::size_t>(at_leg_)].passed.leave();
    at_leg_ = -1;
  }

  struct Leg {
    int alley;
    double start_m, end_m;
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

const std::vector<ResultSpec>& path_deviation_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"average_deviation_m", "m", Range::from_zero(), "mean deviation from plan",
       "Mean distance from the planned polyline over the whole mission (ATD). The distance is "
       "horizontal on the ground and three-dimensional in flight.",
       "paper B, §3"},
      {"deviation_max_m", "m", Range::from_zero(), "max deviation from plan",
       "Largest distance from the planned polyline, turns included. The distance is horizontal on "
       "the ground and three-dimensional in flight.",
       ""},
      {"oscillation_count", "1", Range::count(), "oscillations about the plan",
       "Number of local maxima of the distance from the planned polyline with a prominence of at "
       "least 1e-6 m, ends excluded (OF).",
       "paper B, §3"},
      {"relative_accuracy_per_m", "1/m", Range::from_zero(), "relative accuracy",
       "RA = 1 / (ATD · OF). Read it together with ATD, the maximum deviation, OF and time, "
       "because coarse waypoints or a tiny lookahead inflate it.",
       "paper B, eq. 8"},
      {"cross_track_rms_m", "m", Range::from_zero(), "RMS lateral error on legs",
       "Root mean square of the horizontal distance from the planned leg while the vehicle is on a "
       "leg, between the plants.",
       ""},
      {"cross_track_max_m", "m", Range::from_zero(), "max lateral error on legs",
       "Largest horizontal distance from the planned leg while the vehicle is on a leg, between "
       "the plants.",
       ""},
      {"heading_error_rms_rad", "rad", Range::zero_to(kPi), "RMS heading error on legs",
       "Root mean square of the true yaw minus the direction of the planned leg.", ""},
      {"leg_samples", "1", Range::count(), "samples on legs",
       "Number of ticks of the metric in which the vehicle was on a leg.", ""},
      {"turn_deviation_rms_m", "m", Range::from_zero(), "RMS deviation in turns",
       "Root mean square of the distance from the planned arcs in the turns. The arcs are exact; "
       "the polyline is not (a chord of 0.25 m lies up to 4.4 mm inside an arc of radius 1.77 m).",
       ""},
      {"turn_deviation_max_m", "m", Range::from_zero(), "max deviation in turns",
       "Largest distance from the planned arcs in the turns.", ""},
      {"planned_length_m", "m", Range::from_zero(), "planned length", "Length of the planned path.",
       ""},
      {"alleys_driven", "1", Range::count(), "alleys driven",
       "Number of alleys whose planned leg was passed from start to end. The vehicle must have "
       "been in each tenth of the leg.",
       ""}};
  return results;
}

PartSpec path_deviation_spec() {
  PartSpec spec;
  spec.name = "path_deviation";
  spec.description =
      "Deviation from the plan: ATD, OF, RA of paper B (eq. 8), cross-track and heading error on "
      "the legs, deviation from the planned arcs in the turns";
  spec.reads = {"truth", "plan (optional)"};
  spec.results = path_deviation_results();
  return spec;
}

std::unique_ptr<Metric> make_path_deviation(const ParameterSet&, const MetricContext&) {
  return std::make_unique<PathDeviation>();
}

}  // namespace vinerow::metrics
