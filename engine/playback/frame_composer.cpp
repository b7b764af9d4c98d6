#include "engine/playback/frame_composer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/physics/world_scene.h"
#include "engine/playback/clear_view.h"
#include "engine/playback/estimate_drawing.h"
#include "engine/playback/frame_words.h"
#include "engine/playback/vehicle_colours.h"
#include "engine/render/cameras.h"

namespace vinerow::playback {
namespace {

const Eigen::Vector3f kPlanColour{0.05f, 0.45f, 1.0f};
const Eigen::Vector3f kTreeColour{0.95f, 0.97f, 0.86f};
const Eigen::Vector3f kRayColour{1.0f, 0.25f, 0.1f};
/// Smallest height above ground of a chase camera behind a flying vehicle.
constexpr double kMinEyeHeight_m = 0.5;
/// Largest number of a laser scan's beams that are drawn; every echo is drawn.
constexpr std::size_t kMaxBeams = 120;
/// Height of an echo's mark.
constexpr double kEchoMark_m = 0.05;
/// Smallest distance between two points of a trail.
constexpr double kTrailPitch_m = 0.1;
/// Ages at which a trail in an oblique view begins to fade, and at which it has vanished.
constexpr double kTrailFades_s = 8.0, kTrailGone_s = 40.0;
constexpr float kTrailAlpha = 0.9f;
/// Largest time between two points of a fading line, so that single segments are not visible.
constexpr double kFadeStep_s = 0.5;

double trail_length_m(const std::vector<Eigen::Vector3d>& points) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) sum_m += (points[i + 1] - points[i]).norm();
  return sum_m;
}

}  // namespace

FrameComposer::FrameComposer(const scenario::Scenario& scenario, const WorldModel& world,
                             const std::vector<std::unique_ptr<Vehicle>>& vehicles,
                             const LogTrace& trace, ComposerOptions options)
    : scenario_(scenario),
      world_(world),
      vehicles_(vehicles),
      trace_(trace),
      options_(std::move(options)) {
  for (const PlantRow& row : world.rows->rows) {
    for (const Eigen::Vector3d& p : row.line_W)
      extent_W_.extend(p).extend(p + Eigen::Vector3d(0, 0, row.canopy_top_m));
  }
  const bool on_meshes = !world.terrain && !world.meshes.empty();
  if (on_meshes || options_.seeks_clear_views) {
    scene_ = std::make_unique<physics::WorldScene>(world);
  }
  if (on_meshes) ground_.emplace(world, *scene_);
  // A world without rows has the extent of its meshes.
  for (const MeshInstance& instance : world.meshes) {
    if (!world.rows->rows.empty() || !instance.visible) continue;
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      extent_W_.extend(instance.X_WM * v.cast<double>());
    }
  }
  const bool all_winged = std::all_of(vehicles.begin(), vehicles.end(), [](const auto& vehicle) {
    return vehicle->description().fixed_wing.has_value();
  });
  for (std::size_t v = 0; v < vehicles.size(); ++v) {
    if (vehicles[v]->description().fixed_wing && !all_winged) continue;
    const VehicleTrace& vehicle = trace_of(scenario.vehicles[v].name);
    for (const Odometry& truth : vehicle.truth.values) extent_W_.extend(truth.X_WB.p);
    for (const PlannedPath& plan : vehicle.plan.values) {
      for (const PathPoint& point : plan.points) extent_W_.extend(point.p_W);
    }
  }
  // Both live longer than the frames that point to the grid.
  const OccupancyGrid& grid = trace.map.empty() ? world.rows->occupancy : trace.map;
  if (!grid.empty()) grid_ = {std::shared_ptr<const OccupancyGrid>(), &grid};
  if (extent_W_.isEmpty())
    extent_W_ = Eigen::AlignedBox3d(Eigen::Vector3d(-10, -10, 0), Eigen::Vector3d(10, 10, 2));
  parcel_W_ = extent_W_;
  for (const Eigen::Vector2d& p : world.rows->boundary_W) {
    parcel_W_.extend(Eigen::Vector3d(p.x(), p.y(), extent_W_.center().z()));
  }
}

std::optional<ShotView> view_of(const Trace<CameraShot>& shots) {
  for (const CameraShot& shot : shots.values) {
    if (!shot.on_ground) continue;
    const Eigen::Vector3d upper_left_S = shot.X_WS.inverse() * shot.corners_W[0];
    return ShotView{upper_left_S.y() / upper_left_S.x(), upper_left_S.z() / upper_left_S.x()};
  }
  return std::nullopt;
}

