#pragma once
/// Products that phases of a mission pass to each other: pictures, point clouds, maps, plans.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/product_port.h"
#include "engine/api/survey_camera.h"
#include "engine/math/pose.h"

namespace vinerow {

/// Camera poses of pictures, in the order in which they were taken.
struct PictureSet {
  SurveyCamera camera;
  std::vector<Pose> X_WS;  ///< x of S along the optical axis, y to the picture's left
  /// Camera position at each picture according to the vehicle's estimator; empty: no estimates.
  std::vector<Eigen::Vector3d> estimated_W;
  std::string source;  ///< for people: "plane/camera"
};

/// One product. Only the fields of its kind are set.
struct Product {
  ProductKind kind = ProductKind::kMap;
  std::shared_ptr<const PictureSet> pictures;
  /// Cloud: a LAS file, with its truth next to it as STEM.truth.json. Map: its folder
  /// (docs/guides/mapping.md), empty if it has no folder.
  std::filesystem::path file;
  std::shared_ptr<const RowMap> map;
  std::shared_ptr<const PlannedPath> plan;
};

}  // namespace vinerow
