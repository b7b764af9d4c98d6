#pragma once
/// Fewer triangles for meshes that are too large for a page.
///
/// Source: J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering complex
/// scenes", Modeling in Computer Graphics, 1993: vertices of one cell become their mean.

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"

namespace vinerow::tools {

/// Vertices in one cell of a grid of `cell_m` become one, at their mean place and colour; triangles
/// that lose a corner are left out, as are normals and texture coordinates. No vertex moves farther
/// than a cell's diagonal. Triangles with an index beyond the vertices are dropped.
TriangleMesh cluster_vertices(const TriangleMesh& mesh, double cell_m);

/// Every k-th card of a mesh of leaf cards (pieces whose vertices follow each other), grown about
/// its middle by the root of k: fewer and larger leaves of the same area. @pre keep_every >= 1
TriangleMesh thin_cards(const TriangleMesh& mesh, int keep_every);

/// Every k-th sample of a field, with its last row and column repeated where k does not divide
/// them. Heights are the field's own. @pre stride >= 1
HeightField thin_height_field(const HeightField& field, int stride);

/// The least stride that leaves at most `most_samples` (>= 9).
int stride_for(const HeightField& field, int most_samples);

/// Samples first to last (both included) of each direction.
HeightField crop_height_field(const HeightField& field, const Eigen::Vector2i& first,
                              const Eigen::Vector2i& last);

}  // namespace vinerow::tools
