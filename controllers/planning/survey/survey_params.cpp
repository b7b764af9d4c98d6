#include "controllers/planning/survey/survey_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/parts/paths/lift.h"
#include "controllers/parts/paths/pose2.h"
#include "controllers/planning/survey/survey_lanes.h"
#include "engine/api/file_shelf.h"
#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/io/geo/area_file.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kUsualBank_deg = 35.0;
// Default descent speed of both common autopilots on missions (MPC_Z_V_AUTO_DN, WPNAV_SPEED_DN);
// they climb faster.
constexpr double kRotorDescent_mps = 1.5;

/// The area as given in the scenario.
struct SurveyAreaParams {
  std::vector<double> x_m, y_m;  ///< of the corners
  std::string file;              ///< instead of the lists; empty: none
  double margin_m = 0.0;
};

std::string find_fault_in_area(const SurveyAreaParams& p) {
  if (p.x_m.size() != p.y_m.size()) {
    return fmt::format("polygon_x_m has {} numbers and polygon_y_m {}, must be as many",
                       p.x_m.size(), p.y_m.size());
  }
  if (!p.file.empty() && !p.x_m.empty()) {
    return "give the polygon by polygon_file or by polygon_x_m and polygon_y_m, not by both";
  }
  return "";
}

const ParameterTable<SurveyAreaParams>& survey_area_table() {
  using P = SurveyAreaParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers(
              "polygon_x_m", "m", &P::x_m, kAnyNumber,
              "x (east) of the corners of the area; without any polygon, the map's parcel boundary")
          .numbers("polygon_y_m", "m", &P::y_m, kAnyNumber, "y (north), as many as polygon_x_m")
          .path("polygon_file", &P::file,
                "the area as a GeoJSON file with one polygon in latitude and longitude, or as a "
                "CSV file with a line x,y in metres for each corner")
          .number("margin_m", "m", &P::margin_m, between(-1e4, 1e4),
                  "distance by which the area is enlarged on every side")
          .rule(find_fault_in_area);
  return table;
}

/// The flight as given in the scenario; absent values follow from the others and from the vehicle.
struct SurveyFlightParams {
  SurveyRequest request;
  std::optional<double> height_m, gsd_m, max_slope;
  double wind_speed_mps = 0.0;
  double wind_from_deg = 0.0;              ///< clockwise from north
  std::optional<double> lane_bearing_deg;  ///< clockwise from north
  std::optional<double> bank_rad, stall_speed_mps;
  std::optional<bool> rotorcraft;
};