const Trace<CameraShot>& FrameComposer::shots_of(const scenario::CameraConfig& camera) const {
  return trace_of(camera.vehicle).shots.at(camera.sensor);
}

const VehicleTrace& FrameComposer::trace_of(const std::string& vehicle) const {
  return trace_.vehicles.at(vehicle);
}

bool FrameComposer::looks_out_of(const scenario::CameraConfig& camera, const std::string& vehicle) {
  return (camera.kind == scenario::CameraKind::kOnBoard ||
          camera.kind == scenario::CameraKind::kShots) &&
         camera.vehicle == vehicle;
}

bool FrameComposer::flies(const std::string& vehicle) const {
  for (std::size_t v = 0; v < scenario_.vehicles.size(); ++v) {
    if (scenario_.vehicles[v].name == vehicle) return vehicles_[v]->description().flies();
  }
  return false;
}

double FrameComposer::ground_m(double x, double y) const {
  if (world_.terrain) return world_.terrain->height_m(x, y);
  return ground_ ? ground_->height_m(x, y).value_or(0.0) : 0.0;
}

render::Camera FrameComposer::place(const scenario::CameraConfig& camera, Time t,
                                    double aspect) const {
  const bool follows = !camera.vehicle.empty() && !trace_of(camera.vehicle).truth.empty();
  const Pose X_WB = follows ? trace_of(camera.vehicle).truth_at(t).X_WB : Pose{};
  switch (camera.kind) {
    case scenario::CameraKind::kChase:
      return place_chase(camera, t, aspect);
    case scenario::CameraKind::kOnBoard:
      return render::on_board_camera(
          X_WB, {quaternion_from_rpy({0.0, camera.pitch_rad, camera.yaw_rad}), camera.offset_B},
          camera.fov_rad);
    case scenario::CameraKind::kTop: {
      if (camera.height_m <= 0.0 || !(follows || camera.centre_W)) {
        return render::top_camera(camera.show_grid ? parcel_W_ : extent_W_, aspect);
      }
      Eigen::Vector3d centre = X_WB.p;
      if (camera.centre_W) {
        const Eigen::Vector2d& c = *camera.centre_W;
        centre = {c.x(), c.y(), ground_m(c.x(), c.y())};
      }
      const Eigen::Vector3d half(0.5 * camera.height_m * aspect, 0.5 * camera.height_m, 1.0);
      return render::top_camera(Eigen::AlignedBox3d(centre - half, centre + half), aspect, 0.0);
    }
    case scenario::CameraKind::kShots: {
      const Trace<CameraShot>& shots = shots_of(camera);
      return render::on_board_camera(shots.values[shots.index_at(t)].X_WS, Pose{},
                                     2.0 * std::atan(view_of(shots)->along));
    }
    case scenario::CameraKind::kFixed:
      break;
  }
  const Eigen::Vector3d eye =
      camera.p_W + Eigen::Vector3d(0, 0, ground_m(camera.p_W.x(), camera.p_W.y()));
  const Eigen::Vector3d target =
      camera.target_W + Eigen::Vector3d(0, 0, ground_m(camera.target_W.x(), camera.target_W.y()));
  return render::look_at(eye, target, camera.fov_rad);
}

render::Camera FrameComposer::place_chase(const scenario::CameraConfig& camera, Time t,
                                          double aspect) const {
  const Trace<Odometry>& truth = trace_of(camera.vehicle).truth;
  const Pose X_WB = truth.empty() ? Pose{} : odometry_at(truth, t).X_WB;
  render::ChaseOptions requested;
  requested.distance_m = camera.distance_m;
  requested.height_m = camera.height_m;
  requested.side_rad = camera.yaw_rad;
  requested.fov_rad = camera.fov_rad;
  requested.follows_slope = !flies(camera.vehicle);
  const auto above_ground = [&](render::ChaseOptions options) {
    if (options.follows_slope) return render::chase_camera(X_WB, options);
    // Behind a vehicle that flies along a slope, the ground may be higher than the eye.
    const Eigen::Vector3d eye = render::chase_camera(X_WB, options).X_WC.p;
    const double min_m = ground_m(eye.x(), eye.y()) + kMinEyeHeight_m;
    options.height_m += std::max(0.0, min_m - eye.z());
    return render::chase_camera(X_WB, options);
  };
  // Views that compare estimates or a map with the truth keep the requested position.
  if (!options_.seeks_clear_views || camera.show_estimate || camera.show_map) {
    return above_ground(requested);
  }
  Subject subject;
  for (std::size_t v = 0; v < scenario_.vehicles.size(); ++v) {
    std::vector<Eigen::Vector3d> points = points_at(v, t);
    if (scenario_.vehicles[v].name == camera.vehicle) {
      subject.points_W = std::move(points);
    } else {
      subject.others_W.push_back(std::move(points));
    }
  }
  std::vector<render::Camera> candidates;
  for (const render::ChaseOptions& options : chase_candidates(requested)) {
    candidates.push_back(above_ground(options));
  }
  return find_clear_view(candidates, aspect, subject, *scene_);
}

