#include "tools/vinerow/survey_task.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>

#include "controllers/planning/survey/survey.h"
#include "controllers/planning/survey/survey_params.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/geo/geo_features.h"
#include "engine/io/geo/raster.h"
#include "engine/math/angles.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::tools {
namespace {

double read_number(const std::string& name, const std::string& text) {
  try {
    std::size_t used = 0;
    const double value = std::stod(text, &used);
    if (used == text.size()) return value;
  } catch (const std::exception&) {  // not a number, or too large
  }
  throw ConfigError(fmt::format("--{}: '{}' is not a number", name, text));
}

std::int64_t read_whole_number(const std::string& name, const std::string& text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size()) return value;
  throw ConfigError(fmt::format("--{}: '{}' is not a whole number", name, text));
}

/// Copies values of the command line into the planner's parameters, with the checks for files.
void set_values(const std::map<std::string, std::string>& values, ParameterSet& parameters) {
  for (const ParameterSpec& spec : controllers::survey_spec().parameters) {
    const auto found = values.find(spec.name);
    if (found == values.end() || found->second.empty()) continue;
    const std::string& text = found->second;
    switch (spec.kind) {
      case ParameterKind::kNumber:
        parameters.set(spec.name, read_number(spec.name, text));
        break;
      case ParameterKind::kInteger:
        parameters.set(spec.name, read_whole_number(spec.name, text));
        break;
      case ParameterKind::kBoolean:
        if (text != "true" && text != "false") {
          throw ConfigError(fmt::format("--{}: '{}' must be true or false", spec.name, text));
        }
        parameters.set(spec.name, text == "true");
        break;
      default:
        parameters.set(spec.name, text);
    }
  }
}

/// Origin from the command line ("--origin 44.7,8.03") or from the polygon's first corner.
GeoOrigin find_survey_origin(const SurveyArguments& arguments) {
  GeoOrigin origin;
  if (!arguments.origin.empty()) {
    if (arguments.origin.size() > 3 || arguments.origin.size() < 2) {
      throw ConfigError(
          "--origin: must be latitude,longitude in degrees, or with an altitude in m");
    }
    origin.latitude_rad = rad_from_deg(arguments.origin[0]);
    origin.longitude_rad = rad_from_deg(arguments.origin[1]);
    if (arguments.origin.size() > 2) origin.altitude_m = arguments.origin[2];
    return origin;
  }
  if (arguments.polygon.extension() == ".csv") {
    throw ConfigError(fmt::format(
        "'{}' is in metres: give the position of its (0, 0) with --origin latitude,longitude",
        arguments.polygon.string()));
  }
  for (const io::GeoFeature& feature : io::read_features(arguments.polygon)) {
    if (feature.kind != io::GeometryKind::kPolygon) continue;
    origin.latitude_rad = feature.points.front().latitude_rad;
    origin.longitude_rad = feature.points.front().longitude_rad;
    break;
  }
  return origin;
}

/// Rejects a first corner outside the terrain and suggests swapped coordinates as the cause.
void refuse_swapped_corner(const SurveyArguments& arguments, const io::ElevationLookup& lookup) {
  if (arguments.polygon.extension() == ".csv") return;  // in metres
  for (const io::GeoFeature& feature : io::read_features(arguments.polygon)) {
    if (feature.kind != io::GeometryKind::kPolygon) continue;
    for (std::size_t i = 0; i < feature.points.size(); ++i) {
      const double latitude_rad = feature.points[i].latitude_rad;
      const double longitude_rad = feature.points[i].longitude_rad;
      if (lookup.height_m(latitude_rad, longitude_rad)) continue;
      const bool is_swapped =
          std::abs(longitude_rad) <= 0.5 * kPi && lookup.height_m(longitude_rad, latitude_rad);
      if (!is_swapped) continue;
      throw ConfigError(
          fmt::format("--polygon: point {} of '{}' at latitude {:.6f} deg, longitude {:.6f} deg "
                      "is outside the terrain of '{}'; are latitude and longitude swapped?",
                      i + 1, arguments.polygon.string(), deg_from_rad(latitude_rad),
                      deg_from_rad(longitude_rad), arguments.dem.string()));
    }
    return;
  }
}

/// Ground height: flat, or from an elevation model.
controllers::GroundHeight find_ground(const SurveyArguments& arguments, GeoOrigin& origin) {
  if (arguments.dem.empty()) return controllers::make_ground(nullptr, 0.0);
  const auto lookup =
      std::make_shared<io::ElevationLookup>(io::read_elevation(arguments.dem, arguments.crs));
  refuse_swapped_corner(arguments, *lookup);
  if (arguments.origin.size() < 3) {  // W's zero is the ground at the origin
    origin.altitude_m = lookup->height_m(origin.latitude_rad, origin.longitude_rad).value_or(0.0);
  }
  const auto frame = std::make_shared<LocalFrame>(origin);
  return [lookup, frame](const Eigen::Vector2d& p) -> std::optional<double> {
    const Geodetic place = frame->to_geodetic({p.x(), p.y(), 0.0});
    const auto height_m = lookup->height_m(place.latitude_rad, place.longitude_rad);
    if (!height_m) return std::nullopt;
    return *height_m - place.altitude_m;
  };
}

}  // namespace

