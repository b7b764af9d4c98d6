#include "tools/report/mission_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/math/polyline.h"
#include "engine/render/scale_bar.h"
#include "tools/replay/simplify_line.h"
#include "tools/report/html.h"
#include "tools/report/svg.h"

namespace vinerow::tools::report {
namespace {

constexpr double kTolerance_px = 0.3;
/// Margin around the content, as a share of the larger side. Chosen.
constexpr double kMarginShare = 0.03;
/// A parcel with a smaller share of the whole picture gets its own picture. Chosen.
constexpr double kSmallParcel = 0.35;
constexpr double kTurnMargin_m = 3.0;
constexpr double kTickSpace_px = 40.0;

/// Projection from metres to pixels, with the same scale on both axes.
class Projection {
 public:
  Projection(const MapView& view, const MapStyle& style) {
    const double axis_space_px = style.with_axes ? kTickSpace_px : 0.0;
    const double width = style.width - axis_space_px;
    const double wanted = width / view.x.span() * view.y.span();
    const double height =
        std::clamp(wanted, style.min_height - axis_space_px, style.max_height - axis_space_px);
    scale_ = std::min(width / view.x.span(), height / view.y.span());
    const double x_m = width / scale_, y_m = height / scale_;
    const double x0 = 0.5 * (view.x.low + view.x.high), y0 = 0.5 * (view.y.low + view.y.high);
    shown_.x = {x0 - 0.5 * x_m, x0 + 0.5 * x_m};
    shown_.y = {y0 - 0.5 * y_m, y0 + 0.5 * y_m};
    left_ = axis_space_px;
    bottom_ = height;
    full_height_ = height + axis_space_px;
  }
  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
    return {left_ + scale_ * (p.x() - shown_.x.low), bottom_ - scale_ * (p.y() - shown_.y.low)};
  }
  const MapView& shown() const { return shown_; }
  double scale() const { return scale_; }
  double left() const { return left_; }
  double bottom() const { return bottom_; }
  double full_height() const { return full_height_; }

 private:
  MapView shown_;
  double scale_ = 1.0, left_ = 0.0, bottom_ = 0.0, full_height_ = 0.0;
};

/// Draws grid lines with the same step on both axes, and tick labels where there is space.
void draw_grid_lines(const Projection& at, const MapStyle& style, Svg& svg) {
  if (!style.with_axes) return;
  const Axis x(at.shown().x, at.left(), style.width, 10);
  const double step_m = x.ticks().size() > 1 ? x.ticks()[1] - x.ticks()[0] : at.shown().x.span();
  const double first = std::ceil(at.shown().y.low / step_m - 1e-9);
  const double bottom = at.bottom();
  for (const double tick : x.ticks()) {
    svg.line(x.px(tick), 0, x.px(tick), bottom, "grid");
    svg.text(x.px(tick), bottom + 16, x.text(tick), "tick mid");
  }
  for (double k = first; k * step_m <= at.shown().y.high; ++k) {
    const double y = at({0.0, k * step_m}).y();
    svg.line(at.left(), y, style.width, y, "grid");
    // The axis name, 80 px long, occupies the corner on a telephone.
    if (y > 90.0) svg.text(at.left() - 5, y + 4, tick_text(k * step_m, step_m), "tick end");
  }
  svg.text(style.width - 2, bottom + 33, "east, m", "tick end");
  svg.raw(
      fmt::format("<text class=\"tick end\" transform=\"translate(12 4) rotate(-90)\">north, "
                  "m</text>\n"));
}

std::vector<Eigen::Vector2d> projected(const std::vector<Eigen::Vector2d>& line,
                                       const Projection& at) {
  std::vector<Eigen::Vector2d> out;
  out.reserve(line.size());
  for (const Eigen::Vector2d& p : line) out.push_back(at(p));
  return simplify_line(out, kTolerance_px);
}

std::vector<Eigen::Vector2d> track_line(const VehicleLog& vehicle) {
  std::vector<Eigen::Vector2d> out;
  for (const Odometry& truth : vehicle.truth.values) out.push_back(truth.X_WB.p.head<2>());
  return out;
}

std::vector<Eigen::Vector2d> plan_line(const PlannedPath& plan) {
  std::vector<Eigen::Vector2d> out;
  for (const PathPoint& point : plan.points) out.push_back(point.p_W.head<2>());
  return out;
}

void draw_rows(const RunFolder& run, const Projection& at, const MapStyle& style, Svg& svg) {
  if (!run.world) return;
  svg.polygon(projected(run.world->rows->boundary_W, at), "parcel");
  for (const PlantRow& row : run.world->rows->rows) {
    const double width = style.with_canopy ? at.scale() * row.canopy_width_m : 0.0;
    svg.open_group(fmt::format("class=\"row\" stroke-width=\"{}\"", px(std::max(1.2, width))));
    svg.polyline(projected(from_above(row.line_W), at), "");
    svg.close_group();
  }
}

void draw_tracks(const std::vector<VehicleLog>& vehicles, const Projection& at,
                 const MapStyle& style, Svg& svg) {
  for (const VehicleLog& vehicle : vehicles) {
    svg.polyline(projected(track_line(vehicle), at), "track " + vehicle.style);
  }
  if (style.with_plans) {
    for (const VehicleLog& vehicle : vehicles) {
      for (const PlannedPath& plan : vehicle.plan.values) {
        svg.polyline(projected(plan_line(plan), at), "plan");
      }
    }
  }
  for (const VehicleLog& vehicle : vehicles) {
    if (vehicle.truth.empty() || !style.with_ends) continue;
    const Eigen::Vector2d start = at(vehicle.truth.values.front().X_WB.p.head<2>());
    const Eigen::Vector2d end = at(vehicle.truth.values.back().X_WB.p.head<2>());
    svg.circle(start.x(), start.y(), 5, "start " + vehicle.style, vehicle.name + " starts here");
    svg.rect(end.x() - 4.5, end.y() - 4.5, 9, 9, "end " + vehicle.style,
             vehicle.name + " ends here");
  }
}

/// Draws a scale bar of a round length, about a sixth of the picture, and a north arrow.
void draw_scale(const Projection& at, const MapStyle& style, Svg& svg) {
  const double max_m = style.width / at.scale() / 5.0;
  const double length_m = render::scale_length_m(max_m);
  const double length = at.scale() * length_m, x = style.width - 22 - length, y = at.bottom() - 16;
  svg.rect(x - 10, y - 22, length + 54 - 22, 32, "paper");
  svg.line(x, y, x + length, y, "scale");
  svg.line(x, y - 5, x, y + 5, "scale");
  svg.line(x + length, y - 5, x + length, y + 5, "scale");
  svg.text(x + 0.5 * length, y - 7, fmt::format("{:g} m", length_m), "label mid");
  const double ax = style.width - 26;
  svg.rect(ax - 16, 8, 32, 46, "paper");
  svg.polygon({{ax, 28}, {ax - 8, 50}, {ax, 44}, {ax + 8, 50}}, "north");
  svg.text(ax, 23, "N", "label mid");
}

void include(const std::vector<Eigen::Vector2d>& line, MapView& view) {
  for (const Eigen::Vector2d& p : line) {
    view.x.include(p.x());
    view.y.include(p.y());
  }
}

void include(const VehicleLog& vehicle, MapView& view) {
  include(track_line(vehicle), view);
  for (const PlannedPath& plan : vehicle.plan.values) include(plan_line(plan), view);
}

std::optional<MapView> with_margin(MapView view) {
  if (view.x.empty()) return std::nullopt;
  const double margin_m = std::max(1.0, kMarginShare * std::max(view.x.span(), view.y.span()));
  for (Range* range : {&view.x, &view.y}) *range = {range->low - margin_m, range->high + margin_m};
  return view;
}

}  // namespace

