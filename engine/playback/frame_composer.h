#pragma once
/// Composition of one camera's frame from a log's trace at one instant.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/playback/log_trace.h"
#include "engine/playback/phase_moments.h"
#include "engine/render/scene.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/placement_ground.h"

namespace vinerow::playback {

/// Tangents of half the angles of view of a survey camera, from its corners on the ground.
struct ShotView {
  double across = 0.0;
  double along = 0.0;
};
/// @returns nullopt if no picture has all its corners on the ground
std::optional<ShotView> view_of(const Trace<CameraShot>& shots);

struct ComposerOptions {
  std::map<std::string, PhaseSpan> phases;  ///< of the log; empty for a run without a mission
  /// Chase cameras move up or sideways if something hides their vehicle (clear_view.h). Not for
  /// films, in which they would jump.
  bool seeks_clear_views = false;
};

class FrameComposer {
 public:
  /// @param vehicles  same order as scenario.vehicles; only their links are used
  FrameComposer(const scenario::Scenario& scenario, const WorldModel& world,
                const std::vector<std::unique_ptr<Vehicle>>& vehicles, const LogTrace& trace,
                ComposerOptions options = {});

  /// Frame of a camera at t. A camera of kind shots shows the last picture taken until t.
  /// @pre view_of() returns such a camera's view
  render::Frame compose(const scenario::CameraConfig& camera, Time t) const;

 private:
  render::Camera place(const scenario::CameraConfig& camera, Time t, double aspect) const;
  render::Camera place_chase(const scenario::CameraConfig& camera, Time t, double aspect) const;
  /// Points spread over a vehicle at t.
  std::vector<Eigen::Vector3d> points_at(std::size_t vehicle, Time t) const;
  void add_trails(const scenario::CameraConfig& camera, Time t, render::Frame& frame) const;
  void add_markers(const scenario::CameraConfig& camera, Time t, render::Frame& frame) const;
  void add_caption(const scenario::CameraConfig& camera, Time t, render::Frame& frame) const;
  void add_plans(Time t, render::Frame& frame) const;
  bool works(const std::string& vehicle, Time t) const;
  void add_trees(Time t, render::Frame& frame) const;
  void add_map_edges(render::Frame& frame) const;
  void add_estimates(const scenario::CameraConfig& camera, Time t, render::Frame& frame) const;
  void add_rays(Time t, render::Frame& frame) const;
  void add_scans(Time t, render::Frame& frame) const;
  /// Whether a camera is on the vehicle and sees it from inside.
  static bool looks_out_of(const scenario::CameraConfig& camera, const std::string& vehicle);
  const Trace<CameraShot>& shots_of(const scenario::CameraConfig& camera) const;
  double ground_m(double x, double y) const;
  bool flies(const std::string& vehicle) const;
  const VehicleTrace& trace_of(const std::string& vehicle) const;

  const scenario::Scenario& scenario_;
  const WorldModel& world_;
  const std::vector<std::unique_ptr<Vehicle>>& vehicles_;
  const LogTrace& trace_;
  const ComposerOptions options_;
  std::unique_ptr<SceneQuery> scene_;      // if the world's ground is meshes, or for clear views
  std::optional<PlacementGround> ground_;  // if the world's ground is meshes
  // Extent of a top view: rows or else meshes, plans and tracks. Those of fixed-wing vehicles count
  // only if no other vehicle works, because they come from far away.
  Eigen::AlignedBox3d extent_W_;
  Eigen::AlignedBox3d parcel_W_;  // the same with the parcel's boundary, for views with the grid
  std::shared_ptr<const OccupancyGrid> grid_;  // of the log, else of the world; may be null
};

}  // namespace vinerow::playback
