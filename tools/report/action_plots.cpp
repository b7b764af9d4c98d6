#include "tools/report/action_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "tools/report/units.h"

namespace vinerow::tools::report {
namespace {

/// Below this speed slip is not plotted (docs/reference/metrics.md, slip_rms).
constexpr double kSlips_mps = 0.05;

/// Value as plotted: angles in degrees.
double shown(double value, const std::string& unit) {
  return unit == "rad" ? deg_from_rad(value) : value;
}

std::string shown_unit(const std::string& unit) {
  return unit == "rad" ? "°" : unit.empty() ? "share of full scale" : unit;
}

/// A column while the vehicle is at work.
Samples column(const Columns& columns, const std::string& name, const Track& track) {
  Samples samples;
  const std::vector<double>* values = columns.find(name);
  if (values == nullptr) return samples;
  const std::string unit = unit_of(name);
  for (std::size_t i = 0; i < columns.t_s.size(); ++i) {
    if (track.contains(columns.t_s[i])) samples.add(columns.t_s[i], shown((*values)[i], unit));
  }
  return samples;
}

void add_column(const Columns& columns, const std::string& name, const std::string& label,
                const std::string& style, const Track& track, LinePlot& plot) {
  Samples samples = column(columns, name, track);
  if (samples.size() > 0) plot.lines.push_back({label, std::move(samples), style});
}

std::string colour(std::size_t k) {
  return fmt::format("s{}", k % 8);
}

/// Title of the plot that shows the actuators of one unit.
std::string group_title(const VehicleLog& vehicle, const std::string& name,
                        const std::string& unit) {
  if (name.starts_with("rotor_")) return "Control actions: rotor speeds";
  if (name.starts_with("wheel_") && unit == "rad/s") return "Control actions: wheel speeds Ω";
  if (name.find("steer") != std::string::npos) return "Control actions: steering";
  if (vehicle.has_wings && unit == "rad") return "Control actions: elevons";
  return "Control actions: " + words_of(name);
}

std::string group_caption(const VehicleLog& vehicle) {
  if (vehicle.has_wings) return "Commands to the actuators. As paper A, figure 11.";
  if (vehicle.flies) return "Commands to the rotors. As paper A, figure 21 b.";
  return "Commands to the actuators. As paper A, figure 19 b.";
}

/// The `actuators` signal, one plot for each unit.
std::vector<LinePlot> actuator_plots(const VehicleLog& vehicle, const Track& track) {
  std::vector<LinePlot> plots;
  const Columns* columns = vehicle.find("actuators");
  if (columns == nullptr) return plots;
  std::vector<std::string> units;
  for (const std::string& name : columns->names) {
    const std::string unit = unit_of(name);
    auto found = std::find(units.begin(), units.end(), unit);
    if (found == units.end()) {
      units.push_back(unit);
      plots.push_back(plot_of(track, group_title(vehicle, name, unit), shown_unit(unit),
                              group_caption(vehicle)));
      found = units.end() - 1;
    }
    LinePlot& plot = plots[static_cast<std::size_t>(found - units.begin())];
    add_column(*columns, name, words_of(name), colour(plot.lines.size()), track, plot);
    for (const ActuatorSpec& actuator : vehicle.actuators) {
      if (actuator.name != name) continue;
      plot.limits.push_back({shown(actuator.max, unit), "actuator limit"});
      plot.limits.push_back({shown(actuator.min, unit), "actuator limit"});
    }
  }
  return plots;
}

LinePlot steering_plot(const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Steering δ: commanded and actual", "axle angle, left positive, °",
                          "Angles commanded by the steering law (dashed) and actual angles of the "
                          "axles (lines). As paper A, figure 19 b.");
  const Columns* columns = vehicle.find("steering");
  if (columns == nullptr) return plot;
  add_column(*columns, "front_act_rad", "front, actual", "s0", track, plot);
  add_column(*columns, "rear_act_rad", "rear, actual", "s1", track, plot);
  add_column(*columns, "front_des_rad", "front, commanded", "s0 dash", track, plot);
  add_column(*columns, "rear_des_rad", "rear, commanded", "s1 dash", track, plot);
  return plot;
}

std::vector<LinePlot> wrench_plots(const VehicleLog& vehicle, const Track& track) {
  const Columns* columns = vehicle.find("wrench");
  if (columns == nullptr) return {};
  const std::string caption =
      "Commanded by the controller (dashed), achievable by the rotors (lines). As paper A, figure "
      "21 b.";
  LinePlot thrust = plot_of(track, "Control actions: thrust", "total thrust, N", caption);
  add_column(*columns, "reachable_thrust_N", "reachable", "s0", track, thrust);
  add_column(*columns, "wanted_thrust_N", "commanded", "ref", track, thrust);
  LinePlot torque = plot_of(
      track, "Control actions: torques", "torque about body axes, N·m",
      "Commanded torques, limited to what the rotors can produce. As paper A, figure 21 b.");
  const char* axes[] = {"x", "y", "z"};
  const char* labels[] = {"τφ, roll", "τθ, pitch", "τψ, yaw"};
  for (std::size_t i = 0; i < 3; ++i) {
    add_column(*columns, fmt::format("reachable_torque_{}_Nm", axes[i]), labels[i], colour(i),
               track, torque);
  }
  return {thrust, torque};
}

/// Inputs of a fixed wing minus their trim values, the quantities that its controllers limit.
std::vector<LinePlot> trim_input_plots(const VehicleLog& vehicle, const Track& track) {
  const Columns* columns = vehicle.find("deviation");
  if (columns == nullptr) return {};
  const std::string caption = "Control minus its value in trim. As paper A, figure 11.";
  LinePlot throttle =
      plot_of(track, "Control actions: throttle ΔT", "share of full throttle", caption);
  add_column(*columns, "throttle", "ΔT", "s0", track, throttle);
  LinePlot surfaces =
      plot_of(track, "Control actions: elevator δe, aileron δa", "from trim, °", caption);
  add_column(*columns, "elevator_rad", "δe", "s0", track, surfaces);
  add_column(*columns, "aileron_rad", "δa", "s1", track, surfaces);
  return {throttle, surfaces};
}

/// Slip of all wheels while the vehicle moves.
LinePlot slip_plot(const VehicleLog& vehicle, const Track& track) {
  LinePlot plot =
      plot_of(track, "Wheel slip", "slip along the wheel, %",
              "Difference of rim speed and ground speed, divided by the larger: 0 rolls, 100 "
              "spins. Paper A, figure 19, allows no slip.");
  plot.min_span = 1.0;
  const Columns* columns = vehicle.find("wheels");
  if (columns == nullptr) return plot;
  for (const std::string& name : columns->names) {
    if (!name.starts_with("wheel_") || !name.ends_with("_slip")) continue;
    Samples samples = column(*columns, name, track);
    std::size_t at = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      while (at + 1 < track.t_s.size() && track.t_s[at + 1] <= samples.x[i]) ++at;
      samples.y[i] = track.speed_mps[at] < kSlips_mps ? kNone : 100.0 * samples.y[i];
    }
    plot.lines.push_back({"wheel " + name.substr(6, name.size() - 11), std::move(samples),
                          colour(plot.lines.size())});
  }
  return plot;
}

