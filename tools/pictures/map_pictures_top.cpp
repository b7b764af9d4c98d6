#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/render/caption.h"
#include "engine/render/scale_bar.h"
#include "tools/pictures/colour_scale.h"
#include "tools/pictures/legend.h"
#include "tools/pictures/map_pictures.h"
#include "tools/pictures/picture_style.h"
#include "tools/pictures/plan_view.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::tools {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using mapping::PointClass;

constexpr Rgb kRowLine = {255, 255, 255}, kRowEnd = {196, 40, 40}, kNoCanopy = {236, 112, 20};
constexpr Rgb kMapContour = {170, 150, 116}, kUnseenGround = {240, 236, 226};
constexpr int kTallestTop = 1300, kTopLegend = 110;
constexpr std::size_t kMaxPoints = 12'000'000;

PlanView plan_of(const RowMap& map) {
  Eigen::AlignedBox2d box;
  for (const PlantRow& row : map.rows) {
    for (const Vector3d& p : row.line_W) box.extend(Vector2d(p.head<2>()));
  }
  for (const Vector2d& p : map.boundary_W) box.extend(p);
  return {box.min(), box.sizes().cwiseMax(1.0), kNumberedMargin, kTallestTop, kTopLegend};
}

/// Content of the cloud per pixel.
struct CanopyPixels {
  std::vector<float> canopy_m;       ///< highest canopy above the ground; 0: none
  std::vector<std::uint8_t> others;  ///< 1: a point as high as canopy that belongs to no row

  CanopyPixels(const PlanView& view, const mapping::CloudMap& map,
               const mapping::ParcelCloud& cloud)
      : canopy_m(static_cast<std::size_t>(kPictureWidth) * view.map_height, 0.0f),
        others(canopy_m.size(), 0) {
    const std::size_t stride =
        std::max<std::size_t>(1, (cloud.points.size() + kMaxPoints - 1) / kMaxPoints);
    for (std::size_t k = 0; k < cloud.points.size(); k += stride) {
      const mapping::PointClass is = cloud.classes[k];
      if (is != mapping::PointClass::kCanopy && is != mapping::PointClass::kOther) continue;
      const Vector3d p = cloud.point_W(k);
      const Vector2d at = view(p);
      const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
      if (x < 0 || y < 0 || x >= kPictureWidth || y >= view.map_height) continue;
      const std::size_t pixel = static_cast<std::size_t>(y) * kPictureWidth + x;
      if (is == mapping::PointClass::kOther) {
        others[pixel] = 1;
        continue;
      }
      const double ground_m = map.map.terrain ? map.map.terrain->height_m(p.x(), p.y()) : 0.0;
      canopy_m[pixel] = std::max(canopy_m[pixel], static_cast<float>(p.z() - ground_m));
    }
  }
};

/// Contour interval in whole metres that gives about a dozen lines.
double contour_step_m(const HeightField& terrain) {
  const auto [low, high] = std::minmax_element(terrain.heights_m.begin(), terrain.heights_m.end());
  const double wanted_m = (*high - *low) / 12.0;
  for (const double step_m : {0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0}) {
    if (step_m >= wanted_m) return step_m;
  }
  return 50.0;
}

/// Draws hill shading with light from the north-west, and contour lines. @returns the contour
/// interval
double draw_shaded_ground(Canvas& canvas, const PlanView& view, const HeightField& terrain) {
  const Vector3d light = Vector3d(-1.0, 1.0, 2.2).normalized();
  const double step_m = contour_step_m(terrain), pixel_m = 1.0 / view.px_per_m;
  for (int y = 0; y < view.map_height; ++y) {
    for (int x = 0; x < kPictureWidth; ++x) {
      const Vector2d p = view.world(x + 0.5, y + 0.5);
      if (!terrain.contains(p.x(), p.y())) continue;
      const double c = terrain.cell_m;
      const Vector3d normal(terrain.height_m(p.x() - c, p.y()) - terrain.height_m(p.x() + c, p.y()),
                            terrain.height_m(p.x(), p.y() - c) - terrain.height_m(p.x(), p.y() + c),
                            2.0 * c);
      const double shade =
          std::clamp(0.5 + 0.5 * normal.normalized().dot(light) / light.z(), 0.72, 1.08);
      canvas.blend(x, y,
                   {static_cast<int>(232 * shade), static_cast<int>(224 * shade),
                    static_cast<int>(206 * shade)},
                   1.0);
      const auto level = [&](double dx, double dy) {
        return std::floor(terrain.height_m(p.x() + dx, p.y() + dy) / step_m);
      };
      const double here = level(0.0, 0.0);
      if (here != level(pixel_m, 0.0) || here != level(0.0, pixel_m)) {
        canvas.blend(x, y, kMapContour, 0.55);
      }
    }
  }
  return step_m;
}

/// Colour of a canopy height, from dark (0, lowest) to light (1, highest).
Rgb canopy_colour(double share) {
  return viridis(0.12 + 0.85 * std::clamp(share, 0.0, 1.0));
}

void draw_canopy(Canvas& canvas, const PlanView& view, const CanopyPixels& pixels, double low_m,
                 double high_m) {
  for (int y = 0; y < view.map_height; ++y) {
    for (int x = 0; x < kPictureWidth; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * kPictureWidth + x;
      if (pixels.others[at]) canvas.blend(x, y, {142, 146, 150}, 0.8);
      if (pixels.canopy_m[at] > 0.0f) {
        canvas.blend(x, y, canopy_colour((pixels.canopy_m[at] - low_m) / (high_m - low_m)), 1.0);
      }
    }
  }
}

