#pragma once
/// Georeferencing of a block of pictures: the error that a whole cloud has in common.
///
/// Model. Bundle adjustment determines the pictures of a block relative to each other far better
/// than satellites locate any one of them. The remaining error is that of the block as a whole: a
/// similarity with seven parameters, fitted by least squares to known positions in W. The cloud is
/// the true one, with its errors of matching, under the similarity that such a fit finds:
///
///   e_i = t + w x (p_i - c) + k (p_i - c),   i over the known positions, c their mean
///
/// with the true position p_i and the error e_i of the known one; weights 1 / variance of the plane
/// and of the height. w is below a milliradian, where this is the rotation to 1e-7.
///
///   direct          camera positions estimated by the vehicle at the shots
///   ppk             camera positions computed again after the flight: p_i + common + white, a
///                   third of the variance white (the rest is mostly multipath, slower than a
///                   flight)
///   control_points  marks on the ground, surveyed and then found in the pictures: four or more
///                   around the area and in its middle
///   truth           no error, for studies
///
/// Without control points the lens's principal distance is known only from an earlier calibration.
/// Its relative error displaces all heights by that share of the flight height; with nadir pictures
/// from one height nothing else determines it (Stroner, Urban, Seidl, Reindl, Broucek,
/// "Photogrammetry Using UAV-Mounted GNSS RTK: Georeferencing Strategies without GCPs", Remote
/// Sensing 13(7) 1336, 2021).
///
/// Defaults: ppk 1 cm in the plane and 1.5 cm in height, as RTK and PPK drones are specified (DJI
/// Phantom 4 RTK: 1 cm and 1.5 cm + 1 ppm, quoted); marks 0.8 cm and 1.5 cm, kinematic survey (the
/// usual 8 mm and 15 mm + 1 ppm of survey receivers); principal distance 2e-4, chosen: 2 cm of
/// height from 100 m, the size that the paper finds.

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
  double principal_distance_std = 2e-4;  ///< relative; unused with control points
};

const ParameterTable<GeoreferenceOptions>& georeference_table();
/// Name in files, like "direct".
const char* name_of(GeoreferenceOptions::Method method);

/// True position and the known one.
struct KnownPlace {
  Eigen::Vector3d true_W, estimated_W;
};

/// Similarity about `centre_W`.
struct Georeference {
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< at centre_W
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  double scale = 0.0;         ///< k
  double height_scale = 0.0;  ///< of the depth below centre_W, by the principal distance

  Eigen::Vector3d error_m(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d arm = p_W - centre_W;
    return shift_m + turn_rad.cross(arm) + scale * arm +
           Eigen::Vector3d(0.0, 0.0, height_scale * arm.z());
  }
};

/// @param std_m  1 sigma of each position in the plane and in height; only their ratio matters
/// @returns the fit, or the reason for failure: positions on one line leave the rotation about it
/// undetermined
Result<Georeference> fit_georeference(const std::vector<KnownPlace>& places,
                                      const std::array<double, 2>& std_m);

/// Data of a survey for georeferencing.
struct GeoreferenceRequest {
  std::vector<Eigen::Vector3d> cameras_W;    ///< true positions at the shots
  std::vector<Eigen::Vector3d> estimated_W;  ///< positions by the estimator; empty: unknown
  std::vector<Eigen::Vector3d> marks_W;      ///< on the ground
  std::uint64_t seed = 1;
};

/// Marks around the corners of a box and in its middle, `count` of them, at the ground's height.
/// @param height_m  of the ground at (x, y)
std::vector<Eigen::Vector2d> control_places(const Eigen::AlignedBox2d& box, int count);

/// Without estimated positions, as in a survey that is only planned, `direct` has no error.
Result<Georeference> georeference(const GeoreferenceRequest& request,
                                  const GeoreferenceOptions& options);

}  // namespace vinerow::mapping
