#pragma once
/// What phases of a mission hand to each other: pictures, point clouds, maps, plans.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/product_port.h"
#include "engine/api/survey_camera.h"
#include "engine/math/pose.h"

namespace vinerow {

/// Where a camera took its pictures, in the order in which they were taken.
struct PictureSet {
  SurveyCamera camera;
  std::vector<Pose> X_WS;  ///< x of S along the optical axis, y to the picture's left
  /// Where the vehicle's estimator told the camera to be at each of them; empty: nobody told.
  std::vector<Eigen::Vector3d> told_W;
  std::string source;  ///< for people: "plane/camera"
};

/// One product. Of the fields those of its kind are filled.
struct Product {
  ProductKind kind = ProductKind::kMap;
  std::shared_ptr<const PictureSet> pictures;
  /// Cloud: a LAS file, its truth beside it as STEM.truth.json. Map: its folder
  /// (docs/guides/mapping.md), empty where it has none.
  std::filesystem::path file;
  std::shared_ptr<const RowMap> map;
  std::shared_ptr<const PlannedPath> plan;
};

}  // namespace vinerow
