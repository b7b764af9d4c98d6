#include "tools/pictures/survey_picture.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "engine/math/angles.h"
#include "engine/render/scale_bar.h"
#include "tools/pictures/colour_scale.h"
#include "tools/pictures/legend.h"
#include "tools/pictures/picture_canvas.h"
#include "tools/pictures/picture_style.h"
#include "tools/pictures/plan_view.h"

namespace vinerow::tools {
namespace {

using Eigen::Vector2d;

constexpr Rgb kNoGround = {214, 212, 206}, kArea = {20, 24, 26}, kPath = {92, 98, 100};
constexpr Rgb kSurveyContour = {150, 140, 116}, kFootprint = {214, 84, 26}, kStart = {196, 40, 40};
constexpr int kSurveyLegend = 122;

std::vector<Vector2d> footprint_of(const SurveyCamera& camera,
                                   const controllers::SurveyShot& shot) {
  const Vector2d along =
      0.5 * camera.footprint_length_m(shot.height_m) * controllers::direction(shot.yaw_rad);
  const Vector2d across =
      0.5 * camera.footprint_width_m(shot.height_m) * left_of(controllers::direction(shot.yaw_rad));
  const Vector2d middle = shot.p_W.head<2>();
  return {middle + along + across, middle - along + across, middle - along - across,
          middle + along - across};
}

/// Relief: heights at every second pixel, for shading and contour lines.
class Relief {
 public:
  Relief(const PlanView& view, const controllers::GroundHeight& ground)
      : rows_((view.map_height + 1) / kStep + 2) {
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        heights_m_.push_back(ground(view.world(kStep * i, kStep * j)));
        if (!heights_m_.back()) continue;
        low_m_ = std::min(low_m_, *heights_m_.back());
        high_m_ = std::max(high_m_, *heights_m_.back());
      }
    }
  }

  /// Draws hill shading with light from the north-west, and contour lines. @returns the contour
  /// interval
  double draw(Canvas& canvas, const PlanView& view) const {
    const double step_m = contour_step_m(), relief = exaggeration(view);
    for (int j = 0; j + 1 < rows_; ++j) {
      for (int i = 0; i + 1 < kColumns; ++i) {
        const auto h = at(i, j), right = at(i + 1, j), down = at(i, j + 1);
        Rgb colour = kNoGround;
        bool is_contour = false;
        if (h && right && down) {
          const double per_m = relief * view.px_per_m / kStep;
          const Eigen::Vector3d normal =
              Eigen::Vector3d(-(*right - *h) * per_m, (*down - *h) * per_m, 1.0).normalized();
          const Eigen::Vector3d light = Eigen::Vector3d(-1.0, 1.0, 1.6).normalized();
          const double shade = std::clamp(normal.dot(light) / light.z(), 0.55, 1.25);
          const double share = (*h - low_m_) / std::max(1.0, high_m_ - low_m_);
          const double ramp[3] = {206 + 34 * share, 216 + 12 * share, 184 + 32 * share};
          for (std::size_t c = 0; c < 3; ++c) {
            colour[c] = std::min(250, static_cast<int>(std::lround(ramp[c] * shade)));
          }
          const auto level = [&](double height_m) { return std::floor(height_m / step_m); };
          is_contour = level(*h) != level(*right) || level(*h) != level(*down);
        }
        for (int k = 0; k < kStep * kStep; ++k) {
          const int x = kStep * i + k % kStep, y = kStep * j + k / kStep;
          if (y >= view.map_height) continue;
          canvas.blend(x, y, colour, 1.0);
          if (is_contour) canvas.blend(x, y, kSurveyContour, 0.45);
        }
      }
    }
    return step_m;
  }

  bool is_flat() const { return high_m_ - low_m_ < 0.5; }

 private:
  static constexpr int kStep = 2, kColumns = kPictureWidth / kStep + 1;

