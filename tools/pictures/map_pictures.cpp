#include "tools/pictures/map_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/api/world_model.h"
#include "engine/render/caption.h"
#include "tools/pictures/cloud_view.h"
#include "tools/pictures/grid_picture.h"
#include "tools/pictures/legend.h"
#include "tools/pictures/picture_style.h"
#include "tools/pictures/row_lookup.h"

namespace vinerow::tools {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using mapping::PointClass;

constexpr Rgb kGroundPoints = {172, 144, 112}, kLow = {196, 192, 88}, kOther = {142, 146, 150};
constexpr Rgb kRows[2] = {{46, 122, 52}, {104, 172, 62}};
constexpr int kStrip = 74;
constexpr std::size_t kMaxSplats = 6'000'000;

/// Stride n for drawing every n-th point, at most `max_points` points.
std::size_t stride_of(const mapping::ParcelCloud& cloud, std::size_t max_points) {
  return std::max<std::size_t>(1, (cloud.points.size() + max_points - 1) / max_points);
}

/// Map prepared for drawing: heights above the ground, and rows by position.
class Scene {
 public:
  Scene(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud)
      : map_(map), cloud_(cloud), rows_(map.map.rows, 1.5) {
    top_m_ = std::max(0.5, map.report.canopy_top_m);
  }

  double above_m(const Vector3d& p) const {
    return map_.map.terrain ? p.z() - map_.map.terrain->height_m(p.x(), p.y()) : p.z();
  }
  /// Index of the row at a point, or -1.
  int row_at(const Vector3d& p) const { return rows_.row_at(p.x(), p.y()); }

  /// Colour by class; higher points are lighter, and neighbouring points vary slightly.
  Rgb colour_of(std::size_t k, const Vector3d& p) const {
    Rgb colour = kOther;
    double light = 1.0;
    switch (cloud_.classes[k]) {
      case mapping::PointClass::kGround:
        colour = kGroundPoints;
        break;
      case mapping::PointClass::kLowVegetation:
        colour = kLow;
        break;
      case mapping::PointClass::kCanopy:
        colour = kRows[static_cast<std::size_t>(std::max(0, row_at(p))) % std::size(kRows)];
        light = 0.62 + 0.55 * std::clamp(above_m(p) / top_m_, 0.0, 1.1);
        break;
      default:
        light = 0.75 + 0.08 * std::clamp(above_m(p), 0.0, 5.0);
    }
    light *= 0.93 + 0.14 * static_cast<double>((k * 2654435761u >> 16) & 255u) / 255.0;
    for (int& c : colour) c = static_cast<int>(std::lround(c * light));
    return colour;
  }

  /// Colour from the cloud, or by class if the cloud is uncoloured.
  Rgb natural_colour_of(std::size_t k, const Vector3d& p) const {
    if (cloud_.colours.empty()) return colour_of(k, p);
    const auto& rgb = cloud_.colours[k];
    return {rgb[0], rgb[1], rgb[2]};
  }

  /// Splat size at which every `stride`-th point covers the ground.
  float splat_m(std::size_t stride) const {
    const double per_m2 = std::max(1.0, map_.report.density_per_m2) / static_cast<double>(stride);
    return static_cast<float>(std::clamp(1.7 / std::sqrt(per_m2), 0.015, 0.6));
  }

  const mapping::CloudMap& map() const { return map_; }
  const mapping::ParcelCloud& cloud() const { return cloud_; }

