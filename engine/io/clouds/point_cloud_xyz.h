#pragma once
/// Reader of text files with one point per line: XYZ, CSV, PTS and similar.
///
/// Columns are separated by blanks, commas or semicolons, as in the first line of points. The
/// decimal sign is a point. A first line of names, also after // or #, defines the columns: x y z
/// (or easting, northing, height), red green blue (or r g b) from 0 to 255, classification (or
/// class, label); others are ignored. Without names the first three columns are x y z, and the next
/// three are a colour if the first line has whole numbers from 0 to 255 there. If the first line is
/// one whole number, it is the number of points (PTS); PTS has the intensity before the colour.
/// Blank lines and lines that begin with # or // are skipped.

#include <memory>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// @param file  positioned at its first byte. @throws ConfigError as open_point_cloud()
std::unique_ptr<PointCloudReader> open_xyz(BlockFile file);

}  // namespace vinerow::io
