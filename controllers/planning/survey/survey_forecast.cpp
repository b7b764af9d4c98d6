#include "controllers/planning/survey/survey_forecast.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

struct Place {
  double ground_m = 0.0;
  int views = -1;  ///< -1: outside the polygon
};

}  // namespace

SurveyForecast forecast_survey(const SurveyRequest& request, const std::vector<SurveyShot>& shots,
                               const GroundHeight& ground, std::optional<Vector2d>& bare_W) {
  constexpr double kPlaces = 20000.0, kMaxCells = 1e6;
  const Polygon& polygon = request.polygon_W;
  Vector2d low = polygon.front(), high = low;
  for (const Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // A narrow polygon fills little of its box: limit the number of the box's cells, too.
  const double cell_m = std::sqrt(
      std::max(std::abs(signed_area_m2(polygon)) / kPlaces, (high - low).prod() / kMaxCells));
  const int columns = static_cast<int>((high.x() - low.x()) / cell_m) + 1;
  const int rows = static_cast<int>((high.y() - low.y()) / cell_m) + 1;
  const auto place_at = [&](int i, int j) {
    return Vector2d(low.x() + (i + 0.5) * cell_m, low.y() + (j + 0.5) * cell_m);
  };
  std::vector<Place> places(static_cast<std::size_t>(columns) * rows);
  double lowest_m = std::numeric_limits<double>::infinity();
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Vector2d p = place_at(i, j);
      if (!contains(polygon, p)) continue;
      const std::optional<double> height_m = ground(p);
      if (!height_m) {
        if (!bare_W) bare_W = p;
        continue;
      }
      places[static_cast<std::size_t>(j) * columns + i] = {*height_m, 0};
      lowest_m = std::min(lowest_m, *height_m);
    }
  }
  const double across = std::tan(request.camera.half_angle_across_rad());
  const double along = std::tan(request.camera.half_angle_along_rad());
  for (const SurveyShot& shot : shots) {
    const Vector2d forward = direction(shot.yaw_rad);
    const double reach_m = std::hypot(across, along) * std::max(0.0, shot.p_W.z() - lowest_m);
    const auto cell_of = [&](double offset_m, int count) {
      return std::clamp(static_cast<int>(std::floor(offset_m / cell_m)), 0, count - 1);
    };
    const int i1 = cell_of(shot.p_W.x() + reach_m - low.x(), columns);
    const int j1 = cell_of(shot.p_W.y() + reach_m - low.y(), rows);
    for (int j = cell_of(shot.p_W.y() - reach_m - low.y(), rows); j <= j1; ++j) {
      for (int i = cell_of(shot.p_W.x() - reach_m - low.x(), columns); i <= i1; ++i) {
        Place& place = places[static_cast<std::size_t>(j) * columns + i];
        if (place.views < 0) continue;
        const Vector2d offset = place_at(i, j) - shot.p_W.head<2>();
        const double above_m = shot.p_W.z() - place.ground_m;
        place.views += std::abs(offset.dot(forward)) <= along * above_m &&
                       std::abs(cross(forward, offset)) <= across * above_m;
      }
    }
  }
  SurveyForecast forecast;
  forecast.min_views = std::numeric_limits<int>::max();
  std::int64_t count = 0, covered = 0, views = 0;
  for (const Place& place : places) {
    if (place.views < 0) continue;
    ++count;
    covered += place.views > 0;
    views += place.views;
    forecast.min_views = std::min(forecast.min_views, place.views);
  }
  if (count == 0) return {};
  forecast.covered_share = static_cast<double>(covered) / static_cast<double>(count);
  forecast.mean_views = static_cast<double>(views) / static_cast<double>(count);
  return forecast;
}

}  // namespace vinerow::controllers
