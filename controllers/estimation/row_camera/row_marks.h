#pragma once
/// Marks of plant rows in a camera's picture, as points on the ground before the vehicle.
///
/// labels   picture of labels: the feet of trunks and posts. In each column, from below, the first
///          pixel of wood or of a post whose lower neighbour is ground stands on the row's line.
///          The labels may come from a net (net_labels.h), which makes errors of single pixels.
/// colours  picture in colours: the border of the bare strip under the plants. In each row of
///          pixels, from the middle outwards, soil begins `strip_half_width_m` before the row's
///          line where the colour turns from green to brown. Brown is what has more red against
///          green than a threshold that splits the ground's pixels best (Otsu 1979), so that it
///          follows the light. It needs grass in the alleys and bare soil under the plants.
///
/// Pixels become points by the ray through them and the ground under the wheels, a plane parallel
/// to the body. On bent ground and when the body nods, points are off along the line of sight: by
/// d^2 / h times the angle, for a point at the distance d from a camera at the height h.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/messages/camera.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

struct RowMark {
  Eigen::Vector2d p_B = Eigen::Vector2d::Zero();  ///< m, on the ground
  double before_row_m = 0.0;  ///< distance from the row's line, towards the alley
  Eigen::Vector2d range_std_B = Eigen::Vector2d::Zero();  ///< 1 sigma along the line of sight, m
};

struct RowMarksParams {
  enum class Source { kLabels, kColours } source = Source::kLabels;
  double nearest_m = 0.8;  ///< ahead of B
  double farthest_m = 6.0;
  int foot_px = 1;
  double strip_half_width_m = 0.34;
  double tilt_std_rad = 0.02;
};

/// `marks` to `tilt_std_deg`.
const ParameterTable<RowMarksParams>& row_marks_table();

class RowMarks {
 public:
  /// @param height_m  of B above the ground
  RowMarks(const RowMarksParams& params, const Pose& X_BS, double height_m);

  /// Geometry of the camera; allocates.
  void set_camera(const CameraInfo& info);
  bool has_camera() const { return !ground_B_.empty(); }

  /// What find() needs: pictures of labels or in colours.
  Picture::Format format() const {
    return params_.source == RowMarksParams::Source::kLabels ? Picture::Format::kMono8
                                                             : Picture::Format::kRgb8;
  }

  /// Marks of a picture of that camera. Valid until the next call; empty if the picture has another
  /// size or format.
  const std::vector<RowMark>& find(const Picture& picture);

 private:
  using Point = Eigen::Vector2f;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  void find_feet(const Picture& labels);
  void find_strips(const Picture& colours);
  void look_along(int row, int first, int step, int side);
  void rate_colours(const Picture& colours);
  void add(const Point& ground_B, double before_row_m);

  RowMarksParams params_;
  Pose X_BS_;
  double height_m_;
  int width_ = 0, height_ = 0;
  std::vector<std::optional<Point>> ground_B_;  ///< of each pixel, within the range
  std::vector<float> redness_;                  ///< of each pixel that shows ground
  float threshold_ = 0.0f;
  std::vector<RowMark> marks_;
};

}  // namespace vinerow::controllers
