#include "worlds/mapping/photogrammetry/photogrammetry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "worlds/mapping/photogrammetry/cloud_tiles.h"
#include "worlds/mapping/photogrammetry/hidden_rows.h"
#include "worlds/mapping/photogrammetry/point_colour.h"
#include "worlds/mapping/photogrammetry/tile_views.h"
#include "worlds/mapping/photogrammetry/triangulation.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr SurfaceMask kVisible = kAllSurfaces & ~mask_of(SurfaceClass::kWire);
constexpr double kTallest_m = 6.0;  ///< of what stands on the ground, where tiles look for pictures
/// Rays into the area's rim that start outside of it: what is as high as vines leans by so much.
constexpr double kRim_m = 1.5;
constexpr double kFarthest_m = 1e4;
/// A ray starts so far off its surface: more than single precision of the ray caster blurs it.
constexpr double kLift_m = 2e-3;
constexpr int kMaxPartners = 24;
constexpr double kMinAngle_rad = 0.01;  ///< partners nearer than that add no depth

/// What every tile needs.
struct Survey {
  const SceneQuery& scene;
  const WorldModel& world;
  const std::vector<SurveyView>& views;
  const SurveyArea& area;
  const PhotogrammetryOptions& options;
  const CloudTiles& tiles;
  const PointColour& colour;
  const HiddenRows& missing;
  const Georeference& reference;

  std::optional<double> ground_m(const Vector2d& p) const {
    if (world.terrain) {
      if (!world.terrain->contains(p.x(), p.y())) return std::nullopt;
      return world.terrain->height_m(p.x(), p.y());
    }
    return scene.ground_height_m(p.x(), p.y(), kFarthest_m);
  }
};

/// The survey's area as a tile needs it: most tiles are far inside.
class TileArea {
 public:
  TileArea(const SurveyArea& area, const Vector2d& middle_W)
      : area_(area), middle_W_(middle_W), inside_m_(area.inside_m(middle_W)) {}
  bool contains(const Vector2d& p_W, double further_m = 0.0) const {
    return (p_W - middle_W_).squaredNorm() < inside_m_ * inside_m_ ||
           area_.contains(p_W, further_m);
  }

 private:
  const SurveyArea& area_;
  Vector2d middle_W_;
  double inside_m_;
};

class Matcher {
 public:
  Matcher(const Survey& survey, const TileArea& area, const TileViews& tile)
      : s_(survey), area_(area), tile_(tile) {}

  /// Looks for the point that a picture's ray to `aim_W` meets first.
  /// @returns whether it is seen well enough; then point, hit and triangulation are of it
  bool match(std::uint16_t reference, const Vector3d& aim_W, CloudTally& tally) {
    const SurveyView& view = view_of(reference);
    const Vector3d offset = aim_W - view.p_WS();
    const double distance_m = offset.norm();
    const Vector3d dir = offset / distance_m;
    const auto met = s_.scene.cast_ray(view.p_WS(), dir, distance_m + kRim_m, kVisible);
    if (!met) return false;
    hit_ = *met;
    p_W_ = view.p_WS() + hit_.distance_m * dir;
    if (!area_.contains(p_W_.head<2>())) return false;
    ++tally.aims;
    if (-dir.dot(hit_.normal_W) < min_cosine_) {
      ++tally.unseen;
      return false;
    }
    triangulation_ = Triangulation();
    triangulation_.add(view, p_W_);
    bool wide = false;
    const std::vector<std::uint16_t>& partners = tile_.partners[reference];
    for (auto next = partners.begin(); next != partners.end();) {
      next = find_lines_of_sight(next, partners.end());
      for (std::size_t i = 0; i < lines_; ++i) {
        if (is_blocked_[i]) continue;
        const SurveyView& partner = *partners_[i];
        triangulation_.add(partner, p_W_);
        wide = wide || (p_W_ - partner.p_WS()).normalized().dot(dir) <= max_baseline_cosine_;
      }
      if (triangulation_.views() >= s_.options.max_views) break;
    }
    if (triangulation_.views() < s_.options.min_views) {
      ++tally.unseen;
      return false;
    }
    if (!wide) ++tally.thin;
    return wide;
  }

