#include "tools/report/estimate_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/math/polyline.h"
#include "engine/math/statistics.h"
#include "tools/report/html.h"

namespace vinerow::tools::report {
namespace {

constexpr double kRowReach_m = 5.0;
/// Maximum number of bands drawn; more would hide each other.
constexpr std::size_t kMaxBands = 2;
/// A band wider than this multiple of the largest error would fill the plot and is not drawn.
/// Chosen.
constexpr double kWidestBand = 1.2;

std::vector<Polyline> rows_of(const WorldModel* world) {
  std::vector<Polyline> rows;
  if (world == nullptr) return rows;
  for (const PlantRow& row : world->rows->rows) {
    if (row.line_W.size() >= 2) rows.emplace_back(from_above(row.line_W));
  }
  return rows;
}

/// Unit vector along the nearest row, pointing in the vehicle's forward direction; the heading if
/// no row is within kRowReach_m.
Eigen::Vector2d along(const std::vector<Polyline>& rows, const Pose& X_WB) {
  const double yaw_rad = yaw_from_quaternion(X_WB.q);
  const Eigen::Vector2d heading(std::cos(yaw_rad), std::sin(yaw_rad));
  Eigen::Vector2d direction = heading;
  double nearest_m = kRowReach_m;
  for (const Polyline& row : rows) {
    const auto at = row.nearest(X_WB.p.head<2>());
    if (at.distance_m > nearest_m) continue;
    const Eigen::Vector2d d = row.points()[at.segment + 1] - row.points()[at.segment];
    if (d.isZero(0.0)) continue;
    nearest_m = at.distance_m;
    direction = d.normalized();
    if (direction.dot(heading) < 0.0) direction = -direction;
  }
  return direction;
}

struct Errors {
  Samples lateral, longitudinal;
  std::vector<double> lateral_2s, longitudinal_2s;  ///< two stated standard deviations, m
  bool states_any = false;
};

Errors errors_of(const playback::Trace<Odometry>& estimate, const playback::Trace<Odometry>& truth,
                 const std::vector<Polyline>& rows) {
  Errors errors;
  for (std::size_t i = 0; i < estimate.values.size(); ++i) {
    const Time t = estimate.times[i];
    const Odometry true_now = playback::odometry_at(truth, t);
    const Eigen::Vector2d e = (estimate.values[i].X_WB.p - true_now.X_WB.p).head<2>();
    const Eigen::Vector2d d = along(rows, true_now.X_WB), n(-d.y(), d.x());
    const Eigen::Matrix2d P = estimate.values[i].position_covariance().topLeftCorner<2, 2>();
    errors.lateral.add(t.s(), n.dot(e));
    errors.longitudinal.add(t.s(), d.dot(e));
    errors.lateral_2s.push_back(2.0 * std::sqrt(std::max(0.0, n.dot(P * n))));
    errors.longitudinal_2s.push_back(2.0 * std::sqrt(std::max(0.0, d.dot(P * d))));
    errors.states_any = errors.states_any || !P.isZero(0.0);
  }
  return errors;
}

PlotBand band_of(const std::string& name, const std::vector<double>& t_s,
                 const std::vector<double>& two_sigma, const std::string& style) {
  PlotBand band{name + ", ±2σ stated", t_s, {}, two_sigma, style};
  for (const double value : two_sigma) band.low.push_back(-value);
  return band;
}

double largest_error_m(const LinePlot& plot) {
  double largest_m = plot.min_span;
  for (const PlotLine& line : plot.lines) {
    for (const double error_m : line.samples.y) largest_m = std::max(largest_m, std::abs(error_m));
  }
  return largest_m;
}

/// Moves bands that would fill the plot into its caption.
void put_far_bands_in_words(LinePlot& plot) {
  const double widest_m = kWidestBand * largest_error_m(plot);
  std::erase_if(plot.bands, [&](const PlotBand& band) {
    std::vector<double> half_widths_m = band.high;
    const double half_width_m = upper_median(half_widths_m);
    if (half_width_m <= widest_m) return false;
    plot.caption += fmt::format(" Not drawn because it would fill the plot: {} (±{:.2g} m).",
                                escaped(band.label), half_width_m);
    return true;
  });
}

}  // namespace

std::vector<LinePlot> estimate_plots(const VehicleLog& vehicle, const WorldModel* world) {
  if (vehicle.truth.empty() || vehicle.estimates.empty()) return {};
  const std::vector<Polyline> rows = rows_of(world);
  LinePlot lateral, longitudinal;
  lateral.title = "Estimation error across the rows";
  longitudinal.title = "Estimation error along the rows";
  lateral.y_label = longitudinal.y_label = "estimate minus truth, m";
  lateral.caption = longitudinal.caption =
      "Error of the estimated position, with a band of two standard deviations as stated by the "
      "estimator: about 95 % of the line should be inside. As paper C, figure 8.";
  lateral.min_span = longitudinal.min_span = 0.01;
  std::size_t colour = 0;
  for (const auto& [name, estimate] : vehicle.estimates) {
    const std::string style = fmt::format("s{}", colour % 8);
    Errors errors = errors_of(estimate, vehicle.truth, rows);
    if (errors.states_any && colour < kMaxBands) {
      lateral.bands.push_back(band_of(name, errors.lateral.x, errors.lateral_2s, style));
      longitudinal.bands.push_back(
          band_of(name, errors.longitudinal.x, errors.longitudinal_2s, style));
    }
    lateral.lines.push_back({name, std::move(errors.lateral), style});
    longitudinal.lines.push_back({name, std::move(errors.longitudinal), style});
    ++colour;
  }
  put_far_bands_in_words(lateral);
  put_far_bands_in_words(longitudinal);
  return {lateral, longitudinal};
}

}  // namespace vinerow::tools::report