 private:
  const mapping::CloudMap& map_;
  const mapping::ParcelCloud& cloud_;
  RowLookup rows_;
  double top_m_;
};

Vector2d mean_direction(const RowMap& map) {
  const auto& line = map.rows[map.rows.size() / 2].line_W;
  return (line.back() - line.front()).head<2>().normalized();
}

/// Points of the parcel that must be in the picture.
std::vector<Vector3d> frame_points(const RowMap& map) {
  std::vector<Vector3d> points;
  for (const PlantRow& row : map.rows) {
    for (const Vector3d& p : row.line_W) {
      points.push_back(p);
      points.emplace_back(p.x(), p.y(), p.z() + row.canopy_top_m);
    }
  }
  return points;
}

/// Camera that looks across the rows from the lower side, turned by a third towards their end.
render::Camera parcel_camera(const RowMap& map, double aspect) {
  const Vector2d along = mean_direction(map), across(-along.y(), along.x());
  const auto& first = map.rows.front().line_W;
  const auto& last = map.rows.back().line_W;
  // The downhill side is in front, so that the rear rows appear above the front rows.
  const double rise =
      map.terrain ? (last[last.size() / 2].z() - first[first.size() / 2].z()) *
                        (last[last.size() / 2] - first[first.size() / 2]).head<2>().dot(across)
                  : 0.0;
  const Vector2d ahead = (rise < 0.0 ? -across : across) + 0.3 * along;
  constexpr double kElevation_rad = 0.56;
  return camera_around(frame_points(map), std::atan2(ahead.y(), ahead.x()), kElevation_rad, aspect);
}

/// Draws the map's ground under the rows, where leaves hid it from the cloud; slightly lower than
/// the points, so that they stay visible.
void draw_ground_below_rows(const Scene& scene, CloudView& view) {
  constexpr double kLower_m = 0.06, kLateralOffset_m = 0.35, kStep_m = 0.5;
  if (!scene.map().map.terrain) return;
  const HeightField& terrain = *scene.map().map.terrain;
  for (const PlantRow& row : scene.map().map.rows) {
    const double half_m = 0.5 * row.canopy_width_m + kLateralOffset_m;
    for (std::size_t k = 0; k + 1 < row.line_W.size(); ++k) {
      const Vector2d a = row.line_W[k].head<2>(), d = row.line_W[k + 1].head<2>() - a;
      const Vector2d side = half_m * Vector2d(-d.y(), d.x()).normalized();
      const int steps = std::max(1, static_cast<int>(std::ceil(d.norm() / kStep_m)));
      const auto place = [&](int step, double to_left) {
        const Vector2d p = a + d * step / steps + to_left * side;
        return Vector3d(p.x(), p.y(), terrain.height_m(p.x(), p.y()) - kLower_m);
      };
      for (int step = 0; step < steps; ++step) {
        const Vector3d left = place(step, 1.0), right = place(step, -1.0);
        const Vector3d next_left = place(step + 1, 1.0), next_right = place(step + 1, -1.0);
        view.triangle(left, right, next_right, kGroundPoints);
        view.triangle(left, next_right, next_left, kGroundPoints);
      }
    }
  }
}

void splat_cloud(const Scene& scene, CloudView& view, bool with_canopy, std::size_t max_points) {
  const mapping::ParcelCloud& cloud = scene.cloud();
  const std::size_t stride = stride_of(cloud, max_points);
  const float size_m = scene.splat_m(stride);
  for (std::size_t k = 0; k < cloud.points.size(); k += stride) {
    if (!with_canopy && cloud.classes[k] == mapping::PointClass::kCanopy) continue;
    const Vector3d p = cloud.point_W(k);
    view.splat(p, size_m, scene.colour_of(k, p));
  }
}

void draw_row_meshes(const RowMap& map, CloudView& view, bool with_edges) {
  for (const RowMesh& mesh : map.meshes) {
    std::size_t index = 0;
    while (index + 1 < map.rows.size() && map.rows[index].id != mesh.row) ++index;
    const auto& vertices = mesh.mesh_W.vertices;
    for (const auto& t : mesh.mesh_W.triangles) {
      const Vector3d corners[3] = {vertices[t[0]].cast<double>(), vertices[t[1]].cast<double>(),
                                   vertices[t[2]].cast<double>()};
      Rgb colour = kRows[index % std::size(kRows)];
      for (int& c : colour) c = static_cast<int>(1.25 * c);
      view.triangle(corners[0], corners[1], corners[2], colour);
      if (!with_edges) continue;
      for (int k = 0; k < 3; ++k) {
        // Each edge belongs to two triangles; draw it once.
        if (t[k] > t[(k + 1) % 3]) continue;
        view.line(corners[k], corners[(k + 1) % 3], 0.6, {18, 48, 26});
      }
    }
  }
}

/// Canvas with a picture and a strip below it.
Canvas framed(const render::Image& picture, int strip_px) {
  Canvas canvas(picture.width, picture.height + strip_px, kPaper);
  canvas.paste(picture, 0, 0);
  return canvas;
}

void draw_class_legend(Canvas& canvas, double y,
                       const std::vector<std::pair<Rgb, std::string>>& entries) {
  double x = kNarrowMargin;
  for (const auto& [colour, words] : entries) {
    draw_legend_patch(canvas, x, y, colour, words);
    x += 58.0 + render::text_width(words, 16);
  }
}

std::string millions(std::int64_t count) {
  return count < 100'000 ? fmt::format("{}", count)
                         : fmt::format("{:.1f} million", 1e-6 * static_cast<double>(count));
}

/// Draws the row numbers on the canopy at the nearer row ends. In front of the ends, on a slope, a
/// number would be next to another row.
void draw_row_numbers(Canvas& canvas, const CloudView& view, const RowMap& map,
                      const render::Camera& camera) {
  constexpr int kSize_px = 17;
  constexpr double kRadius_px = 13.0;
  constexpr double kHeight = 0.75;  // share of the canopy's top
  std::optional<Vector2d> drawn;
  const auto& middle = map.rows[map.rows.size() / 2].line_W;
  const auto distance_m = [&](const Vector3d& p) { return (p - camera.X_WC.p).norm(); };
  const bool last = distance_m(middle.back()) < distance_m(middle.front());
  for (const PlantRow& row : map.rows) {
    const Vector3d& end = last ? row.line_W.back() : row.line_W.front();
    const auto at = view.pixel_of(end + Vector3d(0.0, 0.0, kHeight * row.canopy_top_m));
    // Leave out numbers that would overlap.
    if (!at || (drawn && (*at - *drawn).norm() < 2.0 * kRadius_px)) continue;
    drawn = at;
    const auto disc = render::circle(*at, kRadius_px, 24);
    canvas.fill(disc, kPaper, 0.92);
    canvas.outline(disc, 1.5, kInk);
    canvas.text(std::to_string(row.id), kSize_px, *at + Vector2d(0.0, 0.36 * kSize_px), kInk, 0.5);
  }
}

/// Middle of the row nearest to the middle of the block that has canopy there.
Vector3d stretch_middle(const RowMap& map) {
  const PlantRow& row = map.rows[map.rows.size() / 2];
  Vector3d wanted = row.line_W[row.line_W.size() / 2];
  if (row.line_W.size() == 2) wanted = 0.5 * (row.line_W[0] + row.line_W[1]);
  Vector3d nearest = wanted;
  double nearest_m = 1e300;
  for (const RowMesh& mesh : map.meshes) {
    if (mesh.row != row.id || mesh.mesh_W.vertices.size() < 40) continue;
    for (const Eigen::Vector3f& v : mesh.mesh_W.vertices) {
      const double apart_m = (v.cast<double>() - wanted).head<2>().norm();
      if (apart_m < nearest_m) nearest_m = apart_m, nearest = v.cast<double>();
    }
  }
  return nearest;
}

}  // namespace

