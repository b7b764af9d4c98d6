#pragma once
/// Pictures of a map made from a point cloud, for `vinerow map`.
///
/// All are functions of map and cloud alone. In large clouds every n-th point is drawn, so that a
/// picture takes a few seconds at most.

#include <string>

#include "engine/render/scene.h"
#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::tools {

/// Oblique view of the cloud: ground brown, low vegetation yellow-green, rows in two alternating
/// greens, everything else grey. @pre cloud.classes has an entry per point
render::Image draw_classes(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                           const std::string& title);

/// Row meshes over the ground points of the whole parcel; below it a section of a few metres, with
/// its points next to its meshes. @pre as above
render::Image draw_meshes(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                          const std::string& title);

/// Top view, north up: canopy by height, rows with numbers, ends and gaps, boundary, scale.
/// @pre as above
render::Image draw_top(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                       const std::string& title);

/// Occupancy grid with its virtual walls. @param options  options with which the grid was made
render::Image draw_map_grid(const mapping::CloudMap& map, const mapping::OccupancyOptions& options,
                            const std::string& title);

}  // namespace vinerow::tools
