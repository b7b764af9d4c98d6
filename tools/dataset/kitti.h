#pragma once
/// Pictures and boxes as the KITTI object benchmark has them (Geiger et al. 2012, its devkit's
/// readme), in kitti/:
///
///   training/image_2/000012.png   the picture
///   training/label_2/000012.txt   type, truncation, occlusion, alpha, box, 3D box
///   training/calib/000012.txt     projection matrices; the four cameras are the same
///   training/depth_2/000012.png   depth in 1/256 m (KITTI depth benchmark); 0: none
///   poses/0003.txt                a run's camera poses against its first (odometry benchmark)
///   ImageSets/train.txt, val.txt, test.txt
///
/// Occlusion: 0 for a visible share from 0.8, 1 from 0.4, else 2. The axes of 3D boxes are those of
/// the optical frame; vehicles are turned about its y axis.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/dataset/picture_record.h"

namespace vinerow::dataset {

class KittiFiles {
 public:
  /// @param out  of the data set, with images/ and depth/
  KittiFiles(std::vector<std::string> classes, std::filesystem::path out);

  /// Its picture and depth are in the data set already. @throws WriteError
  void add(const PictureRecord& picture);
  void finish() const;

 private:
  std::vector<std::string> classes_;
  std::filesystem::path out_;
  std::map<std::size_t, std::vector<Pose>> poses_;  ///< by cell
  std::string sets_[3];
};

}  // namespace vinerow::dataset
