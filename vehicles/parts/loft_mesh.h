#pragma once
/// A skin over rows of points, shaded smooth: wings, fins, fuselages.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {

/// Rows of equally many points; the outside is where (next point) x (next row) points to.
using LoftRows = std::vector<std::vector<Eigen::Vector3d>>;

struct LoftOptions {
  bool closed = false;    ///< the last point of a row is followed by its first
  bool mirrored = false;  ///< the outside is the other side
  /// Of the face behind row i and point j; empty: the builder's.
  std::function<Eigen::Vector3f(std::size_t i, std::size_t j)> colour;
};

/// Appends the skin in the builder's frame. @pre at least two rows of two points
void append_loft(const LoftRows& rows, const LoftOptions& options, MeshBuilder& builder);

/// A flat lid over a row. @param outward  about the direction it looks to
void append_lid(const std::vector<Eigen::Vector3d>& row, const Eigen::Vector3d& outward,
                MeshBuilder& builder);

}  // namespace vinerow::vehicles
