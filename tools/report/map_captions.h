#pragma once
/// Captions for the pictures of a map made from a point cloud.

#include <string>

namespace vinerow::tools {

/// One sentence for "top", "classes", "mesh" and "grid", the files of write_map_pictures();
/// otherwise the name itself.
std::string map_picture_caption(const std::string& name);

}  // namespace vinerow::tools
