#pragma once
/// Row meshes of a vehicle's map as lines, for the log, pictures and viewers.

#include "engine/api/forward.h"
#include "engine/api/messages/path.h"

namespace vinerow {

/// Edges of the map's row meshes, each once, without the diagonals of quads, which are a third of
/// all edges. An edge is a diagonal if it is the longest edge of both its triangles and the angle
/// between their normals is less than 45 degrees. Vertices at the same place count as one.
LineList map_edges(const RowMap& map);

}  // namespace vinerow
