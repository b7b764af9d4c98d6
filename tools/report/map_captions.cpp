#include "tools/report/map_captions.h"

namespace vinerow::tools {

std::string map_picture_caption(const std::string& name) {
  if (name == "top")
    return "Canopy from above with the rows that were found, their numbers and ends.";
  if (name == "classes") return "The point cloud, coloured by what its points belong to.";
  if (name == "mesh") {
    return "The low-complexity meshes of the rows over the ground, and a stretch of them beside "
           "its "
           "points.";
  }
  if (name == "grid") {
    return "The occupancy grid, with virtual walls where the serpentine is to be the only way.";
  }
  return name;
}

}  // namespace vinerow::tools
