#pragma once
/// Labels as Ultralytics YOLO reads them: labels/<part>/<name>.txt with a line for each thing, and
/// data.yaml. All numbers are shares of the picture's width and height.
///
///   detect    class, middle and size of the box
///   segment   class, corners of a polygon (outline.h)
///   pose      class, box, then x, y and visibility (0, 1, 2) of two key points, for trunk and post
///             (foot, head) and row (start, end)
///
/// YOLO finds labels beside pictures: `segment` and `pose` have folders of their own, yolo_segment/
/// and yolo_pose/, with the same pictures.

#include <filesystem>
#include <string>
#include <vector>

#include "tools/dataset/picture_record.h"

namespace vinerow::dataset {

enum class YoloTask { kDetect, kSegment, kPose };

class YoloFiles {
 public:
  /// @param out  of the data set, with images/
  YoloFiles(YoloTask task, std::vector<std::string> classes, std::filesystem::path out);

  /// The picture is in the data set already. @throws WriteError
  void add(const PictureRecord& picture);
  /// Writes data.yaml. @throws WriteError
  void finish() const;

 private:
  std::string labels_of(const PictureRecord& picture) const;

  YoloTask task_;
  std::vector<std::string> classes_;
  std::filesystem::path out_, folder_;
  bool has_part_[3] = {};  ///< by Split
};

}  // namespace vinerow::dataset