std::vector<Eigen::Vector3d> FrameComposer::points_at(std::size_t vehicle, Time t) const {
  const VehicleTrace& trace = trace_of(scenario_.vehicles[vehicle].name);
  std::vector<Eigen::Vector3d> points =
      vinerow::playback::points_of(vehicles_[vehicle]->links(), trace.links_at(t));
  if (points.empty() && !trace.truth.empty()) points.push_back(trace.truth_at(t).X_WB.p);
  return points;
}

bool FrameComposer::works(const std::string& vehicle, Time t) const {
  return work_at(scenario_, vehicle, t, options_.phases).has_value();
}

void FrameComposer::add_trails(const scenario::CameraConfig& camera, Time t,
                               render::Frame& frame) const {
  for (std::size_t v = 0; v < scenario_.vehicles.size(); ++v) {
    const scenario::VehicleConfig& config = scenario_.vehicles[v];
    const Trace<Odometry>& truth = trace_of(config.name).truth;
    if (truth.empty() || looks_out_of(camera, config.name)) continue;
    // A top view shows the whole trail of the present work. In an oblique view an old trail would
    // be a line in the sky, so it fades, unless it is compared with an estimate's trail.
    const bool fades = camera.kind != scenario::CameraKind::kTop && !camera.show_estimate;
    const auto work = work_at(scenario_, config.name, t, options_.phases);
    if (!work) continue;
    Time from = work->begin;
    if (fades) from = std::max(from, t - duration_from_s(kTrailGone_s));
    render::Polyline trail;
    trail.colour = vehicle_colour(v).rgb;
    trail.width_px = camera.kind == scenario::CameraKind::kTop ? 3.0f : 4.0f;
    trail.alpha = kTrailAlpha;
    const double down_m = vehicles_[v]->description().height_above_ground_m - kHover_m;
    const std::size_t end = truth.index_at(t);
    Time last;
    for (std::size_t i = truth.index_at(from); i <= end; ++i) {
      const Eigen::Vector3d p = truth.values[i].X_WB * Eigen::Vector3d(0, 0, -down_m);
      const Time at = truth.times[i];
      const bool moved =
          trail.points_W.empty() || (trail.points_W.back() - p).norm() >= kTrailPitch_m;
      // While the vehicle is stationary no points are added, except to fade, and the last one.
      if (!moved && i != end && !(fades && (at - last).s() >= kFadeStep_s)) continue;
      last = at;
      trail.points_W.push_back(p);
      if (!fades) continue;
      const double age_s = (t - at).s();
      trail.fade.push_back(static_cast<float>(
          std::clamp((kTrailGone_s - age_s) / (kTrailGone_s - kTrailFades_s), 0.0, 1.0)));
    }
    if (trail_length_m(trail.points_W) < kTrailPitch_m) continue;
    if (fades) {
      // The first segment drawn is on top where the trail crosses itself: draw the latest first.
      std::reverse(trail.points_W.begin(), trail.points_W.end());
      std::reverse(trail.fade.begin(), trail.fade.end());
    }
    if (camera.show_estimate) {
      const bool alone = scenario_.vehicles.size() == 1;
      frame.legend.push_back({alone ? "truth" : config.name + " truth", trail.colour});
    }
    frame.lines.push_back(std::move(trail));
  }
}

