#pragma once
/// Mesh and terrain decimation for meshes that are too large for a page.
///
/// Source: J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering complex
/// scenes", Modeling in Computer Graphics, 1993: vertices of one cell become their mean.

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"

namespace vinerow::tools {

/// Mesh in which all vertices in a cell of a grid of `cell_m` become one, at their mean position
/// and colour. Triangles that lose a corner, normals and texture coordinates are dropped, and so
/// are triangles with an index beyond the vertices. No vertex moves farther than a cell's diagonal.
TriangleMesh cluster_vertices(const TriangleMesh& mesh, double cell_m);

/// Every k-th card of a mesh of leaf cards (pieces with consecutive vertices), scaled about its
/// middle by sqrt(k): fewer and larger leaves with the same area. @pre keep_every >= 1
TriangleMesh thin_cards(const TriangleMesh& mesh, int keep_every);

/// Every k-th sample of a field, with its last row and column repeated if k does not divide their
/// number. Heights are unchanged. @pre stride >= 1
HeightField thin_height_field(const HeightField& field, int stride);

/// Smallest stride that leaves at most `max_samples` (>= 9).
int stride_for(const HeightField& field, int max_samples);

/// Samples first to last (both included) of each direction.
HeightField crop_height_field(const HeightField& field, const Eigen::Vector2i& first,
                              const Eigen::Vector2i& last);

}  // namespace vinerow::tools
