#pragma once
/// Display data in a log besides the signals: mounting poses of sensors, and a scene of solid
/// objects. They are not signals, so they are not part of the digest.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/math/pose.h"
#include "engine/record/cdr.h"

namespace vinerow::record {

/// Constant pose of a frame in another one.
struct StaticTransform {
  std::string parent;  ///< "rover/base_link"
  std::string child;   ///< "rover/lidar"
  Pose X_PC;
};

/// Triangles of one colour, in the entity's frame.
struct SceneTriangles {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> indices;                   ///< three per triangle
  std::array<double, 4> colour = {0.7, 0.7, 0.7, 1.0};  ///< sRGB and opacity, 0 to 1
};

/// Object that is drawn for the whole run.
struct SceneEntity {
  std::string id;
  std::string frame;  ///< the entity moves with this frame
  std::vector<SceneTriangles> triangles;
};

/// tf2_msgs/msg/TFMessage at time 0.
void write_static_transforms(CdrWriter& out, const std::vector<StaticTransform>& transforms);
/// foxglove_msgs/msg/SceneUpdate at time 0.
void write_scene(CdrWriter& out, const std::vector<SceneEntity>& entities);

}  // namespace vinerow::record
