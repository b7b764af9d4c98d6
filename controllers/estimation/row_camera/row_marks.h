#pragma once
/// Marks of plant rows in a camera's picture, as points on the ground before the vehicle.
///
/// labels   picture of labels: the feet of trunks and posts. In each column, from below, the first
///          pixel of wood or of a post whose lower neighbour is ground stands on the row's line.
///          The labels may come from a net (net_labels.h), which makes errors of single pixels.
/// colours  picture in colours: the middle of the bare strip under the plants. Across each row of
///          the map, near where it is expected, profiles of the ground's share of soil
///          (soil_colour.h) are taken from the picture every 25 cm. The strip is where soil within
///          2 `strip_half_width_m` exceeds that of its flanks most. Both borders must be in view:
///          what widens or narrows a strip on both sides, as a wrong width does, cancels. It needs
///          grass in the alleys and bare soil under the plants.
///
/// Pixels become points by the ray through them and the ground under the wheels, a plane parallel
/// to the body. On bent ground and when the body nods, points are off along the line of sight: by
/// d^2 / h times the angle, for a point at the distance d from a camera at the height h.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "controllers/estimation/row_camera/soil_colour.h"
#include "engine/api/lens.h"
#include "engine/api/messages/camera.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/math/polyline_index.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

struct RowMark {
  Eigen::Vector2d p_B = Eigen::Vector2d::Zero();          ///< m, on the ground, on a row's line
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

  /// What the source needs: pictures of labels or in colours.
  Picture::Format format() const {
    return params_.source == RowMarksParams::Source::kLabels ? Picture::Format::kMono8
                                                             : Picture::Format::kRgb8;
  }

  /// Marks of a picture of that camera, by the source. Valid until the next call; empty if the
  /// picture has another size or format.
  const std::vector<RowMark>& find_feet(const Picture& labels);
  /// @param expected  x, y, heading of the vehicle when the picture was taken
  const std::vector<RowMark>& find_strips(const Picture& colours, const Eigen::Vector3d& expected,
                                          const PolylineIndex& rows);

 private:
  using Point = Eigen::Vector2f;
  /// Colours across a row at equal steps, from the step `first` on.
  struct Profile {
    Eigen::Vector2d row_B, across_B;
    int first;
    std::size_t begin;  ///< in colours_
    int count;
  };
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  bool fits(const Picture& picture) const;
  int reach_of_strip() const;
  std::optional<std::size_t> pixel_at(const Eigen::Vector2d& ground_B) const;
  void take_profile(const Picture& colours, const Eigen::Vector2d& row_B,
                    const Eigen::Vector2d& across_B);
  void find_strip(const Profile& profile, const SoilClasses& classes);
  void add(const Eigen::Vector2d& ground_B);

  RowMarksParams params_;
  Pose X_BS_;
  double height_m_;
  Lens lens_{CameraInfo{}};
  int width_ = 0, height_ = 0;
  std::vector<std::optional<Point>> ground_B_;  ///< of each pixel, within the range
  std::vector<Profile> profiles_;
  std::vector<float> colours_;  ///< of all profiles
  std::vector<float> sums_;     ///< of soil, along a profile
  std::vector<RowMark> marks_;
};

}  // namespace vinerow::controllers