SurveyTask task_of_polygon(const SurveyArguments& arguments) {
  if (!std::filesystem::exists(arguments.polygon)) {
    throw ConfigError(fmt::format("--polygon: '{}' does not exist", arguments.polygon.string()));
  }
  SurveyTask task;
  task.title = arguments.polygon.stem().string();
  task.origin = find_survey_origin(arguments);
  task.ground = find_ground(arguments, task.origin);
  ParameterSet parameters(controllers::survey_spec().parameters, "survey");
  parameters.set("polygon_file", arguments.polygon.string());
  set_values(arguments.values, parameters);
  PlannerContext context;
  context.origin = task.origin;
  task.request = controllers::read_survey_request(parameters, context, "survey");
  // Without a start: the first corner, heading away from the area.
  Eigen::Vector2d start = task.request.polygon_W.front(), middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : task.request.polygon_W) {
    middle += p / static_cast<double>(task.request.polygon_W.size());
  }
  double yaw_rad = std::atan2(start.y() - middle.y(), start.x() - middle.x());
  if (!arguments.start.empty()) {
    if (arguments.start.size() != 2) throw ConfigError("--start: must be x,y in metres");
    start = {arguments.start[0], arguments.start[1]};
  }
  if (!start.allFinite()) throw ConfigError("--start: must be finite");
  if (arguments.heading_deg) {
    if (!std::isfinite(*arguments.heading_deg)) throw ConfigError("--heading: must be finite");
    yaw_rad = rad_from_deg(90.0 - *arguments.heading_deg);
  }
  const auto ground_m = task.ground(start);
  if (!ground_m) {
    // If the polygon is outside too, its own message is clearer.
    for (const Eigen::Vector2d& p : task.request.polygon_W) {
      if (!task.ground(p)) return task;
    }
    throw ConfigError(fmt::format("--start: ({:.1f}, {:.1f}) is outside the terrain of '{}'",
                                  start.x(), start.y(), arguments.dem.string()));
  }
  task.start_W = {quaternion_from_rpy({0, 0, yaw_rad}), {start.x(), start.y(), *ground_m}};
  return task;
}

namespace {

const scenario::VehicleConfig& find_vehicle(const scenario::Scenario& scenario,
                                            const SurveyArguments& arguments) {
  const std::string file = arguments.scenario.file.string();
  const scenario::VehicleConfig* found = nullptr;
  for (const scenario::VehicleConfig& vehicle : scenario.vehicles) {
    const bool surveys = vehicle.planner && vehicle.planner->type == "survey";
    if (!arguments.vehicle.empty() && vehicle.name == arguments.vehicle) {
      if (surveys) return vehicle;
      throw ConfigError(fmt::format("{}: vehicle '{}' has {}, not the planner 'survey'", file,
                                    vehicle.name,
                                    vehicle.planner ? "the planner '" + vehicle.planner->type + "'"
                                                    : std::string("no planner")));
    }
    if (arguments.vehicle.empty() && surveys && found == nullptr) found = &vehicle;
  }
  if (found != nullptr) return *found;
  throw ConfigError(arguments.vehicle.empty()
                        ? fmt::format("{}: no vehicle has the planner 'survey'", file)
                        : fmt::format("{}: there is no vehicle '{}'", file, arguments.vehicle));
}

/// The simulation must outlive the task, which uses its ground.
}  // namespace

SurveyTask task_of_scenario(const SurveyArguments& arguments, const scenario::Scenario& scenario,
                            Simulation& simulation) {
  const scenario::VehicleConfig& config = find_vehicle(scenario, arguments);
  SurveyTask task;
  task.title = scenario.name;
  task.origin = simulation.world().origin;
  for (const auto& runtime : simulation.vehicles()) {
    if (runtime->name() != config.name) continue;
    Odometry truth;
    runtime->vehicle().read_truth(truth);
    task.start_W = truth.X_WB;
    ParameterSet parameters = config.planner->parameters;
    set_values(arguments.values, parameters);
    PlannerContext context;
    context.vehicle_description = &runtime->vehicle().description();
    context.map = &*simulation.world().rows;
    context.scene = &simulation.physics().scene();
    context.origin = task.origin;
    context.gravity_mps2 = scenario.gravity_mps2;
    task.request =
        controllers::read_survey_request(parameters, context, config.name + ".planner (survey)");
    task.ground = controllers::make_ground(context.scene, 0.0);
  }
  return task;
}

}  // namespace vinerow::tools
