#pragma once
/// A vehicle's low-complexity map as lines: what the log keeps of it for pictures and viewers.

#include "engine/api/forward.h"
#include "engine/api/messages/path.h"

namespace vinerow {

/// Edges of the map's row meshes, each once. The diagonals of quads are left out, a third of all
/// edges: an edge is one if it is the longest of both its triangles and they bend by less than 45
/// degrees along it. Vertices at the same place count as one.
LineList map_edges(const RowMap& map);

}  // namespace vinerow
