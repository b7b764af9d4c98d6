#include "controllers/planning/survey_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/pose2.h"
#include "controllers/planning/lift.h"
#include "controllers/planning/survey_lanes.h"
#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

constexpr double kUsualBank_deg = 35.0;

Polygon2 read_polygon(const ParameterSet& parameters, const PlannerContext& context,
                      const std::string& who) {
  const auto& x = parameters.numbers("polygon_x_m");
  const auto& y = parameters.numbers("polygon_y_m");
  if (x.size() != y.size()) {
    throw ConfigError(
        fmt::format("{}: polygon_x_m has {} numbers and polygon_y_m {}, must be as many", who,
                    x.size(), y.size()));
  }
  const bool has_file = parameters.has("polygon_file");
  if (has_file && !x.empty()) {
    throw ConfigError(fmt::format(
        "{}: give the polygon by polygon_file or by polygon_x_m and polygon_y_m, not by "
        "both",
        who));
  }
  Polygon2 polygon;
  if (has_file) {
    polygon = read_survey_area(parameters.text("polygon_file"), context.origin);
  } else if (!x.empty()) {
    for (std::size_t i = 0; i < x.size(); ++i) polygon.emplace_back(x[i], y[i]);
  } else if (context.map != nullptr && !context.map->boundary_W.empty()) {
    polygon = context.map->boundary_W;
  } else {
    throw ConfigError(
        fmt::format("{}: the map has no parcel boundary, so polygon_x_m and polygon_y_m or "
                    "polygon_file must be "
                    "given",
                    who));
  }
  polygon = clean_polygon(polygon);
  const double margin_m = parameters.number("margin_m");
  if (margin_m == 0.0 || find_polygon_fault(polygon)) return polygon;
  const Polygon2 wide = widen_polygon(polygon, margin_m);
  if (wide.empty()) {
    throw ConfigError(fmt::format(
        "{}: moved by margin_m = {:g} m an edge of the polygon vanishes; give the polygon as it is "
        "wanted",
        who, margin_m));
  }
  if (const auto fault = find_polygon_fault(wide)) {
    throw ConfigError(
        fmt::format("{}: moved by margin_m = {:g} m the polygon cannot be surveyed: {}", who,
                    margin_m, *fault));
  }
  return wide;
}

double find_number(const VehicleDescription* vehicle, const char* name, double otherwise) {
  if (vehicle == nullptr) return otherwise;
  const auto found = vehicle->numbers.find(name);
  return found == vehicle->numbers.end() ? otherwise : found->second;
}

double read_bank_rad(const ParameterSet& parameters, const VehicleDescription* vehicle,
                     const std::string& who) {
  const double most_rad = find_number(vehicle, "max_bank_rad", 0.5 * kPi);
  if (!parameters.has("bank_deg")) return std::min(rad_from_deg(kUsualBank_deg), most_rad);
  const double bank_rad = rad_from_deg(parameters.number("bank_deg"));
  if (bank_rad > most_rad + 1e-9) {
    throw ConfigError(
        fmt::format("{}: bank_deg = {:g} deg, but vehicle type '{}' banks {:.1f} deg at "
                    "most",
                    who, deg_from_rad(bank_rad), vehicle->type, deg_from_rad(most_rad)));
  }
  return bank_rad;
}

}  // namespace

