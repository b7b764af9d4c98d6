#include "tools/dataset/yolo.h"

#include <fmt/format.h>

#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/dataset/key_point_kind.h"
#include "tools/dataset/outline.h"
#include "tools/dataset/shared_picture.h"

namespace vinerow::dataset {
namespace {

/// Size of a picture, for shares of it.
struct Size {
  double w, h;
};

std::string box_of(double left, double top, double width, double height, const Size& size) {
  return fmt::format(" {:.6f} {:.6f} {:.6f} {:.6f}", (left + 0.5 * width) / size.w,
                     (top + 0.5 * height) / size.h, width / size.w, height / size.h);
}

std::string box_of(const Mask& mask, const Size& size) {
  return box_of(mask.left, mask.top, mask.width, mask.height, size);
}

std::string key_points(const std::array<KeyPoint, 2>& points, const Size& size) {
  std::string text;
  for (const KeyPoint& point : points) {
    const bool is_in = point.seen != Seen::kOutside;
    // Key points count from the middle of the first pixel, shares from its edge.
    text += fmt::format(" {:.6f} {:.6f} {}", is_in ? (point.u + 0.5) / size.w : 0.0,
                        is_in ? (point.v + 0.5) / size.h : 0.0, static_cast<int>(point.seen));
  }
  return text;
}

const char* folder_name(YoloTask task) {
  switch (task) {
    case YoloTask::kSegment:
      return "yolo_segment";
    case YoloTask::kPose:
      return "yolo_pose";
    default:
      return "";
  }
}

}  // namespace

YoloFiles::YoloFiles(YoloTask task, std::vector<std::string> classes, std::filesystem::path out)
    : task_(task),
      classes_(std::move(classes)),
      out_(std::move(out)),
      folder_(out_ / folder_name(task)) {}

std::string YoloFiles::labels_of(const PictureRecord& picture) const {
  const Size size{double{1} * picture.camera.width, double{1} * picture.camera.height};
  std::string text;
  for (const Annotation& thing : picture.things) {
    if (task_ == YoloTask::kPose) {
      if (!thing.ends) continue;
      const KeyPointKind kind = kind_of(classes_[static_cast<std::size_t>(thing.class_index)]);
      text += fmt::format("{}", static_cast<int>(kind)) + box_of(thing.mask, size) +
              key_points(*thing.ends, size) + "\n";
      continue;
    }
    text += fmt::format("{}", thing.class_index);
    if (task_ == YoloTask::kDetect) {
      text += box_of(thing.mask, size);
    } else {
      for (const Eigen::Vector2i& p :
           outline_of(thing.mask, static_cast<int>(picture.camera.height))) {
        text += fmt::format(" {:.6f} {:.6f}", p.x() / size.w, p.y() / size.h);
      }
    }
    text += "\n";
  }
  if (task_ != YoloTask::kPose) return text;
  for (const RowAnnotation& row : picture.rows) {
    text += fmt::format("{}", static_cast<int>(KeyPointKind::kRow)) +
            box_of(row.left, row.top, row.width, row.height, size) + key_points(row.ends, size) +
            "\n";
  }
  return text;
}

void YoloFiles::add(const PictureRecord& picture) {
  const std::string part = to_string(picture.split);
  has_part_[static_cast<std::size_t>(picture.split)] = true;
  if (task_ != YoloTask::kDetect) {
    io::make_folder(folder_ / "images" / part);
    share_picture(picture, out_, folder_ / "images" / part / picture.name());
  }
  // A picture without things has an empty file: it is background.
  const std::filesystem::path file =
      (folder_ / "labels" / part / picture.name()).replace_extension(".txt");
  io::make_folder_of(file);
  write_whole_file(file, labels_of(picture));
}

void YoloFiles::finish() const {
  std::string text = "# Labels in labels/. Paths start at this file's folder.\n";
  for (std::size_t s = 0; s < std::size(has_part_); ++s) {
    if (has_part_[s]) text += fmt::format("{0}: images/{0}\n", kSplitNames[s]);
  }
  // Training demands `val`.
  if (!has_part_[static_cast<std::size_t>(Split::kValidation)]) text += "val: images/train\n";
  std::vector<std::string> names = classes_;
  if (task_ == YoloTask::kPose) {
    names.assign(std::begin(kKeyPointKindNames), std::end(kKeyPointKindNames));
    // In a mirrored picture both are still what they were.
    text += "kpt_shape: [2, 3]\nflip_idx: [0, 1]\n";
  }
  text += "names:\n";
  for (std::size_t i = 0; i < names.size(); ++i) text += fmt::format("  {}: {}\n", i, names[i]);
  write_whole_file(folder_ / "data.yaml", text);
}

}  // namespace vinerow::dataset
