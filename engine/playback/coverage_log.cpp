#include "engine/playback/coverage_log.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/api/map.h"
#include "engine/api/plan_stretch.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/metrics/survey_coverage.h"
#include "engine/playback/log_trace.h"
#include "engine/playback/run_frames.h"
#include "engine/sim/run_shelf.h"

namespace vinerow::playback {
namespace {

using nlohmann::ordered_json;

/// Smallest distance between two points of the track.
constexpr double kTrackPitch_m = 0.5;

/// Parameters of the scenario's metric `survey`; the defaults if it has no such metric.
ParameterSet survey_metric_parameters(const scenario::Scenario& scenario) {
  for (const scenario::NamedPart& metric : scenario.metrics) {
    if (metric.part.type == metrics::survey_coverage_spec().name) return metric.part.parameters;
  }
  return ParameterSet(metrics::survey_coverage_spec().parameters,
                      metrics::survey_coverage_spec().name);
}

std::vector<metrics::LaneShot> read_shots(const record::LogReader& log, const std::string& topic,
                                          const VehicleTrace& trace) {
  PlanStretch plan;
  std::size_t plans_seen = 0;
  std::vector<metrics::LaneShot> shots;
  log.read<CameraShot>(topic, [&](Time t, const CameraShot& shot) {
    while (plans_seen < trace.plan.times.size() && trace.plan.times[plans_seen] <= t) {
      plan.take_over(trace.plan.values[plans_seen++]);
    }
    metrics::LaneShot lane_shot{shot, 0};
    if (plan.has_plan() && !trace.truth.empty()) {
      const Odometry truth = trace.truth_at(t);
      lane_shot.lane = plan.lane(truth.X_WB.p, truth.X_WB.q * truth.v_WB_B);
    }
    shots.push_back(std::move(lane_shot));
  });
  return shots;
}

std::vector<Eigen::Vector2d> track_of(const VehicleTrace& trace) {
  std::vector<Eigen::Vector2d> track;
  for (const Odometry& truth : trace.truth.values) {
    const Eigen::Vector2d p = truth.X_WB.p.head<2>();
    if (track.empty() || (p - track.back()).norm() >= kTrackPitch_m) track.push_back(p);
  }
  return track;
}

/// Convex hull of all footprints.
Polygon hull_of(const std::vector<metrics::LaneShot>& shots) {
  Polygon corners;
  for (const metrics::LaneShot& lane_shot : shots) {
    const Polygon footprint = metrics::footprint_W(lane_shot.shot);
    corners.insert(corners.end(), footprint.begin(), footprint.end());
  }
  return convex_hull(std::move(corners));
}

ordered_json json_of(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json json_of(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

std::vector<SurveyCoverage> read_coverage(const std::filesystem::path& log,
                                          const Registry& registry, const CoverageChoice& choice) {
  const record::LogReader reader(log);
  const auto is_shots = [&](const record::ChannelInfo& channel) {
    const auto type = channel.metadata.find("vinerow_type");
    return type != channel.metadata.end() && type->second == CameraShot::kType &&
           channel.messages > 0 && !is_truth_of_reading(reader, channel.topic);
  };
  bool has_shots = false;
  for (const record::ChannelInfo& channel : reader.info().channels) {
    has_shots = has_shots || is_shots(channel);
  }
  if (!has_shots) return {};

  const scenario::Scenario scenario = scenario_of_log(log, registry);
  const ParameterSet parameters = survey_metric_parameters(scenario);
  metrics::CoverageOptions options = metrics::read_coverage_options(parameters);
  options.cell_m = choice.cell_m.value_or(options.cell_m);
  if (!choice.parcel_W.empty()) options.parcel_W = choice.parcel_W;
  const std::shared_ptr<const WorldModel> world = world_of(scenario, registry, choice.shelf.get());
  if (options.parcel_W.empty()) options.parcel_W = world->rows->boundary_W;

  std::vector<std::string> names;
  for (const scenario::VehicleConfig& vehicle : scenario.vehicles) names.push_back(vehicle.name);
  const LogTrace trace = read_trace(reader, names);
  std::vector<SurveyCoverage> all;
  for (const std::string& name : names) {
    const std::string prefix = "/" + name + "/";
    for (const record::ChannelInfo& channel : reader.info().channels) {
      if (!is_shots(channel) || !channel.topic.starts_with(prefix)) continue;
      SurveyCoverage one;
      one.scenario = scenario.name;
      one.vehicle = name;
      one.camera = channel.topic.substr(prefix.size());
      one.shots = read_shots(reader, channel.topic, trace.vehicles.at(name));
      one.track_W = track_of(trace.vehicles.at(name));
      for (const PlantRow& row : world->rows->rows) {
        for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
          one.rows.push_back({row.line_W[i].head<2>(), row.line_W[i + 1].head<2>()});
        }
      }
      one.options = options;
      if (one.options.parcel_W.empty()) one.options.parcel_W = hull_of(one.shots);
      one.map = metrics::map_coverage(one.shots, one.options);
      all.push_back(std::move(one));
    }
  }
  return all;
}

std::string coverage_json(const SurveyCoverage& coverage) {
  ordered_json numbers, parcel = ordered_json::array(), pictures = ordered_json::array();
  for (const ResultSpec& number : metrics::coverage_results()) {
    numbers[number.name] = json_of(coverage.map.numbers.at(number.name));
  }
  for (const Eigen::Vector2d& p : coverage.options.parcel_W) parcel.push_back({p.x(), p.y()});
  for (const metrics::LaneShot& lane_shot : coverage.shots) {
    const CameraShot& shot = lane_shot.shot;
    const Eigen::Quaterniond& q = shot.X_WS.q;
    ordered_json corners = nullptr;
    if (shot.on_ground) {
      corners = ordered_json::array();
      for (const Eigen::Vector3d& corner : shot.corners_W) corners.push_back(json_of(corner));
    }
    pictures.push_back({{"index", shot.index},
                        {"lane", lane_shot.lane},
                        {"position_m", json_of(shot.X_WS.p)},
                        {"attitude_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                        {"distance_m", shot.distance_m},
                        {"gsd_m", shot.gsd_m},
                        {"corners_m", corners}});
  }
  return ordered_json{{"scenario", coverage.scenario},
                      {"vehicle", coverage.vehicle},
                      {"camera", coverage.camera},
                      {"cell_m", coverage.options.cell_m},
                      {"wanted_overlap", coverage.options.wanted_overlap},
                      {"parcel_m", parcel},
                      {"numbers", numbers},
                      {"pictures", pictures}}
             .dump(1) +
         "\n";
}

}  // namespace vinerow::playback
