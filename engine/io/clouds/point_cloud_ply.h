#pragma once
/// Reader of points in PLY 1.0 files: ascii, and binary in both byte orders.
///
/// It reads these properties of the element "vertex": x y z of any number type; red green blue
/// (integers of 8 or 16 bits, or real numbers from 0 to 1); classification, class, label or
/// scalar_Classification. Other properties and elements, lists included, are ignored.
/// Source: G. Turk, "The PLY Polygon File Format", 1994.

#include <memory>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// @param file  positioned at its first byte. @throws ConfigError as open_point_cloud()
std::unique_ptr<PointCloudReader> open_ply(BlockFile file);

}  // namespace vinerow::io
