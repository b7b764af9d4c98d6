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

  std::string name() const;  ///< "000012.png"
};

}  // namespace vinerow::dataset