render::Image draw_classes(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                           const std::string& title) {
  constexpr int kHeight = 860;
  const Scene scene(map, cloud);
  const render::Camera camera =
      parcel_camera(map.map, static_cast<double>(kPictureWidth) / kHeight);
  CloudView view(camera, kPictureWidth, kHeight);
  draw_ground_below_rows(scene, view);
  splat_cloud(scene, view, true, kMaxSplats);
  Canvas canvas = framed(view.finish(kPaper), kStrip);
  draw_row_numbers(canvas, view, map.map, camera);
  const mapping::CloudMapReport& r = map.report;
  canvas.text(title, 22, {kNarrowMargin, kHeight + 26.0}, kInk);
  draw_class_legend(
      canvas, kHeight + 44.0,
      {{kRows[0], "canopy, rows alternating: " + share_text(r.canopy_points, r.points)},
       {kGroundPoints, "ground: " + share_text(r.ground_points, r.points)},
       {kLow, "low vegetation: " + share_text(r.low_points, r.points)},
       {kOther, "other: " + share_text(r.other_points, r.points)}});
  const std::string size =
      fmt::format("{} points, {:.0f} per m²", millions(r.points), r.density_per_m2);
  canvas.text(size, 16,
              {kPictureWidth - kNarrowMargin - render::text_width(size, 16), kHeight + 26.0},
              kFaint);
  return canvas.image();
}