void draw_disc(Canvas& canvas, const Vector2d& at, double radius_px, const Rgb& colour) {
  canvas.fill(render::circle(at, radius_px, 16), colour);
}

void draw_rows(Canvas& canvas, const PlanView& view, const mapping::CloudMap& map) {
  constexpr double kApart_px = 15.0;  // closer numbers would overlap
  std::optional<Vector2d> drawn[2];   // for each end
  for (std::size_t k = 0; k < map.map.rows.size(); ++k) {
    const PlantRow& row = map.map.rows[k];
    const std::vector<Vector2d> line_W = from_above(row.line_W);
    for (std::size_t i = 0; i + 1 < line_W.size(); ++i) {
      canvas.line(view(line_W[i]), view(line_W[i + 1]), 1.2, kRowLine, 0.6);
    }
    const mapping::RowCurve curve(line_W);
    if (k < map.report.rows.size()) {
      for (const auto& [from_m, to_m] : map.report.rows[k].gaps_m) {
        canvas.line(view(curve.point_W(from_m)), view(curve.point_W(to_m)), 3.6, kNoCanopy);
      }
    }
    for (const bool last : {false, true}) {
      const double s_m = last ? curve.length_m() : 0.0;
      const Vector2d at = view(curve.point_W(s_m));
      draw_disc(canvas, at, 4.2, kPaper);
      draw_disc(canvas, at, 3.0, kRowEnd);
      Vector2d out = curve.direction_W(s_m) * (last ? 1.0 : -1.0);
      out.y() = -out.y();
      std::optional<Vector2d>& before = drawn[last ? 1 : 0];
      if (before && (at - *before).norm() < kApart_px) continue;
      before = at;
      // Leave space for end posts, which lean outwards.
      const Vector2d middle = at + 19.0 * out;
      draw_disc(canvas, middle, 9.5, kPaper);
      canvas.text(std::to_string(row.id), 15, middle + Vector2d(0.0, 5.4), kInk, 0.5);
    }
  }
}

void draw_top_legend(Canvas& canvas, double y, double low_m, double high_m, bool has_gaps,
                     double contour_m) {
  double x = kNumberedMargin;
  const auto words = [&](const std::string& text) {
    canvas.text(text, 16, {x, y + 5.5}, kInk);
    x += render::text_width(text, 16) + 34.0;
  };
  canvas.text(fmt::format("{:.1f} m", low_m), 16, {x, y + 5.5}, kInk);
  x += render::text_width(fmt::format("{:.1f} m", low_m), 16) + 8.0;
  constexpr int kBar_px = 136;
  draw_colour_bar(canvas, std::round(x), std::round(y) - 6.0, kBar_px, 13, canopy_colour);
  x += kBar_px + 8.0;
  words(fmt::format("{:.1f} m canopy above the ground", high_m));
  canvas.line({x, y}, {x + 30, y}, 6.0, {160, 160, 150});
  canvas.line({x, y}, {x + 30, y}, 1.6, kRowLine);
  x += 38.0;
  words("row");
  draw_disc(canvas, {x + 6, y}, 4.5, kRowEnd);
  x += 20.0;
  words("end of a row");
  if (has_gaps) {
    canvas.line({x, y}, {x + 30, y}, 4.0, kNoCanopy);
    x += 38.0;
    words("no canopy");
  }
  if (contour_m > 0.0) {
    canvas.line({x, y}, {x + 30, y}, 1.6, kMapContour);
    x += 38.0;
    words(fmt::format("contour interval {:g} m", contour_m));
  }
}

}  // namespace

render::Image draw_top(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                       const std::string& title) {
  const PlanView view = plan_of(map.map);
  Canvas canvas(kPictureWidth, view.height, kPaper);
  // The parcel may be larger than the ground in the cloud.
  canvas.fill(view(map.map.boundary_W), kUnseenGround);
  const double contour_m =
      map.map.terrain ? draw_shaded_ground(canvas, view, *map.map.terrain) : 0.0;
  double low_m = 1e300;
  bool has_gaps = false;
  double length_m = 0.0;
  for (const PlantRow& row : map.map.rows) low_m = std::min(low_m, row.canopy_base_m);
  for (const auto& row : map.report.rows) {
    has_gaps = has_gaps || !row.gaps_m.empty();
    length_m += row.length_m;
  }
  const double high_m = std::max(low_m + 0.5, 1.1 * map.report.canopy_top_m);
  draw_canopy(canvas, view, CanopyPixels(view, map, cloud), low_m, high_m);
  canvas.outline(view(map.map.boundary_W), 2.0, kBoundary);
  draw_rows(canvas, view, map);

  const double top = view.map_height;
  canvas.fill(render::rectangle(0, top, kPictureWidth, top + kTopLegend), kPaper);
  canvas.text(title, 22, {kNumberedMargin, top + 26.0}, kInk);
  const mapping::CloudMapReport& r = map.report;
  canvas.text(fmt::format("{} rows, total length {:.0f} m, {:.2f} m apart, bearing {:.1f}°",
                          r.rows.size(), length_m, r.spacing_m, r.bearing_deg),
              16, {kNumberedMargin, top + 52.0}, kFaint);
  draw_top_legend(canvas, top + 82.0, low_m, high_m, has_gaps, contour_m);
  draw_scale_bar(canvas, {kPictureWidth - kNumberedMargin, top + 84.0},
                 0.125 * kPictureWidth / view.px_per_m, view.px_per_m, kInk);
  return canvas.image();
}

}  // namespace vinerow::tools
