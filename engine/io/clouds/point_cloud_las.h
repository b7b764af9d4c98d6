#pragma once
/// Points of uncompressed LAS 1.2, 1.3 and 1.4 files, point formats 0 to 10.
///
/// Of each point: x y z, colour (formats 2, 3, 5, 7, 8, 10), classification. Points marked as
/// withheld are left out and counted. Returns, intensity, times, waveforms and extra bytes are
/// skipped. Colours are 16 bits by the specification, but many files hold 8: a file whose sampled
/// points (1024 of them, evenly spread) have no value above 255 is taken as one of those.
/// Source: ASPRS, LAS Specification 1.2 (2008), 1.3-R11 (2010), 1.4-R15 (2019).

#include <memory>

#include "engine/io/clouds/point_cloud.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// @param file  at its first byte. @throws ConfigError as open_point_cloud()
std::unique_ptr<PointCloudReader> open_las(BlockFile file);

}  // namespace vinerow::io
