#pragma once
/// Detection of contact between a body and the canopy.
///
/// Canopy yields and is not part of the physics, so that the distance to its triangles is queried:
/// that of the whole hull first, those of its parts if it is near. A distance is valid until the
/// body can have moved that far, so that a flight between rows needs a few queries per second.

#include <Eigen/Core>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/physics/physics_world.h"

namespace vinerow::vehicles {

class FoliageWatch {
 public:
  /// Box of the hull. X_BS is its pose in the body.
  struct Part {
    Pose X_BS;
    Eigen::Vector3d half_extents_m;
  };
  FoliageWatch() = default;
  /// @param hull  box around all parts  @param parts  boxes that must not touch the canopy
  FoliageWatch(Part hull, std::vector<Part> parts);

  /// Discards the distance. @param world  world whose canopy is watched
  void start(const WorldModel& world);
  /// @returns true if a part overlaps the canopy. No heap.
  bool touches(const SceneQuery& scene, const physics::BodyState& body, double dt_s);
  /// Lower bound of the distance to the canopy, m; for tests.
  double margin_m() const { return margin_m_; }
  /// Number of queries so far; for tests.
  long questions() const { return questions_; }

 private:
  double ask(const SceneQuery& scene, const Pose& X_WB, const Part& part, double reach_m);

  Part hull_;
  std::vector<Part> parts_;
  double reach_from_B_m_ = 0.0;  // farthest point of the hull
  bool has_canopy_ = false;
  double margin_m_ = 0.0;
  long questions_ = 0;
};

/// Appends boxes that cover a disc about the z axis. They extend beyond it by at most 3.5 % of the
/// radius.
void append_disc_parts(const Eigen::Vector3d& centre_B, double radius_m, double half_height_m,
                       std::vector<FoliageWatch::Part>& out);

}  // namespace vinerow::vehicles
