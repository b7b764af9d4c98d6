#pragma once
/// What the pictures of a map show that was made of a point cloud.

#include <string>

namespace vinerow::tools {

/// One sentence for "top", "classes", "mesh" and "grid", the files of write_map_pictures(); the
/// name itself for others.
std::string map_picture_caption(const std::string& name);

}  // namespace vinerow::tools