  std::optional<double> at(int i, int j) const {
    return heights_m_[static_cast<std::size_t>(j) * kColumns + i];
  }
  /// Factor on slopes for shading: mountains are shaded like hills, so that drawings on them stay
  /// visible.
  double exaggeration(const PlanView& view) const {
    double sum = 0.0;
    int count = 0;
    for (int j = 0; j + 1 < rows_; ++j) {
      for (int i = 0; i + 1 < kColumns; ++i) {
        const auto h = at(i, j), right = at(i + 1, j), down = at(i, j + 1);
        if (!h || !right || !down) continue;
        sum += std::hypot(*right - *h, *down - *h) * view.px_per_m / kStep;
        ++count;
      }
    }
    constexpr double kPleasant = 0.16;  // mean slope after scaling
    return std::min(1.5, kPleasant / std::max(0.01, count > 0 ? sum / count : 0.0));
  }
  double contour_step_m() const {
    constexpr double kLines = 14.0;
    for (const double step_m : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
      if ((high_m_ - low_m_) / step_m <= kLines) return step_m;
    }
    return 200.0;
  }

  int rows_;
  std::vector<std::optional<double>> heights_m_;
  double low_m_ = 1e9, high_m_ = -1e9;
};

/// Colour of a lane by its position in the order, without the bright end of the scale, which is not
/// visible on paper.
Rgb colour_of(const controllers::SurveyPlan& plan, int lane) {
  const auto at = std::find(plan.order.begin(), plan.order.end(), lane);
  const double count = std::max(1.0, static_cast<double>(plan.order.size()) - 1.0);
  return viridis(0.86 * static_cast<double>(at - plan.order.begin()) / count);
}

void draw_arrow(Canvas& canvas, const Vector2d& tip, const Vector2d& direction, double size,
                const Rgb& colour) {
  const Vector2d u = direction.normalized(), n(-u.y(), u.x());
  canvas.fill({tip + size * u, tip - 0.7 * size * u + 0.7 * size * n, tip - 0.3 * size * u,
               tip - 0.7 * size * u - 0.7 * size * n},
              colour);
}

void draw_path(Canvas& canvas, const PlanView& view, const controllers::SurveyPlan& plan) {
  const auto& points = plan.path.points;
  for (const bool lanes : {false, true}) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const bool is_lane = points[i].kind == PathKind::kLeg;
      if (is_lane != lanes) continue;
      const Vector2d a = view(points[i].p_W), b = view(points[i + 1].p_W);
      if (is_lane) {
        canvas.line(a, b, 4.5, colour_of(plan, points[i].alley));
        continue;
      }
      const bool is_turn = points[i].kind == PathKind::kTurn;
      canvas.line(a, b, is_turn ? 2.0 : 1.4, kPath, is_turn ? 0.95 : 0.7);
      if ((b - a).norm() > 70.0) draw_arrow(canvas, 0.5 * (a + b), b - a, 6.0, kPath);
    }
  }
}

void draw_waypoints(Canvas& canvas, const PlanView& view, const controllers::SurveyPlan& plan) {
  constexpr int kSize_px = 12;
  std::vector<Vector2d> label_positions;
  for (std::size_t i = 0; i < plan.path.points.size(); ++i) {
    const PathPoint& point = plan.path.points[i];
    const Vector2d at = view(point.p_W);
    const Rgb colour = point.alley >= 0 ? colour_of(plan, point.alley) : kPath;
    const auto diamond = render::circle(at, 4.5, 4);
    canvas.fill(diamond, kPaper);
    canvas.outline(diamond, 1.6, colour);
    // Next to the path, where no other number is.
    const Vector2d direction = controllers::direction(point.yaw_rad);
    const Vector2d lateral(-direction.y(), -direction.x());
    for (const double side : {1.0, -1.0}) {
      const Vector2d middle = at + side * 13.0 * lateral;
      const bool is_free =
          std::none_of(label_positions.begin(), label_positions.end(), [&](const Vector2d& other) {
            return std::abs(other.x() - middle.x()) < 22.0 &&
                   std::abs(other.y() - middle.y()) < 13.0;
          });
      if (!is_free) continue;
      label_positions.push_back(middle);
      canvas.text(std::to_string(i), kSize_px, middle + Vector2d(0.0, 0.36 * kSize_px), kInk, 0.5);
      break;
    }
  }
}

