#pragma once
/// Where a block of pictures ends up in W: the error that a whole cloud has in common.
///
/// Model. Bundle adjustment fixes the pictures of a block against each other far better than
/// satellites fix any one of them; what is left is where the block as a whole lies: a similarity of
/// seven numbers, fitted by least squares to what is known in W. So the cloud is the true one, with
/// its errors of matching, under the similarity that such a fit finds:
///
///   e_i = t + w x (p_i - c) + k (p_i - c),   i over the known places, c their mean
///
/// with p_i the true place and e_i the error with which it is known; weights 1 / variance of the
/// plane and of the height. w is below a milliradian, where this is the rotation to 1e-7.
///
///   direct          the cameras' places as the vehicle's estimator told them at the shots
///   ppk             the same worked out again after the flight: p_i + common + white, a third of
///                   the variance white (what moves is mostly multipath, slower than a flight)
///   control_points  marks on the ground, surveyed and then found in the pictures: four or more
///                   around the area and in its middle
///   truth           no error, for studies
///
/// Without control points the lens's principal distance is known by an earlier calibration only,
/// which puts all heights wrong by its share of the height flown: with nadir pictures of one height
/// nothing else tells it (Stroner, Urban, Seidl, Reindl, Broucek, "Photogrammetry Using UAV-Mounted
/// GNSS RTK: Georeferencing Strategies without GCPs", Remote Sensing 13(7) 1336, 2021).
///
/// Defaults: ppk 1 cm in the plane and 1.5 cm in height, as RTK and PPK drones are specified (DJI
/// Phantom 4 RTK: 1 cm and 1.5 cm + 1 ppm, quoted); marks 0.8 cm and 1.5 cm, kinematic survey (the
/// usual 8 mm and 15 mm + 1 ppm of survey receivers); principal distance 2e-4, chosen: 2 cm of
/// height from 100 m, the size of what that paper finds.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/core/result.h"

namespace vinerow::mapping {

struct GeoreferenceOptions {
  enum class Method { kDirect, kPpk, kControlPoints, kTruth } method = Method::kDirect;
  std::array<double, 2> ppk_std_m{0.010, 0.015};      ///< plane (each axis), height
  std::array<double, 2> control_std_m{0.008, 0.015};  ///< likewise
  int control_points = 5;
  double principal_distance_std = 2e-4;  ///< as a share of it; not with control points
};

const ParameterTable<GeoreferenceOptions>& georeference_table();
/// "direct", as in files.
const char* name_of(GeoreferenceOptions::Method method);

/// A place with what it was taken for.
struct KnownPlace {
  Eigen::Vector3d true_W, told_W;
};

/// The similarity, about `centre_W`.
struct Georeference {
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< at centre_W
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  double scale = 0.0;         ///< k
  double height_scale = 0.0;  ///< of the way down from centre_W, by the principal distance

  Eigen::Vector3d error_m(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d arm = p_W - centre_W;
    return shift_m + turn_rad.cross(arm) + scale * arm +
           Eigen::Vector3d(0.0, 0.0, height_scale * arm.z());
  }
};

/// @param std_m  1 sigma of each place in the plane, of its height; weights alone
/// @returns the fit, or why there is none: places on one line do not tell the turn about it
Result<Georeference> fit_georeference(const std::vector<KnownPlace>& places,
                                      const std::array<double, 2>& std_m);

/// What photogrammetry needs of a survey.
struct GeoreferenceRequest {
  std::vector<Eigen::Vector3d> cameras_W;  ///< true places at the shots
  std::vector<Eigen::Vector3d> told_W;     ///< as the estimator told them; empty: nobody did
  std::vector<Eigen::Vector3d> marks_W;    ///< on the ground
  std::uint64_t seed = 1;
};

/// Marks around the corners of a box and in its middle, `count` of them, at the ground's height.
/// @param height_m  of the ground at (x, y)
std::vector<Eigen::Vector2d> control_places(const Eigen::AlignedBox2d& box, int count);

/// Without told places, as of a survey that is only planned, `direct` has no error.
Result<Georeference> georeference(const GeoreferenceRequest& request,
                                  const GeoreferenceOptions& options);

}  // namespace vinerow::mapping
