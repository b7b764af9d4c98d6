#pragma once
/// Points of PCD 0.6 and 0.7 files (Point Cloud Library): ascii and binary.
///
/// Of each point: x y z, rgb or rgba packed into 32 bits (0xAARRGGBB, also where the field is a
/// float whose bits are meant), label or classification from 0 to 255. Other fields are skipped.
/// The viewpoint is where the sensor stood; the points are not moved by it, as PCL does not.
/// Source: PCL documentation, "The PCD (Point Cloud Data) file format".

#include <memory>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// @param file  at its first byte. @throws ConfigError as open_point_cloud()
std::unique_ptr<PointCloudReader> open_pcd(BlockFile file);

}  // namespace vinerow::io