void FrameComposer::add_markers(const scenario::CameraConfig& camera, Time t,
                                render::Frame& frame) const {
  const bool is_map = camera.kind == scenario::CameraKind::kTop;
  // Other cameras follow their vehicle, and views of estimates have markers already.
  if (!(is_map || camera.kind == scenario::CameraKind::kFixed) || camera.show_estimate) return;
  for (std::size_t v = 0; v < scenario_.vehicles.size(); ++v) {
    const std::string& name = scenario_.vehicles[v].name;
    if (trace_of(name).truth.empty()) continue;
    const Eigen::Vector3d p = trace_of(name).truth_at(t).X_WB.p;
    const bool at_work = works(name, t);
    Eigen::Vector2d pixel;
    const bool inside = render::project(frame.camera, frame.width, frame.height, p, pixel) &&
                        (pixel.array() >= 0.0).all() && pixel.x() <= frame.width &&
                        pixel.y() <= frame.height;
    // In a top view an arrow shows a vehicle that works outside the picture.
    if (!inside && !(is_map && at_work)) continue;
    const double radius_m =
        vehicles_[v]->description().collision_half_extents_m.head<2>().maxCoeff();
    frame.markers.push_back(
        {p, radius_m, at_work ? name : name + " (parked)", vehicle_colour(v).rgb});
  }
}

void FrameComposer::add_caption(const scenario::CameraConfig& camera, Time t,
                                render::Frame& frame) const {
  frame.caption.push_back(picture_title(scenario_));
  if (camera.kind == scenario::CameraKind::kShots) {
    const Trace<CameraShot>& shots = shots_of(camera);
    const CameraShot& shot = shots.values[shots.index_at(t)];
    frame.caption.push_back(fmt::format("picture {} · {:.1f} m to the ground, {:.1f} mm per pixel",
                                        shot.index, shot.distance_m, 1e3 * shot.gsd_m));
    return;
  }
  std::string line = clock_text(t);
  const char* before = " · ";
  for (const std::string& phase : phases_at(scenario_, options_.phases, t)) {
    line += before + phase;
    before = ", ";
  }
  const auto is_drawn = [&frame](const Eigen::Vector3f& colour) {
    const auto has_it = [&](const auto& one) { return one.colour == colour; };
    return std::any_of(frame.lines.begin(), frame.lines.end(), has_it) ||
           std::any_of(frame.markers.begin(), frame.markers.end(), has_it);
  };
  // A vehicle is part of the legend if something is drawn in its colour.
  for (std::size_t v = 0; v < scenario_.vehicles.size(); ++v) {
    const std::string& name = scenario_.vehicles[v].name;
    if (trace_of(name).truth.empty() || !works(name, t)) continue;
    const std::string speed =
        fmt::format("{} {:.1f} m/s", name, trace_of(name).truth_at(t).v_WB_B.norm());
    if (is_drawn(vehicle_colour(v).rgb) && !camera.show_estimate) {
      frame.legend.push_back({speed, vehicle_colour(v).rgb});
    } else {
      line += " · " + speed;
    }
  }
  if (is_drawn(kPlanColour)) frame.legend.push_back({"plan", kPlanColour});
  frame.caption.push_back(line);
}

void FrameComposer::add_plans(Time t, render::Frame& frame) const {
  for (const auto& [name, vehicle] : trace_.vehicles) {
    if (vehicle.plan.empty() || vehicle.plan.times.front() > t || !works(name, t)) continue;
    render::Polyline plan;
    plan.colour = kPlanColour;
    plan.width_px = 2.5f;
    plan.alpha = 0.75f;
    plan.dashed = true;
    for (const PathPoint& point : vehicle.plan.values[vehicle.plan.index_at(t)].points) {
      const Eigen::Vector2d p = point.p_W.head<2>();
      plan.points_W.emplace_back(p.x(), p.y(),
                                 std::max(point.p_W.z(), ground_m(p.x(), p.y())) + 0.5 * kHover_m);
    }
    if (plan.points_W.size() > 1) frame.lines.push_back(std::move(plan));
  }
}

void FrameComposer::add_trees(Time t, render::Frame& frame) const {
  for (const auto& [name, vehicle] : trace_.vehicles) {
    if (vehicle.plan_tree.empty() || vehicle.plan_tree.times.front() > t) continue;
    render::Polyline tree;
    tree.colour = kTreeColour;
    tree.width_px = 1.0f;
    tree.alpha = 0.5f;
    tree.pairs = true;
    tree.points_W = vehicle.plan_tree.values[vehicle.plan_tree.index_at(t)].points_W;
    for (Eigen::Vector3d& p : tree.points_W) {
      p.z() = std::max(p.z(), ground_m(p.x(), p.y())) + 0.4 * kHover_m;
    }
    frame.lines.push_back(std::move(tree));
  }
}

