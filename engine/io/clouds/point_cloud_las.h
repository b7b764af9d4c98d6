#pragma once
/// Reader of uncompressed LAS 1.2, 1.3 and 1.4 files, point formats 0 to 10.
///
/// It reads x y z, colour (formats 2, 3, 5, 7, 8, 10) and classification of each point. Points
/// marked as withheld are skipped and counted. Returns, intensity, times, waveforms and extra bytes
/// are ignored. Colours have 16 bits by the specification, but many files store 8: a file is read
/// as 8-bit if no value of its 1024 evenly spread sample points exceeds 255.
/// Source: ASPRS, LAS Specification 1.2 (2008), 1.3-R11 (2010), 1.4-R15 (2019).

#include <memory>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// @param file  positioned at its first byte. @throws ConfigError as open_point_cloud()
std::unique_ptr<PointCloudReader> open_las(BlockFile file);

}  // namespace vinerow::io