  const Vector3d& p_W() const { return p_W_; }
  const RayHit& hit() const { return hit_; }
  const Triangulation& triangulation() const { return triangulation_; }

 private:
  const SurveyView& view_of(std::uint16_t k) const {
    return s_.views[static_cast<std::size_t>(tile_.shown_in[k])];
  }

  /// Looks for the next partners that could see the point, as many as it still needs, and for what
  /// is between: rays side by side cost less.
  /// @returns where to go on
  template <class Iterator>
  Iterator find_lines_of_sight(Iterator next, Iterator end) {
    const auto needed = std::min(
        static_cast<std::size_t>(s_.options.max_views - triangulation_.views()), kMaxLines);
    for (lines_ = 0; next != end && lines_ < needed; ++next) {
      const SurveyView& view = view_of(*next);
      if (!view.shows(p_W_)) continue;
      const Vector3d offset = view.p_WS() - p_W_;
      const double distance_m = offset.norm();
      const Vector3d dir = offset / distance_m;
      if (dir.dot(hit_.normal_W) < min_cosine_) continue;
      rays_[lines_] = {p_W_ + kLift_m * hit_.normal_W, dir, distance_m};
      partners_[lines_++] = &view;
    }
    s_.scene.find_blocked(std::span(rays_).first(lines_), std::span(is_blocked_).first(lines_),
                          kVisible);
    return next;
  }

  const Survey& s_;
  const TileArea& area_;
  const TileViews& tile_;
  const double min_cosine_ = std::cos(s_.options.max_incidence_rad);
  const double max_baseline_cosine_ = std::cos(s_.options.min_baseline_rad);
  RayHit hit_;
  Vector3d p_W_ = Vector3d::Zero();
  Triangulation triangulation_;
  // Lines of sight from the point to partners.
  static constexpr std::size_t kMaxLines = 8;
  std::size_t lines_ = 0;
  std::array<SceneRay, kMaxLines> rays_;
  std::array<const SurveyView*, kMaxLines> partners_{};
  std::array<bool, kMaxLines> is_blocked_{};
};

/// A ball around a tile with what stands on it; nothing where there is no ground.
std::optional<std::pair<Vector3d, double>> ball_of(const Survey& survey, std::int64_t tile) {
  constexpr int kProbes = 3;
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
  const Vector2d corner = survey.tiles.corner_W(tile);
  const double width_m = survey.tiles.width_m();
  for (int i = 0; i < kProbes * kProbes; ++i) {
    const Vector2d share(i % kProbes / (kProbes - 1.0), i / kProbes / (kProbes - 1.0));
    const auto ground_m = survey.ground_m(corner + width_m * share);
    if (!ground_m) continue;
    low_m = std::min(low_m, *ground_m);
    high_m = std::max(high_m, *ground_m);
  }
  if (low_m > high_m) return std::nullopt;
  high_m += kTallest_m;
  const Vector2d middle = survey.tiles.middle_W(tile);
  const double radius_m = std::hypot(width_m / std::sqrt(2.0), 0.5 * (high_m - low_m)) + 1.0;
  return std::pair(Vector3d(middle.x(), middle.y(), 0.5 * (low_m + high_m)), radius_m);
}

