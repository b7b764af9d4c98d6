#pragma once
/// Choice of a chase camera's position from which leaves, posts and slopes do not hide the vehicle.

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
  /// The same for the other vehicles, which must not overlap the subject in the picture.
  std::vector<std::vector<Eigen::Vector3d>> others_W;
};

/// Points spread over a vehicle: for each link the centre of its box, and points between that and
/// the corners.
std::vector<Eigen::Vector3d> points_of(const std::vector<VehicleLink>& links,
                                       const std::vector<Pose>& X_WL);

struct ViewQuality {
  double seen = 0.0;  ///< share of the points that are visible, reduced by other vehicles' overlap
  double near = 0.0;  ///< share of the picture whose content is closer to the eye than 1.3 m
};
/// Quality of a view, by rays from the eye. Rays do not hit wires, so wires hide nothing.
ViewQuality judge_view(const render::Camera& camera, double aspect, const Subject& subject,
                       const SceneQuery& scene);

/// Chase cameras to try: first the requested one, then from small to large changes of the orbit
/// angle (smaller, then to the other side) and of the height.
std::vector<render::ChaseOptions> chase_candidates(const render::ChaseOptions& requested);

/// The first candidate with a good view of the subject, else the best one.
/// @param candidates  @pre not empty  @param aspect  width / height of the picture
render::Camera find_clear_view(const std::vector<render::Camera>& candidates, double aspect,
                               const Subject& subject, const SceneQuery& scene);

}  // namespace vinerow::playback