std::vector<ParameterSpec> survey_parameters() {
  std::vector<ParameterSpec> specs = {
      number_list_parameter("polygon_x_m", "m", {},
                            "x (east) of the corners of the area; without any polygon the parcel's "
                            "boundary of the map"),
      number_list_parameter("polygon_y_m", "m", {}, "y (north), as many as polygon_x_m"),
      path_parameter(
          "polygon_file",
          "the area as a GeoJSON file with one polygon in latitude and longitude, or as a "
          "CSV file with a line x,y in metres for each corner"),
      number_parameter("margin_m", "m", 0.0, -1e4, 1e4,
                       "by which the area is made larger on every side"),
  };
  for (ParameterSpec& spec : survey_camera_parameters()) specs.push_back(std::move(spec));
  const std::vector<ParameterSpec> flight = {
      optional(positive_parameter("height_m", "m", 150.0,
                                  "above the ground; 150 m where gsd_m is not given either")),
      optional(positive_parameter("gsd_m", "m", 0.1,
                                  "ground sampling distance, which gives the height instead")),
      number_parameter("forward_overlap", "", 0.85, 0.0, 0.98,
                       "of consecutive pictures of a lane, as a share"),
      number_parameter("side_overlap", "", 0.66, 0.0, 0.98,
                       "of the pictures of neighbouring lanes, at least, as a share"),
      positive_parameter("speed_mps", "m/s", 12.0, "through the air"),
      number_parameter("wind_speed_mps", "m/s", 0.0, 0.0, 100.0,
                       "mean wind to be reckoned with: it speeds lanes up, and widens turns"),
      number_parameter("wind_from_deg", "deg", 0.0, -360.0, 360.0,
                       "where it comes from, clockwise from north"),
      optional(number_parameter("lane_bearing_deg", "deg", 0.0, -360.0, 360.0,
                                "of the lanes, clockwise from north; absent: that of the fewest "
                                "lanes")),
      choice_parameter("order", "best", {"best", "snake"},
                       "best: every lane once with the least added way, skipping lanes where turns "
                       "do not fit between neighbours; snake: neighbour after neighbour"),
      optional(number_parameter("bank_deg", "deg", kUsualBank_deg, 1.0, 75.0,
                                "in turns; absent: 35 deg, or what the vehicle can")),
      optional(number_parameter("stall_speed_mps", "m/s", 0.0, 0.0, 100.0,
                                "slowest speed; absent: the vehicle's, where it tells one")),
      positive_parameter(
          "ramp_error_m", "m", 2.0,
          "by which straight ramps between waypoints may miss the wanted height above "
          "the terrain"),
      number_parameter("max_slope", "", 0.12, 0.001, 1.0,
                       "of the way, rise over run; above steeper terrain the flight stays higher"),
      optional(number_parameter("run_out_m", "m", 0.0, 0.0, 1e4,
                                "straight on beyond a lane's pictures before and after turns; "
                                "absent: turn radius and two seconds of flight")),
      number_parameter("end_margin", "", 0.5, 0.0, 2.0,
                       "by which the pictures of a lane go on beyond the area, as a share of their "
                       "length; 0.5: the ends are seen as often as the middle"),
      number_parameter(
          "edge_margin", "", 0.0, -0.5, 0.5,
          "by which the outermost lanes lie beyond the area, as a share of a picture's "
          "width; -0.5: pictures end at the edges"),
      boolean_parameter("return_home", true, "fly back to the start after the last lane"),
  };
  specs.insert(specs.end(), flight.begin(), flight.end());
  return specs;
}

SurveyRequest read_survey_request(const ParameterSet& parameters, const PlannerContext& context,
                                  const std::string& who) {
  const VehicleDescription* vehicle = context.vehicle_description;
  SurveyRequest request;
  request.polygon_W = read_polygon(parameters, context, who);
  request.camera = read_survey_camera(parameters);
  if (parameters.has("gsd_m")) {
    if (parameters.has("height_m")) {
      throw ConfigError(fmt::format("{}: give height_m or gsd_m, not both", who));
    }
    request.height_m = request.camera.height_for_gsd_m(parameters.number("gsd_m"));
  } else if (parameters.has("height_m")) {
    request.height_m = parameters.number("height_m");
  }
  request.forward_overlap = parameters.number("forward_overlap");
  request.side_overlap = parameters.number("side_overlap");
  request.speed_mps = parameters.number("speed_mps");
  // Blows to the opposite of where it comes from; bearings run clockwise from north.
  const double to_rad = rad_from_deg(270.0 - parameters.number("wind_from_deg"));
  request.wind_W = parameters.number("wind_speed_mps") * direction(to_rad);
  if (parameters.has("lane_bearing_deg")) {
    request.lane_yaw_rad = wrap_angle(rad_from_deg(90.0 - parameters.number("lane_bearing_deg")));
  }
  request.order = parameters.text("order") == "snake" ? SurveyRequest::Order::kSnake
                                                      : SurveyRequest::Order::kBest;
  request.bank_rad = read_bank_rad(parameters, vehicle, who);
  request.least_radius_m = find_number(vehicle, "min_turning_radius_m", 0.0);
  request.stall_speed_mps = parameters.has("stall_speed_mps")
                                ? parameters.number("stall_speed_mps")
                                : find_number(vehicle, "stall_speed_mps", 0.0);
  request.ramp_error_m = parameters.number("ramp_error_m");
  request.max_slope = parameters.number("max_slope");
  if (parameters.has("run_out_m")) request.run_out_m = parameters.number("run_out_m");
  request.end_margin = parameters.number("end_margin");
  request.edge_margin = parameters.number("edge_margin");
  request.returns = parameters.boolean("return_home");
  request.gravity_mps2 = context.gravity_mps2;
  if (request.ramp_error_m >= 0.5 * request.height_m) {
    throw ConfigError(
        fmt::format("{}: ramp_error_m = {:g} m must be less than half the height of "
                    "{:.1f} m",
                    who, request.ramp_error_m, request.height_m));
  }
  const bool is_sound = !find_polygon_fault(request.polygon_W);
  const double yaw_rad =
      request.lane_yaw_rad.value_or(is_sound ? choose_lane_yaw_rad(request.polygon_W) : 0.0);
  if (const auto fault = find_survey_fault(request, yaw_rad)) {
    throw ConfigError(fmt::format("{}: {}", who, *fault));
  }
  return request;
}

GroundHeight make_ground(const SceneQuery* scene, double flat_m) {
  return [scene, flat_m](const Eigen::Vector2d& p) -> std::optional<double> {
    if (scene == nullptr) return flat_m;
    return scene->ground_height_m(p.x(), p.y(), kAboveEverything_m);
  };
}

}  // namespace vinerow