void sample_tile(const Survey& survey, std::int64_t tile, std::vector<SampledPoint>& points,
                 CloudTally& tally) {
  const Vector2d corner = survey.tiles.corner_W(tile);
  const double width_m = survey.tiles.width_m();
  const Vector2d middle = survey.tiles.middle_W(tile);
  // No aim is farther from the middle than a corner.
  if (!survey.area.contains(middle, kRim_m + width_m)) return;
  const auto ball = ball_of(survey, tile);
  if (!ball) return;
  const TileViews views =
      find_tile_views(survey.views, ball->first, ball->second, kMinAngle_rad, kMaxPartners);
  if (views.shown_in.empty()) return;
  RandomStream random(survey.options.seed, "cloud", fmt::format("photogrammetry.tile_{}", tile));
  const TileArea area(survey.area, middle);
  Matcher matcher(survey, area, views);
  const int side = survey.tiles.side();
  const double cell_m = survey.tiles.cell_m();
  // Most tiles are whole in all of their pictures: then no place need be looked up in them.
  const bool all_whole =
      std::find(views.whole.begin(), views.whole.end(), false) == views.whole.end();
  std::vector<std::uint16_t> showing(views.shown_in.size());
  std::iota(showing.begin(), showing.end(), std::uint16_t{0});
  for (int cell = 0; cell < side * side; ++cell) {
    const double v = random.uniform(), u = random.uniform();
    const Vector2d aim = corner + cell_m * Vector2d(cell % side + u, cell / side + v);
    const double chance = random.uniform();
    if (!area.contains(aim, kRim_m)) continue;
    const auto ground_m = survey.ground_m(aim);
    if (!ground_m) continue;
    const Vector3d aim_W(aim.x(), aim.y(), *ground_m);
    if (!all_whole) {
      showing.clear();
      for (std::size_t k = 0; k < views.shown_in.size(); ++k) {
        if (views.whole[k] ||
            survey.views[static_cast<std::size_t>(views.shown_in[k])].shows(aim_W)) {
          showing.push_back(static_cast<std::uint16_t>(k));
        }
      }
    }
    if (showing.empty()) continue;
    const auto reference =
        showing[static_cast<std::size_t>(chance * static_cast<double>(showing.size()))];
    if (!matcher.match(reference, aim_W, tally)) continue;
    const double n_x = random.normal(), n_y = random.normal(), n_z = random.normal();
    const Vector3d error =
        matcher.triangulation().error_m(survey.options.match_px, {n_x, n_y, n_z});
    SampledPoint point;
    point.p_W = matcher.p_W() + error + survey.reference.error_m(matcher.p_W());
    point.rgb = survey.colour.of(matcher.hit(), matcher.p_W(), random.uniform());
    point.truth = class_of(matcher.hit().surface);
    if (survey.missing.hide(matcher.p_W(), point.truth)) {
      ++tally.missing;
      continue;
    }
    points.push_back(point);
    ++tally.points;
    tally.ground_points += point.truth == PointClass::kGround ? 1 : 0;
    tally.canopy_points += point.truth == PointClass::kCanopy ? 1 : 0;
    tally.views += matcher.triangulation().views();
    tally.horizontal_error2_m2 += error.head<2>().squaredNorm();
    tally.height_error2_m2 += error.z() * error.z();
  }
}

/// Views that may show the area, and the mean ground sampling distance of those.
std::vector<SurveyView> views_of(const SceneQuery& scene, const SurveyCamera& camera,
                                 const std::vector<Pose>& poses, const SurveyArea& area,
                                 double& gsd_m) {
  const Eigen::AlignedBox2d box = area.box_W();
  std::vector<SurveyView> views;
  double sum_m = 0.0;
  for (const Pose& pose : poses) {
    const SurveyView view(camera, pose);
    const auto axis =
        scene.cast_ray(view.p_WS(), view.axis_W(), kFarthest_m, mask_of(SurfaceClass::kTerrain));
    if (!axis) continue;
    // A ball around the area, wide enough for slopes of 45 deg across it.
    const double z = scene.ground_height_m(box.center().x(), box.center().y(), kFarthest_m)
                         .value_or(view.p_WS().z() + axis->distance_m * view.axis_W().z());
    if (!view.may_show({box.center().x(), box.center().y(), z},
                       std::sqrt(0.5) * box.diagonal().norm() + kTallest_m)) {
      continue;
    }
    views.push_back(view);
    sum_m += camera.gsd_m(axis->distance_m);
  }
  gsd_m = views.empty() ? 0.0 : sum_m / static_cast<double>(views.size());
  return views;
}

}  // namespace

