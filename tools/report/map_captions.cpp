#include "tools/report/map_captions.h"

namespace vinerow::tools {

std::string map_picture_caption(const std::string& name) {
  if (name == "top") return "Canopy from above with the detected rows, their numbers and ends.";
  if (name == "classes") return "The point cloud, coloured by class.";
  if (name == "mesh") {
    return "The low-complexity meshes of the rows over the ground, and a section of them next to "
           "its "
           "points.";
  }
  if (name == "grid") {
    return "The occupancy grid, with the virtual walls that leave only the serpentine free.";
  }
  return name;
}

}  // namespace vinerow::tools
