#pragma once
/// Tells when a body touches the leaves. Canopy gives way and is no contact of the physics, so its
/// triangles are asked for: the whole hull's distance first, its parts' close by. A distance holds
/// until the body can have moved that far, so that a flight between the rows asks a few times a
/// second.

#include <Eigen/Core>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/physics/physics_world.h"

namespace vinerow::vehicles {

class FoliageWatch {
 public:
  /// A box of the hull. @param X_BS  its place in the body
  struct Part {
    Pose X_BS;
    Eigen::Vector3d half_extents_m;
  };
  FoliageWatch() = default;
  /// @param hull  box around all parts  @param parts  what may not touch
  FoliageWatch(Part hull, std::vector<Part> parts);

  /// Forgets the distance. @param world  whose canopy is looked for
  void start(const WorldModel& world);
  /// @returns true if a part overlaps the canopy. No heap.
  bool touches(const SceneQuery& scene, const physics::BodyState& body, double dt_s);
  /// Distance that surely is left, m; for tests.
  double margin_m() const { return margin_m_; }
  /// Questions to the scene so far; for tests.
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

/// Boxes whose union is a disc about the part's z axis, no point of it left out; they reach out of
/// it by 3.5 % of the radius at most.
void append_disc_parts(const Eigen::Vector3d& centre_B, double radius_m, double half_height_m,
                       std::vector<FoliageWatch::Part>& out);

}  // namespace vinerow::vehicles