void check_options(const PhotogrammetryOptions& options) {
  const auto refuse = [](const std::string& text) { throw ConfigError(text); };
  if (!(options.match_px >= 0.0) || !std::isfinite(options.match_px)) {
    refuse(fmt::format("the matching error is {} pixels, must be 0 or more", options.match_px));
  }
  if (options.min_views < 2) {
    refuse(
        fmt::format("a point is seen by {} pictures at least, must be two or more: one alone "
                    "has no depth",
                    options.min_views));
  }
  if (options.max_views < options.min_views) {
    refuse(fmt::format("min_views = {}, must be <= max_views = {}", options.min_views,
                       options.max_views));
  }
  if (!(options.max_incidence_rad > 0.0 && options.max_incidence_rad < 1.5707)) {
    refuse(
        fmt::format("the largest angle off a surface's normal is {:.1f} deg, must be above 0 "
                    "and below 90 deg",
                    options.max_incidence_rad * 57.29578));
  }
  if (!(options.min_baseline_rad >= 0.0 && options.min_baseline_rad < 3.1416)) {
    refuse(fmt::format("the least angle between rays is {:.1f} deg, must be 0 to 180 deg",
                       options.min_baseline_rad * 57.29578));
  }
}

void CloudTally::add(const CloudTally& other) {
  points += other.points;
  ground_points += other.ground_points;
  canopy_points += other.canopy_points;
  views += other.views;
  horizontal_error2_m2 += other.horizontal_error2_m2;
  height_error2_m2 += other.height_error2_m2;
  aims += other.aims;
  unseen += other.unseen;
  thin += other.thin;
  outliers += other.outliers;
  missing += other.missing;
}

double CloudTally::mean_views() const {
  return points > 0 ? views / static_cast<double>(points) : 0.0;
}

double CloudTally::horizontal_rms_m() const {
  return points > 0 ? std::sqrt(horizontal_error2_m2 / static_cast<double>(points)) : 0.0;
}

double CloudTally::height_rms_m() const {
  return points > 0 ? std::sqrt(height_error2_m2 / static_cast<double>(points)) : 0.0;
}

PhotogrammetryReport sample_photogrammetry(const SceneQuery& scene, const WorldModel& world,
                                           const SurveyCamera& camera,
                                           const std::vector<Pose>& poses, const SurveyArea& area,
                                           const PhotogrammetryOptions& options,
                                           const CloudSink& sink, const Georeference& reference) {
  check_options(options);
  PhotogrammetryReport report;
  const std::vector<SurveyView> views = views_of(scene, camera, poses, area, report.gsd_m);
  if (views.empty()) {
    throw ConfigError(fmt::format("none of the {} pictures shows the cloud's area", poses.size()));
  }
  // Places of views are counted in 16 bits within a tile.
  if (views.size() > std::numeric_limits<std::uint16_t>::max()) {
    throw ConfigError(fmt::format("{} pictures show the cloud's area, must be at most {}",
                                  views.size(), std::numeric_limits<std::uint16_t>::max()));
  }
  report.pictures = static_cast<int>(views.size());
  report.density_per_m2 = options.density_per_m2.value_or(1.0 / (report.gsd_m * report.gsd_m));
  const CloudTiles tiles(area, kRim_m, report.density_per_m2);
  const PointColour colour(world);
  const HiddenRows missing(world, options.missing_rows);
  const Survey survey{scene, world, views, area, options, tiles, colour, missing, reference};
  std::vector<CloudTally> tallies(static_cast<std::size_t>(tiles.count()));
  stream_points(
      tiles.count(),
      [&](std::int64_t tile, std::vector<SampledPoint>& points) {
        sample_tile(survey, tile, points, tallies[static_cast<std::size_t>(tile)]);
      },
      [&](std::int64_t tile) { report.tally.add(tallies[static_cast<std::size_t>(tile)]); }, sink);
  return report;
}

}  // namespace vinerow::mapping
