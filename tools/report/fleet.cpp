#include "tools/report/fleet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"

namespace vinerow::tools::report {
namespace {

/// Search radius of the metric `clearance`.
constexpr double kClearanceReach_m = 3.0;

/// Vehicles that work at the same time for less only hand over to each other. Chosen.
constexpr double kTogether_s = 5.0;

/// Sum of a metric over the vehicles that have it; NaN if no vehicle has it.
double sum_of(const RunFolder& run, const std::string& metric) {
  double sum = kNone;
  for (const std::string& vehicle : run.vehicles) {
    const double value = run.metric(vehicle, metric);
    if (std::isfinite(value)) sum = std::isfinite(sum) ? sum + value : value;
  }
  return sum;
}

double min_of(const RunFolder& run, const std::string& metric) {
  double minimum = kNone;
  for (const std::string& vehicle : run.vehicles) {
    minimum = std::fmin(minimum, run.metric(vehicle, metric));
  }
  return minimum;
}

/// Distance between two vehicles at the first one's time stamps.
Samples distance_of(const VehicleLog& a, const VehicleLog& b) {
  Samples samples;
  if (a.truth.empty() || b.truth.empty()) return samples;
  for (std::size_t i = 0; i < a.truth.times.size(); ++i) {
    const Time t = a.truth.times[i];
    samples.add(t.s(),
                (a.truth.values[i].X_WB.p - playback::odometry_at(b.truth, t).X_WB.p).norm());
  }
  return samples;
}

/// Samples from the time in which both vehicles are at work.
Samples during(const Samples& samples, const Track& a, const Track& b) {
  Samples both;
  if (a.empty() || b.empty()) return both;
  const double from_s = std::max(a.t_s.front(), b.t_s.front());
  const double to_s = std::min(a.t_s.back(), b.t_s.back());
  if (to_s - from_s < kTogether_s) return both;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.x[i] >= from_s && samples.x[i] <= to_s) both.add(samples.x[i], samples.y[i]);
  }
  return both;
}

void add_waits(const VehicleLog& vehicle, std::vector<PlotSpan>& spans) {
  for (std::size_t i = 0; i < vehicle.authority.times.size(); ++i) {
    if (vehicle.authority.values[i].holder.empty()) continue;
    const double from_s = vehicle.authority.times[i].s();
    const bool is_last = i + 1 == vehicle.authority.times.size();
    const double to_s =
        is_last ? vehicle.truth.times.back().s() : vehicle.authority.times[i + 1].s();
    if (!spans.empty() && spans.back().to >= from_s) {
      spans.back().to = std::max(spans.back().to, to_s);
    } else {
      spans.push_back({from_s, to_s});
    }
  }
}

}  // namespace

std::string key_numbers(const RunFolder& run, const std::vector<VehicleLog>& vehicles) {
  std::string out = "<div class=\"cards\">\n";
  out += card(duration_text(std::max(0.0, run.end_s())), "simulated");
  out += card("<span data-from=\"real-time-factor\">see Timings</span>",
              "real time: simulation speed");
  std::string names;
  for (const std::string& name : run.vehicles) names += (names.empty() ? "" : ", ") + name;
  out += card(std::to_string(run.vehicles.size()),
              (run.vehicles.size() == 1 ? "vehicle" : "vehicles") +
                  (names.empty() ? "" : ": " + escaped(names)));
  const double distance_m = sum_of(run, "distance_m");
  if (std::isfinite(distance_m)) {
    out += card(distance_m < 995.0 ? fmt::format("{:.0f} m", distance_m)
                                   : fmt::format("{:.2f} km", 1e-3 * distance_m),
                "travelled");
  }
  const double contacts = sum_of(run, "contact_count");
  if (std::isfinite(contacts)) {
    out += card(fmt::format("{:.0f}", contacts), "contacts with plants, posts or vehicles");
  }
  const double clearance_m = min_of(run, "min_clearance_m");
  if (std::isfinite(clearance_m)) {
    const bool beyond = clearance_m >= kClearanceReach_m;
    out += card(beyond ? fmt::format("over {:g} m", kClearanceReach_m)
                       : fmt::format("{:.2f} m", clearance_m),
                "smallest clearance from plants and posts");
  }
  double separation_m = min_of(run, "min_vehicle_distance_m");
  const bool measured = std::isfinite(separation_m);
  if (!measured) separation_m = min_separation_m(vehicles);
  if (std::isfinite(separation_m)) {
    out += card(fmt::format("{:.1f} m", separation_m),
                measured ? "smallest distance between vehicles"
                         : "smallest distance between vehicles (centres)");
  }
  return out + "</div>\n";
}

LinePlot separation_plot(const std::vector<VehicleLog>& vehicles,
                         const std::vector<Track>& tracks) {
  LinePlot plot;
  plot.title = "Distance between the vehicles";
  plot.y_label = "centre to centre, m";
  plot.caption =
      "True distance between the centres while both vehicles are at work. Shaded: a vehicle waits "
      "for an alley that another one occupies.";
  plot.spans_label = "a vehicle waits for another";
  plot.min_span = 1.0;
  for (std::size_t a = 0; a < vehicles.size(); ++a) {
    add_waits(vehicles[a], plot.spans);
    for (std::size_t b = a + 1; b < vehicles.size(); ++b) {
      Samples samples = during(distance_of(vehicles[a], vehicles[b]), tracks[a], tracks[b]);
      if (samples.size() == 0) continue;
      plot.lines.push_back({vehicles[a].name + " to " + vehicles[b].name, std::move(samples),
                            fmt::format("s{}", plot.lines.size() % 8)});
    }
  }
  if (plot.spans.empty())
    plot.caption = "True distance between the centres while both vehicles are at work.";
  return plot;
}

double min_separation_m(const std::vector<VehicleLog>& vehicles) {
  double min_m = kNone;
  for (std::size_t a = 0; a < vehicles.size(); ++a) {
    for (std::size_t b = a + 1; b < vehicles.size(); ++b) {
      for (const double distance_m : distance_of(vehicles[a], vehicles[b]).y) {
        min_m = std::fmin(min_m, distance_m);
      }
    }
  }
  return min_m;
}

}  // namespace vinerow::tools::report
