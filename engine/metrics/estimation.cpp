#include "engine/metrics/estimation.h"

#include <cmath>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/messages/flight.h"
#include "engine/api/observer.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/math/polyline.h"
#include "engine/metrics/estimate_judge.h"

namespace vinerow::metrics {
namespace {

struct EstimationParams {
  double from_s = 3.0;
  double row_reach_m = 5.0;
  double nees_margin = 0.2;
  std::vector<std::string> nis = {"gnss_position", "gnss_velocity", "barometer",
                                  "magnetometer",  "range",         "wheels"};
};

const ParameterTable<EstimationParams>& estimation_table() {
  using P = EstimationParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("from_s", "s", &P::from_s, between(0.0, 1e6),
                  "time before which samples are ignored")
          .number("row_reach_m", "m", &P::row_reach_m, between(0.0, 1e3),
                  "distance up to which the nearest row's direction is used, else the heading")
          .number("nees_margin", "", &P::nees_margin, between(0.0, 1.0),
                  "relative widening of the mean NEES's 95 % bounds; 0.2 tolerates standard "
                  "deviations that are wrong by a tenth")
          .texts("nis", &P::nis, "sources whose NIS is averaged");
  return table;
}

class Estimation final : public Metric {
 public:
  Estimation(const EstimationParams& params, const MetricContext& context)
      : from_(duration_from_s(params.from_s)),
        row_reach_m_(params.row_reach_m),
        is_rotorcraft_(context.vehicle_description != nullptr &&
                       context.vehicle_description->rotorcraft.has_value()) {
    judges_.emplace_back(EstimateJudge::Signals{}, EstimateJudge::Prefixes{}, params.nis,
                         params.nees_margin);
    for (const std::string& observer : context.observers) {
      const auto signals = observer_signals(observer);
      judges_.emplace_back(EstimateJudge::Signals{signals.at("estimate"), signals.at("ellipsoid"),
                                                  signals.at("estimator_state")},
                           EstimateJudge::Prefixes{observer + "_", observer + "_"}, params.nis,
                           params.nees_margin);
    }
    if (context.world == nullptr) return;
    for (const PlantRow& row : context.world->rows->rows) {
      if (row.line_W.size() >= 2) rows_.emplace_back(from_above(row.line_W));
    }
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    if (is_rotorcraft_) reference_ = ports.read_optional<ReferenceTrajectory>("reference");
    for (EstimateJudge& judge : judges_) judge.connect(ports);
  }

  void step(Time now) override {
    if (now - Time{} < from_ || has_landed()) return;
    const Odometry& truth = truth_.value();
    const double along_rad = direction_rad(truth);
    for (EstimateJudge& judge : judges_) judge.step(now, truth, along_rad);
  }

  std::map<std::string, double> results() const override {
    std::map<std::string, double> all;
    for (const EstimateJudge& judge : judges_) judge.write_results(all);
    return all;
  }

 private:
  bool has_landed() const {
    return reference_.has_value() && reference_.value().phase == ReferenceTrajectory::Phase::kDone;
  }

  /// Yaw of the nearest row, in the direction in which the vehicle looks; its own yaw if no row is
  /// near.
  double direction_rad(const Odometry& truth) const {
    const double yaw_rad = yaw_from_quaternion(truth.X_WB.q);
    double nearest_m = row_reach_m_, direction_rad = yaw_rad;
    for (const Polyline& row : rows_) {
      const Polyline::Nearest at = row.nearest(truth.X_WB.p.head<2>());
      if (at.distance_m > nearest_m) continue;
      const Eigen::Vector2d along = row.points()[at.segment + 1] - row.points()[at.segment];
      if (along.isZero(0.0)) continue;
      nearest_m = at.distance_m;
      direction_rad = std::atan2(along.y(), along.x());
      const bool looks_back = std::cos(direction_rad - yaw_rad) < 0.0;
      if (looks_back) direction_rad += kPi;
    }
    return direction_rad;
  }

  Duration from_;
  double row_reach_m_;
  bool is_rotorcraft_;
  std::vector<Polyline> rows_;
  std::vector<EstimateJudge> judges_;  ///< of the estimate, then of the observers
  SignalReader<Odometry> truth_;
  SignalReader<ReferenceTrajectory> reference_;
};

}  // namespace

const std::vector<ResultSpec>& estimation_results() {
  static const std::vector<ResultSpec> numbers = [] {
    std::vector<ResultSpec> all = judge_results({});
    for (ResultSpec& number : judge_results({"<observer>_", "<observer>_"})) {
      all.push_back(std::move(number));
    }
    return all;
  }();
  return numbers;
}

PartSpec estimation_spec() {
  PartSpec spec;
  spec.name = "estimation";
  spec.description =
      "Error of the estimate across and along the rows, and consistency of its covariance (NEES, "
      "NIS, containment)";
  estimation_table().add_to(spec);
  spec.reads = {"truth", "estimate (optional)", "ellipsoid (optional)",
                "estimator_state (optional)", "those of the observers"};
  spec.results = estimation_results();
  return spec;
}

std::unique_ptr<Metric> make_estimation(const ParameterSet& parameters,
                                        const MetricContext& context) {
  return std::make_unique<Estimation>(estimation_table().read(parameters, ""), context);
}

}  // namespace vinerow::metrics