std::optional<MapView> whole_view(const RunFolder& run, const std::vector<VehicleLog>& vehicles) {
  MapView view;
  if (run.world) {
    include(run.world->rows->boundary_W, view);
    for (const PlantRow& row : run.world->rows->rows) include(from_above(row.line_W), view);
  }
  for (const VehicleLog& vehicle : vehicles) include(vehicle, view);
  return with_margin(view);
}

std::optional<MapView> parcel_view(const RunFolder& run, const std::vector<VehicleLog>& vehicles) {
  const auto whole = whole_view(run, vehicles);
  const bool anybody = std::any_of(vehicles.begin(), vehicles.end(), [](const VehicleLog& vehicle) {
    return !vehicle.has_wings && !vehicle.plan.empty();
  });
  if (!run.world || !whole || !anybody) return std::nullopt;
  MapView view;
  include(run.world->rows->boundary_W, view);
  for (const PlantRow& row : run.world->rows->rows) include(from_above(row.line_W), view);
  for (const VehicleLog& vehicle : vehicles) {
    if (!vehicle.has_wings) include(vehicle, view);
  }
  const double area = view.x.span() * view.y.span(), all = whole->x.span() * whole->y.span();
  return area < kSmallParcel * all ? with_margin(view) : std::nullopt;
}

std::optional<MapView> own_view(const VehicleLog& vehicle) {
  MapView view;
  include(vehicle, view);
  return with_margin(view);
}

std::optional<MapView> first_turn_view(const Track& track) {
  MapView view;
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {
    if (!track.in_turn[i]) {
      if (!view.x.empty()) break;
      continue;
    }
    view.x.include(track.p_W[i].x());
    view.y.include(track.p_W[i].y());
  }
  if (view.x.empty()) return std::nullopt;
  for (Range* range : {&view.x, &view.y}) {
    *range = {range->low - kTurnMargin_m, range->high + kTurnMargin_m};
  }
  return view;
}

std::string mission_map(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                        const MapView& view, const MapStyle& style) {
  const Projection at(view, style);
  Svg svg(style.width, at.full_height(), "map", style.label);
  svg.rect(at.left(), 0, style.width - at.left(), at.bottom(), "ground");
  draw_grid_lines(at, style, svg);
  svg.raw(fmt::format("<svg x=\"{}\" y=\"0\" width=\"{}\" height=\"{}\" viewBox=\"{} 0 {} {}\">\n",
                      px(at.left()), px(style.width - at.left()), px(at.bottom()), px(at.left()),
                      px(style.width - at.left()), px(at.bottom())));
  draw_rows(run, at, style, svg);
  draw_tracks(vehicles, at, style, svg);
  svg.raw("</svg>\n");
  draw_scale(at, style, svg);
  return svg.finish();
}

std::string map_legend(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                       const MapStyle& style) {
  std::string keys;
  bool planned = false;
  for (const VehicleLog& vehicle : vehicles) {
    keys += legend_key(vehicle.style, vehicle.name);
    planned = planned || !vehicle.plan.empty();
  }
  if (planned && style.with_plans) keys += legend_key("ref", "planned");
  if (run.world && !run.world->rows->rows.empty()) {
    keys += legend_key("area row", "plant rows");
  }
  if (!vehicles.empty() && style.with_ends) keys += "<span>● start</span><span>■ end</span>";
  return legend_line(keys);
}

}  // namespace vinerow::tools::report
