#pragma once
/// Whether a point is inside of a mesh.

#include <Eigen/Core>

#include "engine/api/mesh.h"

namespace vinerow::physics {

/// Times that a mesh goes around a point: the solid angles of its triangles, summed, over 4 pi
/// (van Oosterom, Strackee: The Solid Angle of a Plane Triangle, IEEE Transactions on Biomedical
/// Engineering 30 (1983), equation 8). Around a point inside of a closed surface it is 1, or -1 if
/// the triangles are turned inside out, outside 0. A surface with openings goes around a point less
/// than once, by the share of its view that they take. @param p_M  in the mesh's frame
double calc_winding(const TriangleMesh& mesh, const Eigen::Vector3d& p_M);

}  // namespace vinerow::physics
