#pragma once
/// Reader of PCD 0.6 and 0.7 files (Point Cloud Library): ascii and binary.
///
/// It reads x y z, rgb or rgba packed into 32 bits (0xAARRGGBB, also as the bits of a float field),
/// and label or classification from 0 to 255. Other fields are ignored. The viewpoint is the pose
/// of the sensor; as in PCL it is not applied to the points.
/// Source: PCL documentation, "The PCD (Point Cloud Data) file format".

#include <memory>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// @param file  positioned at its first byte. @throws ConfigError as open_point_cloud()
std::unique_ptr<PointCloudReader> open_pcd(BlockFile file);

}  // namespace vinerow::io
