#pragma once
/// Where a camera that follows a vehicle sees it: leaves, posts and slopes hide much from one place
/// and nothing from the next.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "engine/api/scene_query.h"
#include "engine/api/vehicle.h"
#include "engine/render/cameras.h"
#include "engine/render/scene.h"

namespace vinerow::playback {

/// What a camera should show.
struct Subject {
  std::vector<Eigen::Vector3d> points_W;  ///< spread over the vehicle
  /// The other vehicles' likewise: one that stands before or behind it cannot be told from it.
  std::vector<std::vector<Eigen::Vector3d>> others_W;
};

/// Points spread over a vehicle: of each link the middle, and places between that and the corners
/// of its box.
std::vector<Eigen::Vector3d> points_of(const std::vector<VehicleLink>& links,
                                       const std::vector<Pose>& X_WL);

struct ViewQuality {
  double seen = 0.0;  ///< share of the points that nothing hides, less what other vehicles overlap
  double near = 0.0;  ///< share of the picture that is nearer to the eye than an arm's length
};
/// By rays from the eye. Wires, which no ray meets, hide nothing.
ViewQuality judge_view(const render::Camera& camera, double aspect, const Subject& subject,
                       const SceneQuery& scene);

/// The chase cameras to be tried, the one that was asked for first, then from small changes to
/// large: less and then other orbit, and higher.
std::vector<render::ChaseOptions> chase_candidates(const render::ChaseOptions& asked);

/// The first that sees the subject well; where none does, that which sees it best.
/// @param candidates  @pre not empty  @param aspect  width / height of the picture
render::Camera find_clear_view(const std::vector<render::Camera>& candidates, double aspect,
                               const Subject& subject, const SceneQuery& scene);

}  // namespace vinerow::playback