render::Image draw_meshes(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                          const std::string& title) {
  constexpr int kHeight = 760, kDetailHeight = 520, kGap = 8, kHalf = (kPictureWidth - kGap) / 2;
  const Scene scene(map, cloud);
  const render::Camera whole_camera =
      parcel_camera(map.map, static_cast<double>(kPictureWidth) / kHeight);
  CloudView whole(whole_camera, kPictureWidth, kHeight);
  draw_ground_below_rows(scene, whole);
  splat_cloud(scene, whole, false, kMaxSplats / 2);
  draw_row_meshes(map.map, whole, false);

  // A few metres of three rows, seen from the side.
  const Vector2d along = mean_direction(map.map);
  const Vector3d middle = stretch_middle(map.map);
  constexpr double kReach_m = 3.2, kDetailReach_m = 12.0;
  std::vector<Vector3d> shown;
  for (const double s : {-kReach_m, kReach_m}) {
    for (const double z : {-0.3, map.report.canopy_top_m}) {
      const double ground_m =
          map.map.terrain
              ? map.map.terrain->height_m(middle.x() + s * along.x(), middle.y() + s * along.y())
              : middle.z();
      shown.emplace_back(middle.x() + s * along.x(), middle.y() + s * along.y(), ground_m + z);
    }
  }
  const Vector3d looks = whole_camera.X_WC.q * Vector3d::UnitZ();
  const render::Camera camera = camera_around(shown, std::atan2(looks.y(), looks.x()), 0.42,
                                              static_cast<double>(kHalf) / kDetailHeight, 0.02);
  constexpr float kSoft = 0.25f;
  CloudView points(camera, kHalf, kDetailHeight), meshes(camera, kHalf, kDetailHeight);
  // Near the camera draw every point: there are few.
  const float size_m = std::max(0.02f, scene.splat_m(1));
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    const Vector3d p = cloud.point_W(k);
    if ((p - middle).head<2>().squaredNorm() > kDetailReach_m * kDetailReach_m) continue;
    const Rgb colour = scene.natural_colour_of(k, p);
    points.splat(p, size_m, colour);
    if (cloud.classes[k] != mapping::PointClass::kCanopy) meshes.splat(p, size_m, colour);
  }
  draw_row_meshes(map.map, meshes, true);
  for (CloudView* view : {&points, &meshes}) draw_ground_below_rows(scene, *view);

  Canvas canvas(kPictureWidth, kHeight + kGap + kDetailHeight + kStrip, kPaper);
  canvas.paste(whole.finish(kPaper), 0, 0);
  canvas.paste(points.finish(kPaper, kSoft), 0, kHeight + kGap);
  canvas.paste(meshes.finish(kPaper, kSoft), kHalf + kGap, kHeight + kGap);
  draw_row_numbers(canvas, whole, map.map, whole_camera);
  const double top = kHeight + kGap + kDetailHeight;
  const mapping::CloudMapReport& r = map.report;
  canvas.text(title, 22, {kNarrowMargin, top + 26.0}, kInk);
  canvas.text(
      fmt::format("Above: the parcel with its row meshes. Below: the points of a section of "
                  "row {}, and its mesh.",
                  map.map.rows[map.map.rows.size() / 2].id),
      16, {kNarrowMargin, top + 54.0}, kFaint);
  const std::string size = fmt::format("{} triangles, {:.2f} MB instead of {:.1f} MB", r.triangles,
                                       1e-6 * static_cast<double>(r.mesh_bytes),
                                       1e-6 * static_cast<double>(r.cloud_bytes));
  canvas.text(size, 16, {kPictureWidth - kNarrowMargin - render::text_width(size, 16), top + 26.0},
              kFaint);
  return canvas.image();
}

render::Image draw_map_grid(const mapping::CloudMap& map, const mapping::OccupancyOptions& options,
                            const std::string& title) {
  WorldModel world;
  world.name = title;
  world.rows = map.map;
  return draw_grid(world, mapping::plan_occupancy(map.map, options), title);
}

}  // namespace vinerow::tools
