#pragma once
/// `vinerow export`: the clouds of a topic as one file.

#include <string>

#include "tools/export/scan_files.h"
#include "tools/vinerow/export_source.h"

namespace vinerow::tools {

/// Writes all clouds of a topic in the frame of the map, by the poses of --poses or, if it is not
/// given, by the true ones.
/// @throws ConfigError if the log does not have what that needs
void write_map_cloud(record::McapReader& log, const std::string& topic, const TopicSource& source,
                     const ExportArguments& arguments, CloudFormat format);

}  // namespace vinerow::tools