void draw_survey_legend(Canvas& canvas, double y, const controllers::SurveyPlan& plan,
                        double contour_m, bool is_flat) {
  double x = kNumberedMargin;
  const auto words = [&](const std::string& text) {
    canvas.text(text, 16, {x, y + 5.5}, kInk);
    x += 8.4 * static_cast<double>(text.size()) + 30.0;
  };
  draw_colour_bar(canvas, x, y - 4.5, 90, 9, [](double share) { return viridis(0.86 * share); });
  x += 98.0;
  words(fmt::format("lanes, first to last ({})", plan.order.size()));
  canvas.line({x, y}, {x + 30, y}, 2.0, kPath);
  x += 38.0;
  words("turns and transit legs");
  canvas.outline(render::rectangle(x, y - 7, x + 24, y + 7), 2.0, kFootprint);
  x += 32.0;
  words("one picture");
  canvas.outline(render::rectangle(x, y - 7, x + 24, y + 7), 2.5, kArea);
  x += 32.0;
  words("area");
  if (!is_flat) {
    canvas.line({x, y}, {x + 30, y}, 2.0, kSurveyContour);
    x += 38.0;
    words(fmt::format("contour interval {:g} m", contour_m));
  }
}

}  // namespace

render::Image draw_survey(const controllers::SurveyRequest& request,
                          const controllers::SurveyPlan& plan,
                          const controllers::GroundHeight& ground, const std::string& title) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : request.polygon_W) box.extend(p);
  for (const PathPoint& point : plan.path.points) box.extend(Vector2d(point.p_W.head<2>()));
  const controllers::SurveyShot& shown = plan.shots[plan.shots.size() / 3];
  const std::vector<Vector2d> footprint_W = footprint_of(request.camera, shown);
  for (const Vector2d& p : footprint_W) box.extend(p);
  const PlanView view(box.min(), box.sizes(), kNumberedMargin, kTallestPlan, kSurveyLegend);
  Canvas canvas(kPictureWidth, view.height, kPaper);
  const Relief relief(view, ground);
  const double contour_m = relief.draw(canvas, view);

  const std::vector<Vector2d> area = view(request.polygon_W), footprint = view(footprint_W);
  canvas.fill(area, kPaper, 0.35);
  canvas.outline(area, 2.5, kArea);
  canvas.fill(footprint, kFootprint, 0.16);
  draw_path(canvas, view, plan);
  canvas.outline(footprint, 2.0, kFootprint);
  const Vector2d middle = view(shown.p_W);
  canvas.line(middle - Vector2d(6, 0), middle + Vector2d(6, 0), 2.0, kFootprint);
  canvas.line(middle - Vector2d(0, 6), middle + Vector2d(0, 6), 2.0, kFootprint);
  draw_waypoints(canvas, view, plan);
  const PathPoint& start = plan.path.points.front();
  const Vector2d heading(std::cos(start.yaw_rad), -std::sin(start.yaw_rad));
  draw_arrow(canvas, view(start.p_W), heading, 13.0, kStart);

  const double top = view.map_height;
  const auto number = [&](const char* name) { return plan.numbers.at(name); };
  canvas.fill(render::rectangle(0, top, kPictureWidth, top + kSurveyLegend), kPaper);
  canvas.text(title, 22, {kNumberedMargin, top + 30.0}, kInk);
  canvas.text(
      fmt::format("{} at {:.0f} m: {:.1f} mm per pixel; {:.0f} lanes {:.1f} m apart; {} waypoints; "
                  "{} pictures, overlap {:.0f} % forward, {:.0f} % side; {:.1f} km in {:.0f} min",
                  request.camera.name, request.height_m, number("gsd_mm"), number("lanes"),
                  number("lane_spacing_m"), plan.path.points.size(), plan.shots.size(),
                  100.0 * number("forward_overlap_min"), 100.0 * number("side_overlap_min"),
                  1e-3 * number("length_m"), number("flight_time_s") / 60.0),
      16, {kNumberedMargin, top + 57.0}, kFaint);
  draw_survey_legend(canvas, top + 90.0, plan, contour_m, relief.is_flat());
  draw_scale_bar(canvas, {kPictureWidth - kNumberedMargin, top + 96.0},
                 0.125 * kPictureWidth / view.px_per_m, view.px_per_m, kInk);
  return canvas.image();
}

}  // namespace vinerow::tools
