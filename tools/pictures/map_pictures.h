#pragma once
/// Pictures of a map that was made of a point cloud: what `vinerow map` shows its user.
///
/// All are functions of map and cloud alone. Of large clouds every n-th point is drawn, so that
/// each takes a few seconds at most.

#include <string>

#include "engine/render/scene.h"
#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::tools {

/// Oblique view of the cloud: ground brown, low vegetation yellow-green, rows in two greens in
/// turn, all else grey. @pre cloud.classes has an entry per point
render::Image draw_classes(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                           const std::string& title);

/// Row meshes over the ground points of the whole parcel; below it a stretch of few metres, its
/// points beside its meshes. @pre as above
render::Image draw_meshes(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                          const std::string& title);

/// From above, north up: canopy by height, rows with numbers, ends and gaps, boundary, scale.
/// @pre as above
render::Image draw_top(const mapping::CloudMap& map, const mapping::ParcelCloud& cloud,
                       const std::string& title);

/// The occupancy grid with its virtual walls. @param options  as the grid was made
render::Image draw_map_grid(const mapping::CloudMap& map, const mapping::OccupancyOptions& options,
                            const std::string& title);

}  // namespace vinerow::tools
