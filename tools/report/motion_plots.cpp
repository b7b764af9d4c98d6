#include "tools/report/motion_plots.h"

#include <cmath>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"

namespace vinerow::tools::report {
namespace {

std::vector<double> in_degrees(std::vector<double> angles) {
  for (double& angle : angles) angle = deg_from_rad(angle);
  return angles;
}

/// Largest value that the run's criteria allow for a metric of the vehicle; NaN without a
/// criterion.
double allowed(const RunFolder& run, const VehicleLog& vehicle, const std::string& metric) {
  double limit = kNone;
  for (const Json& criterion : list_in(run.summary, "criteria")) {
    if (criterion.value("metric", "") == vehicle.name + "." + metric &&
        criterion.value("kind", "") == "max") {
      limit = number_of(criterion.value("limit", Json()));
    }
  }
  return limit;
}

/// Adds a limit on both sides of zero.
void add_limits(double limit, const std::string& label, LinePlot& plot) {
  if (!std::isfinite(limit) || limit <= 0.0) return;
  plot.limits.push_back({limit, label});
  plot.limits.push_back({-limit, label});
}

/// Removes samples outside the track: references continue after the work is done.
void cut_to(const Track& track, LinePlot& plot) {
  for (PlotLine& line : plot.lines) {
    Samples kept;
    for (std::size_t i = 0; i < line.samples.size(); ++i) {
      const double t_s = line.samples.x[i];
      if (track.contains(t_s)) kept.add(t_s, line.samples.y[i]);
    }
    line.samples = std::move(kept);
  }
}

/// Angle in degrees from -180 to 180, with a gap where it wraps.
Samples wrapped(const Samples& turning) {
  Samples out;
  double before = kNone;
  for (std::size_t i = 0; i < turning.size(); ++i) {
    const double now = std::remainder(turning.y[i], 360.0);
    if (std::abs(now - before) > 180.0) out.add(turning.x[i], kNone);
    out.add(turning.x[i], now);
    before = now;
  }
  return out;
}

double ground_m(const RunFolder& run, const Eigen::Vector3d& p) {
  return run.world && run.world->terrain ? run.world->terrain->height_m(p.x(), p.y()) : kNone;
}

/// Number of a fixed wing's reference, with a gap while the vehicle waits.
Samples in_flight(const VehicleLog& vehicle, double AirReference::*number) {
  Samples samples;
  for (std::size_t i = 0; i < vehicle.air_reference.times.size(); ++i) {
    const AirReference& reference = vehicle.air_reference.values[i];
    const bool flies = reference.phase != AirReference::Phase::kWait;
    samples.add(vehicle.air_reference.times[i].s(), flies ? reference.*number : kNone);
  }
  return samples;
}

/// Height of a rotorcraft above the ground below it.
LinePlot height_above_ground(const RunFolder& run, const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Height above the ground", "height, m");
  plot.caption =
      "Flown height (line) and reference (dashed), both above the true ground below. As paper A, "
      "figures 20 b and 21 a.";
  plot.min_span = 0.1;
  Samples wanted, flown;
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {
    flown.add(track.t_s[i], track.p_W[i].z() - ground_m(run, track.p_W[i]));
  }
  for (std::size_t i = 0; i < vehicle.reference.t_s.size(); ++i) {
    const Eigen::Vector3d& p = vehicle.reference.p_W[i];
    wanted.add(vehicle.reference.t_s[i], p.z() - ground_m(run, p));
  }
  plot.lines = {{"flown", std::move(flown), vehicle.style},
                {"reference", std::move(wanted), "ref"}};
  return plot;
}

/// Altitude of a fixed wing over the terrain.
LinePlot altitude(const RunFolder& run, const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Altitude h", "height over the map's origin, m");
  plot.caption =
      "Flown altitude (line) and the guidance's reference (dashed), with the ground below. As "
      "paper A, figures 9 and 10.";
  plot.min_span = 1.0;
  Samples flown, ground;
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {
    flown.add(track.t_s[i], track.p_W[i].z());
    ground.add(track.t_s[i], ground_m(run, track.p_W[i]));
  }
  plot.lines = {{"flown", std::move(flown), vehicle.style},
                {"reference", in_flight(vehicle, &AirReference::height_m), "ref"},
                {"ground below", std::move(ground), "ground"}};
  return plot;
}

LinePlot heading(const VehicleLog& vehicle, const Track& track) {
  LinePlot plot =
      plot_of(track, vehicle.has_wings ? "Heading ψ" : "Heading", "from east, left positive, °");
  plot.caption = vehicle.has_wings ? "True heading (line) and reference (dashed). As paper A, "
                                     "figure 10."
                                   : "True heading (line) and planned heading at the nearest point "
                                     "(dashed). As paper A, figure 19 a.";
  plot.min_span = 1.0;
  plot.lines = {{"true", wrapped({track.t_s, in_degrees(track.heading_rad)}), vehicle.style}};
  Samples wanted;
  if (vehicle.has_wings) {
    wanted = in_flight(vehicle, &AirReference::heading_rad);
    double near_rad = track.heading_rad.empty() ? 0.0 : track.heading_rad.front();
    std::size_t at = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      while (at < track.t_s.size() && track.t_s[at] <= wanted.x[i])
        near_rad = track.heading_rad[at++];
      wanted.y[i] = deg_from_rad(next_to(wanted.y[i], near_rad));
    }
  } else {
    wanted = {track.t_s, in_degrees(track.plan_heading_rad)};
  }
  plot.lines.push_back({vehicle.has_wings ? "reference" : "plan", wrapped(wanted), "ref"});
  return plot;
}

LinePlot bank(const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Bank φ", "right wing down, °");
  plot.caption =
      "True bank (line) and the bank that the turn needs (dashed). As paper A, figure 10.";
  plot.min_span = 1.0;
  Samples flown, wanted;
  for (std::size_t i = 0; i < vehicle.truth.times.size(); ++i) {
    const double t_s = vehicle.truth.times[i].s();
    if (track.contains(t_s))
      flown.add(t_s, deg_from_rad(rpy_from_quaternion(vehicle.truth.values[i].X_WB.q).roll_rad));
  }
  for (std::size_t i = 0; i < vehicle.air_reference.times.size(); ++i) {
    wanted.add(vehicle.air_reference.times[i].s(),
               deg_from_rad(vehicle.air_reference.values[i].bank_rad));
  }
  plot.lines = {{"true", std::move(flown), vehicle.style}, {"reference", std::move(wanted), "ref"}};
  return plot;
}

/// Airspeed of a fixed wing, the speed that its guidance commands.
LinePlot airspeed(const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Airspeed", "true airspeed, m/s");
  plot.caption =
      "True airspeed (line) and the guidance's reference (dashed), with the speed over "
      "ground, which differs by the wind.";
  plot.min_span = 0.1;
  plot.lines = {{"over ground", {track.t_s, track.speed_mps}, "ground"}};
  if (const Columns* air = vehicle.find("air"); air && air->find("airspeed_mps")) {
    plot.lines.push_back({"airspeed", {air->t_s, *air->find("airspeed_mps")}, vehicle.style});
  }
  plot.lines.push_back({"reference", in_flight(vehicle, &AirReference::airspeed_mps), "ref"});
  return plot;
}

LinePlot speed(const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Speed", "speed over ground, m/s");
  plot.caption = "True speed over ground";
  plot.min_span = 0.1;
  plot.lines = {{"true", {track.t_s, track.speed_mps}, vehicle.style}};
  Samples wanted;
  if (!vehicle.reference.t_s.empty()) {
    wanted = {vehicle.reference.t_s, vehicle.reference.speed_mps};
  } else if (!vehicle.command.empty()) {
    for (std::size_t i = 0; i < vehicle.command.times.size(); ++i) {
      wanted.add(vehicle.command.times[i].s(), std::abs(vehicle.command.values[i].v_mps));
    }
  }
  if (wanted.size() > 0) {
    plot.caption += " (line) and reference (dashed)";
    plot.lines.push_back({"reference", std::move(wanted), "ref"});
  }
  plot.caption += ".";
  return plot;
}

LinePlot lateral_error(const RunFolder& run, const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Lateral distance from the plan", "left of the plan, m");
  plot.caption =
      "True horizontal distance from the planned path, left positive. As paper B, figure 14.";
  plot.min_span = 0.01;
  if (vehicle.has_wings) {
    plot.caption =
        "True horizontal distance from the lane, left positive, while the vehicle flies "
        "straight on a lane.";
  }
  plot.lines = {{"true", {track.t_s, track.lateral_m}, vehicle.style}};
  for (const char* metric :
       {"cross_track_max_m", "straight_cross_track_max_m", "deviation_max_m"}) {
    add_limits(allowed(run, vehicle, metric), "allowed at most", plot);
  }
  return plot;
}

LinePlot height_error(const RunFolder& run, const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Vertical distance from the plan", "above the plan, m");
  plot.caption = "True height minus planned height at the nearest point, on rows or lanes.";
  plot.min_span = 0.01;
  plot.lines = {{"true", {track.t_s, track.height_error_m}, vehicle.style}};
  for (const char* metric : {"altitude_error_max_m", "height_error_max_m"}) {
    add_limits(allowed(run, vehicle, metric), "allowed at most", plot);
  }
  return plot;
}

}  // namespace

std::vector<LinePlot> motion_plots(const RunFolder& run, const VehicleLog& vehicle,
                                   const Track& track) {
  if (track.empty()) return {};
  std::vector<LinePlot> plots = {lateral_error(run, vehicle, track)};
  if (vehicle.has_wings) {
    plots.push_back(altitude(run, vehicle, track));
  } else if (vehicle.flies) {
    plots.push_back(height_error(run, vehicle, track));
    plots.push_back(height_above_ground(run, vehicle, track));
  }
  plots.push_back(vehicle.has_wings ? airspeed(vehicle, track) : speed(vehicle, track));
  plots.push_back(heading(vehicle, track));
  if (vehicle.has_wings) plots.push_back(bank(vehicle, track));
  for (LinePlot& plot : plots) cut_to(track, plot);
  return plots;
}

}  // namespace vinerow::tools::report
