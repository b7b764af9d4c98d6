#include "engine/metrics/survey_coverage.h"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/plan_stretch.h"
#include "engine/api/world_model.h"

namespace vinerow::metrics {
namespace {

/// Pictures for which memory is reserved. Chosen: more than an hour at one picture per second.
constexpr std::size_t kUsualShots = 4096;

struct SurveyMetricParams {
  std::optional<std::string> camera;
  std::optional<std::vector<double>> polygon_x_m;
  std::optional<std::vector<double>> polygon_y_m;
  double cell_m = 1.0;
  double wanted_overlap = 0.85;

  CoverageOptions options() const;
};

std::string find_fault_in_polygon(const SurveyMetricParams& p) {
  const std::size_t x = p.polygon_x_m ? p.polygon_x_m->size() : 0;
  const std::size_t y = p.polygon_y_m ? p.polygon_y_m->size() : 0;
  if (x == y) return "";
  return fmt::format("polygon_x_m has {} numbers and polygon_y_m has {}, must be as many", x, y);
}

const ParameterTable<SurveyMetricParams>& survey_metric_table() {
  using P = SurveyMetricParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("camera", &P::camera,
                "sensor that takes the pictures; default: the vehicle's survey camera if it has "
                "exactly one, else 'camera' of fixed-wing vehicles")
          .numbers("polygon_x_m", "m", &P::polygon_x_m, kAnyNumber,
                   "x (east) of the parcel's corners; default: the parcel of the world")
          .numbers("polygon_y_m", "m", &P::polygon_y_m, kAnyNumber,
                   "y (north) of the parcel's corners")
          .number("cell_m", "m", &P::cell_m, kPositive, "size of the cells that are counted")
          .number("wanted_overlap", "", &P::wanted_overlap, between(0.0, 1.0),
                  "forward overlap from which overlap_covered_share counts ground as covered")
          .rule(find_fault_in_polygon);
  return table;
}

CoverageOptions SurveyMetricParams::options() const {
  CoverageOptions options{{}, cell_m, wanted_overlap};
  for (std::size_t i = 0; polygon_x_m && i < polygon_x_m->size(); ++i) {
    options.parcel_W.emplace_back((*polygon_x_m)[i], (*polygon_y_m)[i]);
  }
  return options;
}

class SurveyMetric final : public Metric {
 public:
  SurveyMetric(const SurveyMetricParams& params, const MetricContext& context)
      : camera_(params.camera.value_or("camera")),
        is_wanted_(params.camera.has_value() ||
                   context.vehicle_description->fixed_wing.has_value()) {
    options_ = params.options();
    if (options_.parcel_W.empty() && context.world != nullptr) {
      options_.parcel_W = context.world->rows->boundary_W;
    }
    if (is_wanted_ && !options_.parcel_W.empty()) check_coverage_options(options_);
    if (is_wanted_) shots_.reserve(kUsualShots);
  }

  void connect(Ports& ports) override {
    if (!is_wanted_) return;
    truth_ = ports.read<Odometry>("truth");
    shot_ = ports.read_optional<CameraShot>(camera_);
    plan_.connect(ports);
  }

  void step(Time) override {
    if (!is_wanted_) return;
    plan_.take_over();
    if (!shot_.is_newer_than(shots_seen_)) return;
    const CameraShot& shot = shot_.value();
    const Odometry& truth = truth_.value();
    const int lane = plan_.has_plan() ? plan_.lane(truth.X_WB.p, truth.X_WB.q * truth.v_WB_B) : 0;
    shots_.push_back({shot, lane});
  }

  std::map<std::string, double> results() const override {
    if (!is_wanted_) return {};
    if (!options_.parcel_W.empty()) return map_coverage(shots_, options_).numbers;
    std::map<std::string, double> unknown;
    for (const ResultSpec& number : coverage_results()) {
      unknown[number.name] = std::numeric_limits<double>::quiet_NaN();
    }
    unknown["shots"] = static_cast<double>(shots_.size());
    return unknown;
  }

 private:
  std::string camera_;
  bool is_wanted_;
  CoverageOptions options_;
  std::vector<LaneShot> shots_;
  PlanStretch plan_;
  SignalReader<Odometry> truth_;
  SignalReader<CameraShot> shot_;
  std::uint64_t shots_seen_ = 0;
};

}  // namespace

PartSpec survey_coverage_spec() {
  PartSpec spec;
  spec.name = "survey";
  spec.description =
      "Vehicles with a survey camera: coverage of the parcel by their pictures, overlap and "
      "ground sampling distance (paper A, section 2)";
  survey_metric_table().add_to(spec);
  spec.reads = {"truth", "<camera> (optional)", "plan (optional)"};
  spec.results = coverage_results();
  return spec;
}

CoverageOptions read_coverage_options(const ParameterSet& parameters) {
  return survey_metric_table().read(parameters, "").options();
}

std::unique_ptr<Metric> make_survey_coverage(const ParameterSet& parameters,
                                             const MetricContext& context) {
  return std::make_unique<SurveyMetric>(survey_metric_table().read(parameters, ""), context);
}

}  // namespace vinerow::metrics
