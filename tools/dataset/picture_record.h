#pragma once
/// One picture of a data set, as all formats see it.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/messages/camera.h"
#include "engine/core/time.h"
#include "engine/math/geo.h"
#include "engine/math/pose.h"
#include "tools/dataset/annotate.h"

namespace vinerow::dataset {

enum class Split { kTrain, kValidation, kTest };
inline constexpr const char* kSplitNames[] = {"train", "val", "test"};
inline const char* to_string(Split split) {
  return kSplitNames[static_cast<std::size_t>(split)];
}

/// Pixels of a panoptic picture that belong together.
struct Segment {
  std::uint32_t id = 0;     ///< in the picture, from 1
  int category = 0;         ///< of panoptic.h
  std::uint32_t thing = 0;  ///< number in instance pictures; 0: none
  int area = 0;             ///< pixels
  int left = 0, top = 0, width = 0, height = 0;
};

struct PictureRecord {
  int index = 0;  ///< from 0, in the order of cells and time
  Split split = Split::kTrain;
  std::size_t cell = 0;
  std::uint64_t seed = 0;
  Time time;
  CameraInfo camera;
  Pose X_WC;  ///< of the optical frame
  Geodetic place;
  std::vector<Annotation> things;
  std::vector<RowAnnotation> rows;
  std::vector<Segment> segments;  ///< only of the format coco_panoptic

  std::string name() const;  ///< "000012.png"
};

}  // namespace vinerow::dataset
