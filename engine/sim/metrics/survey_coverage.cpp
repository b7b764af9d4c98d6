#include "engine/sim/metrics/survey_coverage.h"

#include <fmt/format.h>

#include <limits>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/plan_stretch.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

/// Room for more than an hour at one picture per second; later ones take more memory.
constexpr std::size_t kUsualShots = 4096;

Polygon given_parcel(const ParameterSet& parameters) {
  const auto coordinates = [&](const char* name) {
    return parameters.has(name) ? parameters.numbers(name) : std::vector<double>{};
  };
  const std::vector<double> x = coordinates("polygon_x_m"), y = coordinates("polygon_y_m");
  if (x.size() != y.size()) {
    throw ConfigError(fmt::format(
        "polygon_x_m has {} numbers and polygon_y_m has {}, must be as many", x.size(), y.size()));
  }
  Polygon parcel;
  for (std::size_t i = 0; i < x.size(); ++i) parcel.emplace_back(x[i], y[i]);
  return parcel;
}

class SurveyMetric final : public Metric {
 public:
  SurveyMetric(const ParameterSet& parameters, const MetricContext& context)
      : camera_(parameters.has("camera") ? parameters.text("camera") : "camera"),
        is_wanted_(parameters.has("camera") ||
                   context.vehicle_description->numbers.contains("wing_span_m")) {
    options_ = read_coverage_options(parameters);
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
    for (const std::string& name : coverage_number_names()) {
      unknown[name] = std::numeric_limits<double>::quiet_NaN();
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
      "Of vehicles with wings: how much of the parcel their pictures cover, with what overlap and "
      "ground sampling distance (paper A, section 2)";
  spec.parameters = {
      optional(text_parameter("camera", "camera",
                              "sensor that takes the pictures; default: 'camera' of vehicles with "
                              "wings")),
      optional(number_list_parameter("polygon_x_m", "m", {},
                                     "east of the parcel's corners; default: the parcel of the "
                                     "world")),
      optional(number_list_parameter("polygon_y_m", "m", {}, "north of the parcel's corners")),
      positive_parameter("cell_m", "m", 1.0, "size of the cells that are counted"),
      number_parameter("wanted_overlap", "", 0.85, 0.0, 1.0,
                       "forward overlap with which ground counts as covered by overlap_covered_"
                       "share")};
  spec.reads = {"truth", "<camera> (optional)", "plan (optional)"};
  spec.writes = coverage_number_names();
  return spec;
}

CoverageOptions read_coverage_options(const ParameterSet& parameters) {
  return {given_parcel(parameters), parameters.number("cell_m"),
          parameters.number("wanted_overlap")};
}

std::unique_ptr<Metric> make_survey_coverage(const ParameterSet& parameters,
                                             const MetricContext& context) {
  return std::make_unique<SurveyMetric>(parameters, context);
}

}  // namespace vinerow
