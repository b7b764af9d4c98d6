#pragma once
/// Annotations as COCO writes them (cocodataset.org, "Data format"), a file for each part:
///
///   annotations/instances_<part>.json   classes with masks (run lengths) and boxes
///   annotations/keypoints_<part>.json   trunk and post (foot, head) and row (start, end)
///
/// Beyond COCO each annotation of a thing has `thing`, its number in instance pictures, and
/// `visible_share`.

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/dataset/picture_record.h"

namespace vinerow::dataset {

/// "info" and "licenses" of a file.
nlohmann::ordered_json coco_head(const std::string& description, const std::string& licence);
/// Entry in "images".
nlohmann::ordered_json coco_image(const PictureRecord& picture);
/// @param file  of the annotations @throws WriteError
void write_coco_file(const std::filesystem::path& file, const nlohmann::ordered_json& content);

class CocoFiles {
 public:
  /// @param head  coco_head()
  CocoFiles(std::vector<std::string> classes, nlohmann::ordered_json head);

  void add(const PictureRecord& picture);
  /// @param folder  of the annotations @throws WriteError
  void write(const std::filesystem::path& folder) const;

 private:
  using Json = nlohmann::ordered_json;
  struct Part {
    Json images = Json::array(), instances = Json::array(), key_points = Json::array();
  };

  std::vector<std::string> classes_;
  Json head_;
  std::array<Part, 3> parts_;  ///< by Split
};

}  // namespace vinerow::dataset
