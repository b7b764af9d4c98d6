#pragma once
/// Shapes of the things in a world: what their numbers in instance pictures stand for.

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/sensors/camera/thing_numbers.h"

namespace vinerow::dataset {

/// Class of a mesh's things: its label, but "trunk" for trunks, whose label is "wood".
std::string class_of(const MeshInstance& instance);

struct ThingShape {
  std::string class_name;
  std::vector<Eigen::Vector3d> vertices_W;
  /// Lowest point above the ground, and highest point, on the middle line; of trunks and posts.
  bool has_ends = false;
  Eigen::Vector3d foot_W = Eigen::Vector3d::Zero(), head_W = Eigen::Vector3d::Zero();
};

class ThingShapes {
 public:
  /// @param world  outlives this object
  explicit ThingShapes(const WorldModel& world);

  /// Null if the number is none of a thing in the world. Valid as long as this object.
  const ThingShape* find(std::uint32_t number);
  /// class_of() of a thing, "vehicle" of a vehicle, "" of none; quicker than find().
  std::string class_name(std::uint32_t number) const;
  /// First number of a vehicle.
  std::uint32_t vehicles() const { return numbers_.end(); }

 private:
  ThingShape make(const sensors::ThingNumbers::Thing& thing) const;

  const WorldModel& world_;
  sensors::ThingNumbers numbers_;
  std::map<std::uint32_t, ThingShape> known_;
};

/// Vertices of a whole mesh, in W.
std::vector<Eigen::Vector3d> vertices_of(const MeshInstance& instance);

}  // namespace vinerow::dataset
