#pragma once
/// Points of text files, one a line: XYZ, CSV and their kin.
///
/// Columns are separated by blanks, commas or semicolons, as the first line of points has them. The
/// decimal sign is a point. A first line of names, also after // or #, tells the columns: x y z (or
/// easting, northing, height), red green blue (or r g b) from 0 to 255, classification (or class,
/// label); others are skipped. Without names the first three columns are x y z, and the next three
/// are a colour where the first line has whole numbers from 0 to 255 there. A first line of one
/// whole number counts the points (PTS); PTS has the intensity before the colour. Lines that begin
/// with # or // and blank lines are skipped.

#include <memory>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// @param file  at its first byte. @throws ConfigError as open_point_cloud()
std::unique_ptr<PointCloudReader> open_xyz(BlockFile file);

}  // namespace vinerow::io
