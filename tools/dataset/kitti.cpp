#include "tools/dataset/kitti.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "engine/core/check.h"
#include "engine/core/whole_file.h"
#include "engine/imaging/picture_codec.h"
#include "engine/io/files/output_folder.h"
#include "tools/dataset/shared_picture.h"

namespace vinerow::dataset {
namespace {

/// KITTI's names begin with a capital.
std::string type_of(std::string name) {
  name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

double wrapped(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

std::string label_line(const Annotation& thing, const std::string& name) {
  const Mask& mask = thing.mask;
  const Box3& box = thing.box;
  const int occluded = thing.visible_share >= 0.8 ? 0 : thing.visible_share >= 0.4 ? 1 : 2;
  // The observation angle: 0 where the thing's length is along the picture at its place.
  const double alpha = wrapped(box.turn_rad - std::atan2(box.bottom_C.x(), box.bottom_C.z()));
  return fmt::format(
      "{} {:.2f} {} {:.3f} {} {} {} {} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.4f}\n",
      type_of(name), thing.truncated + 0.0, occluded, alpha, mask.left, mask.top,
      mask.left + mask.width - 1, mask.top + mask.height - 1, box.height_m, box.width_m,
      box.length_m, box.bottom_C.x(), box.bottom_C.y(), box.bottom_C.z(), box.turn_rad);
}

std::string calibration(const CameraInfo& camera) {
  std::string text;
  for (int k = 0; k < 4; ++k) {
    text += fmt::format("P{}: {:.9e} 0 {:.9e} 0 0 {:.9e} {:.9e} 0 0 0 1 0\n", k, camera.fx_px,
                        camera.cx_px, camera.fy_px, camera.cy_px);
  }
  const char* const identity = "1 0 0 0 0 1 0 0 0 0 1 0";
  text += "R0_rect: 1 0 0 0 1 0 0 0 1\n";
  text += fmt::format("Tr_velo_to_cam: {}\nTr_imu_to_velo: {}\n", identity, identity);
  return text;
}

/// From millimetres to 1/256 m.
std::string kitti_depth(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(in), {}};
  Picture picture;
  VINEROW_DEMAND(imaging::decode_picture(png, picture));
  for (std::size_t i = 0; i + 1 < picture.data.size(); i += 2) {
    const int mm = picture.data[i] | (picture.data[i + 1] << 8);
    const auto value = static_cast<std::uint32_t>(std::lround(mm * 0.256));
    picture.data[i] = static_cast<std::uint8_t>(value & 0xffu);
    picture.data[i + 1] = static_cast<std::uint8_t>(value >> 8);
  }
  return imaging::encode_picture(picture);
}

}  // namespace

KittiFiles::KittiFiles(std::vector<std::string> classes, std::filesystem::path out)
    : classes_(std::move(classes)), out_(std::move(out)) {}

void KittiFiles::add(const PictureRecord& picture) {
  const std::filesystem::path training = out_ / "kitti/training";
  const std::string stem = fmt::format("{:06}", picture.index);
  std::string labels;
  for (const Annotation& thing : picture.things) {
    labels += label_line(thing, classes_[static_cast<std::size_t>(thing.class_index)]);
  }
  for (const char* folder : {"image_2", "label_2", "calib", "depth_2"}) {
    io::make_folder(training / folder);
  }
  write_whole_file(training / "label_2" / (stem + ".txt"), labels);
  write_whole_file(training / "calib" / (stem + ".txt"), calibration(picture.camera));
  write_whole_file(training / "depth_2" / picture.name(),
                   kitti_depth(out_ / "depth" / to_string(picture.split) / picture.name()));
  share_picture(picture, out_, training / "image_2" / picture.name());
  poses_[picture.cell].push_back(picture.X_WC);
  sets_[static_cast<std::size_t>(picture.split)] += stem + "\n";
}

void KittiFiles::finish() const {
  const std::filesystem::path kitti = out_ / "kitti";
  io::make_folder(kitti / "poses");
  for (const auto& [cell, poses] : poses_) {
    std::string text;
    const Pose X_FirstW = poses.front().inverse();
    for (const Pose& X_WC : poses) {
      const Pose X = X_FirstW * X_WC;
      const Eigen::Matrix3d R = X.q.toRotationMatrix();
      for (int i = 0; i < 3; ++i) {
        text += fmt::format("{:.9e} {:.9e} {:.9e} {:.9e}{}", R(i, 0), R(i, 1), R(i, 2), X.p[i],
                            i < 2 ? " " : "\n");
      }
    }
    write_whole_file(kitti / "poses" / fmt::format("{:04}.txt", cell), text);
  }
  io::make_folder(kitti / "ImageSets");
  for (std::size_t s = 0; s < 3; ++s) {
    if (sets_[s].empty()) continue;
    write_whole_file(kitti / "ImageSets" / (std::string(kSplitNames[s]) + ".txt"), sets_[s]);
  }
}

}  // namespace vinerow::dataset
