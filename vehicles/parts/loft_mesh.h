#pragma once
/// Smoothly shaded skin over rows of points, for wings, fins and fuselages.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {

/// Rows with equal numbers of points. The outward normal is along (next point) x (next row).
using LoftRows = std::vector<std::vector<Eigen::Vector3d>>;

struct LoftOptions {
  bool closed = false;    ///< the last point of a row is followed by its first
  bool mirrored = false;  ///< reverses the outward normal
  /// Colour of the face after row i and point j; empty: the builder's colour.
  std::function<Eigen::Vector3f(std::size_t i, std::size_t j)> colour;
};

/// Appends the skin in the builder's frame. @pre at least two rows of two points
void append_loft(const LoftRows& rows, const LoftOptions& options, MeshBuilder& builder);

/// Appends a flat lid over a row. @param outward  approximate direction of its normal
void append_lid(const std::vector<Eigen::Vector3d>& row, const Eigen::Vector3d& outward,
                MeshBuilder& builder);

}  // namespace vinerow::vehicles
