#pragma once
/// What a picture shows, from its labels: masks, boxes and key points of things, ends of rows.
///
/// Pixels: (0, 0) is the middle of the upper left one, as in CameraInfo and COCO's key points.
/// Boxes have the pixels' outer edges and begin at 0 (COCO).

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/api/lens.h"
#include "engine/api/map.h"
#include "engine/math/pose.h"
#include "engine/sensors/camera/camera_motion.h"
#include "tools/dataset/mask.h"
#include "tools/dataset/thing_shapes.h"

namespace vinerow::dataset {

/// Layers of one picture, row by row.
struct Layers {
  int width = 0, height = 0;
  std::vector<std::uint32_t> thing;     ///< numbers of thing_numbers.h
  std::vector<std::uint16_t> depth_mm;  ///< 0: none
};

/// COCO's flag of a key point.
enum class Seen { kOutside = 0, kHidden = 1, kSeen = 2 };

struct KeyPoint {
  double u = 0.0, v = 0.0;  ///< px; 0 if outside
  Seen seen = Seen::kOutside;
};

/// Box in the optical frame, turned about its y axis (down), after KITTI: at turn 0 the length is
/// along x, at pi/2 along -z.
struct Box3 {
  Eigen::Vector3d bottom_C = Eigen::Vector3d::Zero();  ///< middle of the lower face
  double height_m = 0.0, width_m = 0.0, length_m = 0.0;
  double turn_rad = 0.0;
};

struct Annotation {
  std::uint32_t thing = 0;
  int class_index = 0;  ///< in the data set's classes
  Mask mask;
  double truncated = 0.0;      ///< share of its vertices outside the picture
  double visible_share = 1.0;  ///< of those inside, those at whose pixel or beside it is seen
  std::optional<std::array<KeyPoint, 2>> ends;  ///< foot, head
  Box3 box;
};

struct RowAnnotation {
  int row = 0;
  std::array<KeyPoint, 2> ends;                             ///< start, end
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;  ///< of the row inside the picture
};

/// A vehicle where it is at the picture's stamp.
struct VehicleShape {
  std::vector<Eigen::Vector3d> vertices_W;
  Eigen::Vector3d forward_W = Eigen::Vector3d::UnitX();
  bool carries_camera = false;  ///< keeps its place before it
};

/// Where the camera is while it reads the picture out.
struct CameraPath {
  sensors::CameraMotion motion;
  double readout_s = 0.0;

  /// Of the optical frame at the stamp.
  Pose X_WC() const {
    return motion.X_WS * Pose{Eigen::Quaterniond(sensors::R_SC()), Eigen::Vector3d::Zero()};
  }
};

/// Things of the wanted classes of which enough is seen, in the order of their numbers. Key points
/// and shares are where the row is exposed that shows the point, 3D boxes in the optical frame at
/// the stamp. @param vehicles  by their number in the scenario
std::vector<Annotation> annotate(const Layers& layers, const Lens& lens, const CameraPath& camera,
                                 ThingShapes& shapes, std::span<const VehicleShape> vehicles,
                                 std::span<const std::string> classes, int min_pixels);

/// Rows of which an end is in the picture.
std::vector<RowAnnotation> annotate_rows(const Layers& layers, const Lens& lens,
                                         const CameraPath& camera,
                                         const std::vector<PlantRow>& rows);

}  // namespace vinerow::dataset