void FrameComposer::add_rays(Time t, render::Frame& frame) const {
  for (const auto& [name, vehicle] : trace_.vehicles) {
    for (const auto& [sensor, ranges] : vehicle.ranges) {
      if (ranges.empty() || ranges.times.front() > t) continue;
      const RangeSample& sample = ranges.values[ranges.index_at(t)];
      const bool seen = std::isfinite(sample.range_m);
      const double length_m = seen ? sample.range_m : sample.max_range_m;
      // The axis (k = -1) and eight lines on the cone.
      for (int k = -1; k < 8; ++k) {
        const double off = k < 0 ? 0.0 : sample.half_angle_rad, around = 2.0 * kPi * k / 8.0;
        const Eigen::Vector3d dir(std::cos(off), std::sin(off) * std::cos(around),
                                  std::sin(off) * std::sin(around));
        render::Polyline ray;
        ray.colour = kRayColour;
        ray.width_px = k < 0 ? 3.0f : 1.5f;
        ray.alpha = seen ? 0.85f : 0.25f;
        ray.points_W = {sample.X_WS.p, sample.X_WS * Eigen::Vector3d(length_m * dir)};
        frame.lines.push_back(std::move(ray));
      }
    }
  }
}

void FrameComposer::add_scans(Time t, render::Frame& frame) const {
  for (const auto& [name, vehicle] : trace_.vehicles) {
    for (const auto& [sensor, scans] : vehicle.scans) {
      if (scans.empty() || scans.times.front() > t) continue;
      const LaserScan& scan = scans.values[scans.index_at(t)];
      render::Polyline beams, echoes;
      beams.colour = echoes.colour = kRayColour;
      beams.pairs = echoes.pairs = true;
      beams.width_px = 1.5f;
      beams.alpha = 0.45f;
      echoes.width_px = 3.0f;
      echoes.alpha = 0.9f;
      const std::size_t every = scan.ranges_m.size() / kMaxBeams + 1;
      for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
        const double r = scan.ranges_m[i];
        if (!std::isfinite(r)) continue;
        const double angle = scan.first_angle_rad + static_cast<double>(i) * scan.angle_step_rad;
        const Eigen::Vector3d end =
            scan.X_WS * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0.0);
        if (i % every == 0) beams.points_W.insert(beams.points_W.end(), {scan.X_WS.p, end});
        const Eigen::Vector3d half(0.0, 0.0, 0.5 * kEchoMark_m);
        echoes.points_W.insert(echoes.points_W.end(), {end - half, end + half});
      }
      if (!beams.points_W.empty()) frame.lines.push_back(std::move(beams));
      if (!echoes.points_W.empty()) frame.lines.push_back(std::move(echoes));
    }
  }
}

render::Frame FrameComposer::compose(const scenario::CameraConfig& camera, Time t) const {
  render::Frame frame;
  frame.width = scenario_.pictures.width;
  frame.height = scenario_.pictures.height;
  frame.samples = scenario_.pictures.samples;
  const bool is_shot = camera.kind == scenario::CameraKind::kShots;
  if (is_shot) {
    const ShotView view = *view_of(shots_of(camera));
    frame.width = static_cast<int>(std::lround(frame.height * view.across / view.along));
  }
  frame.camera = place(camera, t, static_cast<double>(frame.width) / frame.height);
  for (std::size_t v = 0; v < scenario_.vehicles.size(); ++v) {
    // A survey camera does not see its own vehicle.
    if (is_shot && scenario_.vehicles[v].name == camera.vehicle) continue;
    frame.vehicles.push_back({&vehicles_[v]->links(),
                              trace_of(scenario_.vehicles[v].name).links_at(t),
                              scenario_.vehicles[v].name});
    if (frame.vehicles.back().X_WL.empty()) frame.vehicles.pop_back();
  }
  if (camera.show_grid) frame.grid = grid_;
  if (camera.show_map) add_map_edges(frame);
  if (camera.show_tree) add_trees(t, frame);
  if (camera.show_plan) add_plans(t, frame);
  if (camera.show_trail) add_trails(camera, t, frame);
  if (camera.show_estimate) add_estimates(camera, t, frame);
  if (camera.show_sensor_rays) {
    add_rays(t, frame);
    add_scans(t, frame);
  }
  add_markers(camera, t, frame);
  add_caption(camera, t, frame);
  frame.show_scale = camera.kind == scenario::CameraKind::kTop;
  return frame;
}

}  // namespace vinerow::playback
