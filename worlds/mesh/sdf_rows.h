#pragma once
/// Vine rows of an SDF world: includes of vine models, grouped into lines.

#include <string>
#include <vector>

#include "engine/io/robots/sdf.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::worlds {

/// Groups the pieces whose model name starts with a prefix. Pieces extend along their own x axis
/// and are centred on their pose. Pieces of one row share their direction (within 10 deg) and line
/// (within `apart_m`).
/// @param piece_length_m  of one model, along x
/// @returns rows in the order of order_rows(); empty if no model has the prefix
std::vector<mapping::RowCurve> find_sdf_rows(const std::vector<io::SdfInclude>& includes,
                                             const std::string& prefix, double piece_length_m,
                                             double apart_m = 0.5);

/// Plane z = a + b x + c y through the pieces' feet, by least squares.
/// @returns (a, b, c); (0, 0, 0) without pieces; slopes that the pieces do not determine are 0
Eigen::Vector3d fit_ground_plane(const std::vector<io::SdfInclude>& includes,
                                 const std::string& prefix);

}  // namespace vinerow::worlds