/// Largest ratio of an actuator's value to its limit.
Samples actuator_share(const VehicleLog& vehicle, const Track& track) {
  Samples share;
  const Columns* columns = vehicle.find("actuators");
  if (columns == nullptr) return share;
  for (std::size_t i = 0; i < columns->t_s.size(); ++i) {
    if (!track.contains(columns->t_s[i])) continue;
    double largest = kNone;
    for (const ActuatorSpec& actuator : vehicle.actuators) {
      const std::vector<double>* values = columns->find(actuator.name);
      if (values == nullptr) continue;
      const double value = (*values)[i], limit = value < 0.0 ? actuator.min : actuator.max;
      if (limit != 0.0) largest = std::fmax(largest, value / limit);
    }
    share.add(columns->t_s[i], 100.0 * largest);
  }
  return share;
}

bool is_judged(const AirReference& reference) {
  return reference.phase == AirReference::Phase::kStraight ||
         reference.phase == AirReference::Phase::kTurn;
}

LinePlot limit_plot(const VehicleLog& vehicle, const Track& track) {
  LinePlot plot = plot_of(track, "Use of limits", "share of the limit, %",
                          "100 % is at a limit. Shown is the actuator nearest to its limit");
  plot.min_span = 10.0;
  Samples actuators = actuator_share(vehicle, track);
  if (actuators.size() == 0) return plot;
  plot.lines.push_back({"actuators", std::move(actuators), "s0"});
  if (const Columns* deviation = vehicle.find("deviation")) {
    Samples share = column(*deviation, "limit_share", track);
    std::size_t reference_index = 0;
    const auto& times = vehicle.air_reference.times;
    for (std::size_t i = 0; i < share.size(); ++i) {
      while (reference_index + 1 < times.size() && times[reference_index + 1].s() <= share.x[i])
        ++reference_index;
      // Launch and landing are not judged, as in the metrics.
      const bool judged = reference_index < times.size() &&
                          is_judged(vehicle.air_reference.values[reference_index]);
      share.y[i] = judged ? 100.0 * share.y[i] : kNone;
    }
    plot.lines.push_back({"controller's limits", std::move(share), "s1"});
    plot.caption +=
        ", and the state or input deviation nearest to the limits of the controller (paper A, "
        "section 2.2: ±10 % of the states, 20 % of the inputs)";
  }
  plot.caption += ".";
  plot.limits.push_back({100.0, "limit"});
  return plot;
}

std::vector<LinePlot> energy_plots(const VehicleLog& vehicle, const Track& track) {
  LinePlot charge =
      plot_of(track, "Battery charge", "% of the capacity", "Battery charge remaining.");
  LinePlot power = plot_of(track, "Power drawn", "W", "Electric power drawn from the battery.");
  charge.min_span = 1.0;
  Samples left, drawn;
  for (std::size_t i = 0; i < vehicle.battery.times.size(); ++i) {
    const double t_s = vehicle.battery.times[i].s();
    if (!track.contains(t_s)) continue;
    left.add(t_s, 100.0 * vehicle.battery.values[i].charge);
    drawn.add(t_s, vehicle.battery.values[i].power_W);
  }
  if (left.size() < 2) return {};
  charge.maximum = std::max(100.0, *std::max_element(left.y.begin(), left.y.end()));
  if (*std::min_element(drawn.y.begin(), drawn.y.end()) < 0.0) {
    power.caption += " Negative: the motors brake and charge the battery.";
  }
  charge.lines = {{"charge", std::move(left), vehicle.style}};
  power.lines = {{"power", std::move(drawn), vehicle.style}};
  return {charge, power};
}

}  // namespace

std::vector<LinePlot> action_plots(const VehicleLog& vehicle, const Track& track) {
  std::vector<LinePlot> plots;
  const auto append = [&](std::vector<LinePlot> more) {
    for (LinePlot& plot : more) plots.push_back(std::move(plot));
  };
  append(trim_input_plots(vehicle, track));
  append({steering_plot(vehicle, track)});
  append(wrench_plots(vehicle, track));
  append(actuator_plots(vehicle, track));
  append({slip_plot(vehicle, track), limit_plot(vehicle, track)});
  append(energy_plots(vehicle, track));
  return plots;
}

}  // namespace vinerow::tools::report
