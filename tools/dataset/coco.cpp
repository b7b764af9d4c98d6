#include "tools/dataset/coco.h"

#include <algorithm>
#include <cmath>

#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/dataset/key_point_kind.h"
#include "tools/dataset/mask.h"

namespace vinerow::dataset {
namespace {

using Json = nlohmann::ordered_json;

/// Hundredths of a pixel are below what a label is good for.
double rounded(double value) {
  return std::round(100.0 * value) / 100.0 + 0.0;
}

/// COCO counts categories from 1.
int category_of(KeyPointKind kind) {
  return static_cast<int>(kind) + 1;
}

Json key_point_categories() {
  Json categories = Json::array();
  const auto add = [&](KeyPointKind kind, const char* from, const char* to) {
    categories.push_back({{"id", category_of(kind)},
                          {"name", kKeyPointKindNames[static_cast<std::size_t>(kind)]},
                          {"supercategory", "vineyard"},
                          {"keypoints", {from, to}},
                          {"skeleton", Json::array({Json::array({1, 2})})}});
  };
  add(KeyPointKind::kTrunk, "foot", "head");
  add(KeyPointKind::kPost, "foot", "head");
  add(KeyPointKind::kRow, "start", "end");
  return categories;
}

Json with_key_points(Json annotation, const std::array<KeyPoint, 2>& points) {
  Json list = Json::array();
  int count = 0;
  for (const KeyPoint& point : points) {
    const bool is_in = point.seen != Seen::kOutside;
    list.push_back(is_in ? rounded(point.u) : 0.0);
    list.push_back(is_in ? rounded(point.v) : 0.0);
    list.push_back(static_cast<int>(point.seen));
    count += is_in ? 1 : 0;
  }
  annotation["keypoints"] = std::move(list);
  annotation["num_keypoints"] = count;
  return annotation;
}

}  // namespace

Json coco_head(const std::string& description, const std::string& licence) {
  Json head;
  head["info"] = {{"description", description}, {"version", "1.0"}, {"contributor", "Vinerow"}};
  head["licenses"] =
      Json::array({{{"id", 1}, {"name", licence.empty() ? "not stated" : licence}, {"url", ""}}});
  return head;
}

Json coco_image(const PictureRecord& picture) {
  return {{"id", picture.index},
          {"file_name", picture.name()},
          {"width", picture.camera.width},
          {"height", picture.camera.height},
          {"license", 1}};
}

void write_coco_file(const std::filesystem::path& file, const Json& content) {
  write_whole_file(file, content.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

CocoFiles::CocoFiles(std::vector<std::string> classes, Json head)
    : classes_(std::move(classes)), head_(std::move(head)) {}

void CocoFiles::add(const PictureRecord& picture) {
  Part& part = parts_[static_cast<std::size_t>(picture.split)];
  const CameraInfo& camera = picture.camera;
  const std::uint32_t pixels = camera.width * camera.height;
  part.images.push_back(coco_image(picture));
  for (const Annotation& thing : picture.things) {
    const Mask& mask = thing.mask;
    const Json box = {mask.left, mask.top, mask.width, mask.height};
    const Json segmentation = {{"size", {camera.height, camera.width}},
                               {"counts", coco_counts(mask, pixels)}};
    part.instances.push_back({{"id", part.instances.size() + 1},
                              {"image_id", picture.index},
                              {"category_id", thing.class_index + 1},
                              {"bbox", box},
                              {"area", mask.area},
                              {"segmentation", segmentation},
                              {"iscrowd", 0},
                              {"thing", thing.thing},
                              {"visible_share", rounded(thing.visible_share)}});
    if (!thing.ends) continue;
    const KeyPointKind kind = kind_of(classes_[static_cast<std::size_t>(thing.class_index)]);
    part.key_points.push_back(with_key_points({{"id", part.key_points.size() + 1},
                                               {"image_id", picture.index},
                                               {"category_id", category_of(kind)},
                                               {"bbox", box},
                                               {"area", mask.area},
                                               {"segmentation", segmentation},
                                               {"iscrowd", 0},
                                               {"thing", thing.thing}},
                                              *thing.ends));
  }
  for (const RowAnnotation& row : picture.rows) {
    part.key_points.push_back(with_key_points(
        {{"id", part.key_points.size() + 1},
         {"image_id", picture.index},
         {"category_id", category_of(KeyPointKind::kRow)},
         {"bbox", {rounded(row.left), rounded(row.top), rounded(row.width), rounded(row.height)}},
         {"area", rounded(row.width * row.height)},
         {"segmentation", Json::array()},
         {"iscrowd", 0},
         {"row", row.row}},
        row.ends));
  }
}

void CocoFiles::write(const std::filesystem::path& folder) const {
  io::make_folder(folder);
  Json categories = Json::array();
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    categories.push_back({{"id", i + 1}, {"name", classes_[i]}, {"supercategory", "vineyard"}});
  }
  for (std::size_t s = 0; s < parts_.size(); ++s) {
    const Part& part = parts_[s];
    if (part.images.empty()) continue;
    const auto write = [&](const char* kind, const Json& own, const Json& annotations) {
      Json file = head_;
      file["images"] = part.images;
      file["annotations"] = annotations;
      file["categories"] = own;
      write_coco_file(folder / (std::string(kind) + "_" + kSplitNames[s] + ".json"), file);
    };
    write("instances", categories, part.instances);
    write("keypoints", key_point_categories(), part.key_points);
  }
}

}  // namespace vinerow::dataset
