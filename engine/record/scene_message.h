#pragma once
/// What a log adds to its signals for people who look at it: where sensors sit on their vehicles,
/// and a scene of solid things. Nothing of it is a signal, so no digest knows it.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/math/pose.h"
#include "engine/record/cdr.h"

namespace vinerow::record {

/// Where a frame stands in another for the whole run.
struct StaticTransform {
  std::string parent;  ///< "rover/base_link"
  std::string child;   ///< "rover/lidar"
  Pose X_PC;
};

/// Triangles of one colour, in their entity's frame.
struct SceneTriangles {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> indices;                   ///< three each
  std::array<double, 4> colour = {0.7, 0.7, 0.7, 1.0};  ///< sRGB and opacity, 0 to 1
};

/// Something to be drawn, for the whole run.
struct SceneEntity {
  std::string id;
  std::string frame;  ///< it moves with this frame
  std::vector<SceneTriangles> triangles;
};

/// tf2_msgs/msg/TFMessage at time 0.
void write_static_transforms(CdrWriter& out, const std::vector<StaticTransform>& transforms);
/// foxglove_msgs/msg/SceneUpdate at time 0.
void write_scene(CdrWriter& out, const std::vector<SceneEntity>& entities);

}  // namespace vinerow::record
