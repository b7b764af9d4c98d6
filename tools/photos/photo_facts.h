#pragma once
/// Facts in a survey's photograph, for photogrammetry: camera, position, orientation.

#include <Eigen/Core>
#include <string>

#include "engine/math/geo.h"
#include "engine/math/pose.h"

namespace vinerow::tools {

struct PhotoFacts {
  std::string model;  ///< of the camera; ASCII
  double focal_length_mm = 0.0;
  double sensor_width_mm = 0.0;
  int columns = 0;
  int rows = 0;
  Geodetic place;           ///< of the camera
  Eigen::Quaterniond q_WS;  ///< x of S along the optical axis, y to the picture's left
};

/// Orientation of a camera that looks down, after Pix4D: the picture's upper edge, its right edge
/// and the optical axis as axes forward, right and down, turned by yaw (clockwise from north),
/// pitch (upper edge up) and roll (left edge up). All are zero if it looks straight down with the
/// upper edge to the north.
/// @returns yaw, pitch, roll; rad
Eigen::Vector3d photo_angles(const Eigen::Quaterniond& q_WS);

/// Contents of the APP1 segment "Exif" (CIPA DC-008 / Exif 2.32): camera, focal length, resolution
/// in the focal plane, position in WGS84 to 0.3 mm, direction of the upper edge. There is no time:
/// a simulation has no date. GPSAltitude is the height in the world's datum.
std::string exif_segment(const PhotoFacts& facts);

/// Contents of the APP1 segment with the XMP packet: Pix4D's namespace Camera 1.0 (model, focal
/// length, principal point, yaw, pitch, roll).
std::string xmp_segment(const PhotoFacts& facts);

}  // namespace vinerow::tools
