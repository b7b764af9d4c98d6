#pragma once
/// Facts in a survey's photograph, for photogrammetry: camera, position, orientation, band.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "engine/api/messages/camera.h"
#include "engine/math/geo.h"
#include "engine/math/pose.h"

namespace vinerow::tools {

/// One of the pictures that a multispectral camera takes at once.
struct PhotoBand {
  std::string name;  ///< as MicaSense calls it: "Red edge"
  int index = 0;     ///< of the camera's sensor
  double wavelength_nm = 0.0, width_nm = 0.0;
  double exposure_s = 0.0, f_number = 0.0;
  std::string capture;  ///< the same for the pictures of one moment
};

struct PhotoFacts {
  std::string model;  ///< of the camera; ASCII
  double focal_length_mm = 0.0;
  double sensor_width_mm = 0.0;
  int columns = 0;
  int rows = 0;
  Geodetic place;                 ///< of the camera
  Eigen::Quaterniond q_WS;        ///< x of S along the optical axis, y to the picture's left
  std::optional<PhotoBand> band;  ///< absent: colours
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
/// length, principal point, yaw, pitch, roll; of a band its name, wavelength, width, number of the
/// sensor and capture).
std::string xmp_segment(const PhotoFacts& facts);

/// A TIFF file (revision 6.0) of one band with 16 bits, not compressed, with the Exif directories
/// and the XMP packet in it.
std::string tiff_file(const PhotoFacts& facts, const Picture& band);

}  // namespace vinerow::tools
