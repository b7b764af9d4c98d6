#pragma once
/// `vinerow export`: the clouds of a topic as one file.

#include <string>

#include "tools/vinerow/export_source.h"

namespace vinerow::tools {

/// Writes all clouds of a topic into -o, a .ply, .pcd or .las file, in the frame of the map or in
/// --crs, by the poses of --poses or, if it is not given, by the true ones.
/// @throws ConfigError if the log does not have what that needs
void write_map_cloud(record::McapReader& log, const std::string& topic, const TopicSource& source,
                     const ExportArguments& arguments);

}  // namespace vinerow::tools