const ParameterTable<SurveyFlightParams>& survey_flight_table() {
  using P = SurveyFlightParams;
  using R = SurveyRequest;
  const auto request = [](auto member) { return inside(&P::request, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("height_m", "m", &P::height_m, above(0.0, 1e4),
                  "height above the ground; 150 m if gsd_m is not given either")
          .number("gsd_m", "m", &P::gsd_m, above(0.0, 10.0),
                  "ground sampling distance, which determines the height instead")
          .number("forward_overlap", "", request(&R::forward_overlap), between(0.0, 0.98),
                  "overlap of consecutive pictures of a lane; fraction, 0 to 1")
          .number("side_overlap", "", request(&R::side_overlap), between(0.0, 0.98),
                  "minimum overlap of the pictures of neighbouring lanes; fraction, 0 to 1")
          .number("speed_mps", "m/s", request(&R::speed_mps), kPositive,
                  "airspeed; of rotorcraft speed over ground")
          .number("wind_speed_mps", "m/s", &P::wind_speed_mps, between(0.0, 100.0),
                  "expected mean wind, which changes the speed on lanes and widens turns")
          .number("wind_from_deg", "deg", &P::wind_from_deg, between(-360.0, 360.0),
                  "direction from which the wind blows, clockwise from north")
          .number("lane_bearing_deg", "deg", &P::lane_bearing_deg, between(-360.0, 360.0),
                  "bearing of the lanes, clockwise from north; absent: that with the fewest lanes")
          .choice("order", request(&R::order),
                  {{"best", R::Order::kBest}, {"snake", R::Order::kSnake}},
                  "best: every lane once with the least extra distance, skipping lanes if turns do "
                  "not fit between neighbours; snake: neighbour after neighbour")
          .degrees("bank_deg", &P::bank_rad, between(1.0, 75.0),
                   "bank in turns; absent: 35 deg, or the vehicle's maximum")
          .number("stall_speed_mps", "m/s", &P::stall_speed_mps, between(0.0, 100.0),
                  "minimum speed; absent: the vehicle's, if it has one")
          .number("ramp_error_m", "m", request(&R::ramp_error_m), kPositive,
                  "largest deviation of straight ramps between waypoints from the wanted height "
                  "above the terrain")
          .number("max_slope", "", &P::max_slope, between(0.001, 1.0),
                  "maximum slope of the path, rise over run; above steeper terrain the flight "
                  "stays higher; absent: 0.12, for rotorcraft a descent of 1.5 m/s")
          .boolean("rotorcraft", &P::rotorcraft,
                   "true: plan for a multirotor: vertical climb to the first height, corners on "
                   "the spot, speed_mps over ground; false: for a fixed wing; absent: as the "
                   "vehicle, fixed wing without a vehicle")
          .number(
              "run_out_m", "m", request(&R::run_out_m), between(0.0, 1e4),
              "straight beyond a lane's pictures before and after turns; absent: turn radius plus "
              "two seconds of flight; for rotorcraft the distance to reach the speed at 2 m/s2")
          .number("end_margin", "", request(&R::end_margin), between(0.0, 2.0),
                  "distance of a lane's pictures beyond the area, as a fraction of their length; "
                  "0.5: the ends are seen as often as the middle")
          .number("edge_margin", "", request(&R::edge_margin), between(-0.5, 0.5),
                  "distance of the outermost lanes beyond the area, as a fraction of a picture's "
                  "width; -0.5: pictures end at the edges")
          .boolean("return_home", request(&R::returns), "fly back to the start after the last lane")
          .rule([](const P& p) -> std::string {
            return p.height_m && p.gsd_m ? "give height_m or gsd_m, not both" : "";
          });
  return table;
}

Polygon find_polygon(const SurveyAreaParams& params, const PlannerContext& context,
                     const std::string& who) {
  const std::vector<double>&x = params.x_m, &y = params.y_m;
  Polygon polygon;
  if (!params.file.empty()) {
    const GeoOrigin& origin = context.origin;
    const std::string key = fmt::format("{} {} {} {}", file_mark(params.file), origin.latitude_rad,
                                        origin.longitude_rad, origin.altitude_m);
    polygon =
        *keep<Polygon>(context.shelf, key, [&] { return io::read_area(params.file, origin); });
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
  polygon = without_repeats(polygon);
  const double margin_m = params.margin_m;
  if (margin_m == 0.0 || io::find_area_fault(polygon)) return polygon;
  const Polygon wide = widen(polygon, margin_m);
  if (wide.empty()) {
    throw ConfigError(
        fmt::format("{}: with margin_m = {:g} m an edge of the polygon vanishes; give the enlarged "
                    "polygon itself",
                    who, margin_m));
  }
  if (const auto fault = io::find_area_fault(wide)) {
    throw ConfigError(fmt::format("{}: with margin_m = {:g} m the polygon cannot be surveyed: {}",
                                  who, margin_m, *fault));
  }
  return wide;
}

double find_bank_rad(const std::optional<double>& wanted_rad, const VehicleDescription* vehicle,
                     const std::string& who) {
  double max_rad = 0.5 * kPi;
  if (vehicle != nullptr && vehicle->fixed_wing) {
    max_rad = vehicle->need_positive(vehicle->fixed_wing->max_bank_rad, "max_bank_rad", who);
  }
  if (!wanted_rad) return std::min(rad_from_deg(kUsualBank_deg), max_rad);
  if (*wanted_rad > max_rad + 1e-9) {
    throw ConfigError(
        fmt::format("{}: bank_deg = {:g} deg, but vehicle type '{}' banks {:.1f} deg at "
                    "most",
                    who, deg_from_rad(*wanted_rad), vehicle->type, deg_from_rad(max_rad)));
  }
  return *wanted_rad;
}

}  // namespace

void add_survey_parameters(PartSpec& spec) {
  survey_area_table().add_to(spec);
  for (ParameterSpec& parameter : survey_camera_parameters()) {
    spec.parameters.push_back(std::move(parameter));
  }
  survey_flight_table().add_to(spec);
}

SurveyRequest read_survey_request(const ParameterSet& parameters, const PlannerContext& context,
                                  const std::string& who) {
  const VehicleDescription* vehicle = context.vehicle_description;
  const SurveyFlightParams flight = survey_flight_table().read(parameters, who);
  SurveyRequest request = flight.request;
  request.polygon_W = find_polygon(survey_area_table().read(parameters, who), context, who);
  request.camera = read_survey_camera(parameters);
  request.rotorcraft = flight.rotorcraft.value_or(vehicle != nullptr && vehicle->rotorcraft);
  if (flight.gsd_m) {
    request.height_m = request.camera.height_for_gsd_m(*flight.gsd_m);
  } else if (flight.height_m) {
    request.height_m = *flight.height_m;
  }
  // Wind blows in the direction opposite to its bearing, which is clockwise from north.
  const double to_rad = rad_from_deg(270.0 - flight.wind_from_deg);
  // A multirotor holds its speed over ground: wind tilts it but changes neither times nor turns.
  if (!request.rotorcraft) request.wind_W = flight.wind_speed_mps * direction(to_rad);
  if (flight.max_slope) {
    request.max_slope = *flight.max_slope;
  } else if (request.rotorcraft) {
    request.max_slope = std::min(1.0, kRotorDescent_mps / request.speed_mps);
  }
  if (flight.lane_bearing_deg) {
    request.lane_yaw_rad = wrap_angle(rad_from_deg(90.0 - *flight.lane_bearing_deg));
  }
  request.bank_rad = find_bank_rad(flight.bank_rad, vehicle, who);
  if (vehicle != nullptr) request.min_radius_m = vehicle->min_turning_radius_m.value_or(0.0);
  if (flight.stall_speed_mps) {
    request.stall_speed_mps = *flight.stall_speed_mps;
  } else if (vehicle != nullptr && vehicle->fixed_wing) {
    request.stall_speed_mps = vehicle->fixed_wing->stall_speed_mps;
  }
  request.gravity_mps2 = context.gravity_mps2;
  if (request.ramp_error_m >= 0.5 * request.height_m) {
    throw ConfigError(
        fmt::format("{}: ramp_error_m = {:g} m must be less than half the height of "
                    "{:.1f} m",
                    who, request.ramp_error_m, request.height_m));
  }
  const bool is_sound = !io::find_area_fault(request.polygon_W);
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

}  // namespace vinerow::controllers
