#pragma once
/// Panoptic annotations as COCO writes them (cocodataset.org, "Data format", 4): each pixel belongs
/// to one segment or to none.
///
///   annotations/panoptic_<part>.json        segments: category, area, box
///   annotations/panoptic_<part>/000012.png  id of each pixel's segment: red + 256 green + 65536
///                                           blue; 0: none
///
/// Things are those of the data set's classes that are listed, as in instances_<part>.json. The
/// other pixels are stuff: one segment for each label that is not the name of a class. Pixels of
/// things that are too small to be listed belong to none. Beyond COCO a thing's segment has
/// `thing`, its number in instance pictures.

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/api/messages/camera.h"
#include "tools/dataset/picture_record.h"

namespace vinerow::dataset {

struct PanopticPicture {
  Picture ids;  ///< RGB8
  std::vector<Segment> segments;
};

/// @param labels  of each pixel, row by row, as in semantic pictures
/// @param things  annotate() of the same layers  @param classes  of the data set
PanopticPicture make_panoptic(const Layers& layers, std::span<const std::uint8_t> labels,
                              const ThingShapes& shapes, std::span<const Annotation> things,
                              std::span<const std::string> classes);

class PanopticFiles {
 public:
  /// @param head  coco_head()
  PanopticFiles(const std::vector<std::string>& classes, nlohmann::ordered_json head);

  /// Its picture of ids is in the data set already.
  void add(const PictureRecord& picture);
  /// @param folder  of the annotations @throws WriteError
  void write(const std::filesystem::path& folder) const;

 private:
  using Json = nlohmann::ordered_json;
  struct Part {
    Json images = Json::array(), annotations = Json::array();
  };

  Json head_, categories_ = Json::array();
  std::array<Part, 3> parts_;  ///< by Split
};

}  // namespace vinerow::dataset
