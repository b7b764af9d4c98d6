#include "vehicles/fixed_wing/fixed_wing_mesh.h"

#include <cmath>

#include "vehicles/fixed_wing/fixed_wing_shapes.h"
#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {

using Eigen::Vector3d;

TriangleMesh make_fixed_wing_body(const FixedWingParams& p) {
  MeshBuilder b;
  const double root = p.shape.root_chord_m;
  b.colour(colour_from_srgb(0xf1f2ee)).place(p.shape.leading_edge_m - 0.4 * root, 0, 0);
  b.box({0.5 * root, kHalfWidth * root, 0.8 * p.shape.belly_m}, 0.02);
  return b.take();
}

Pose elevon_hinge_X_BE(const FixedWingParams& p, double side) {
  const auto hinge = [&](double share) {
    const WingStation station = wing_station(p, share, side);
    return Vector3d(station.leading_B -
                    Vector3d((1.0 - p.shape.elevon_chord) * station.chord_m, 0, 0));
  };
  const Vector3d inner = hinge(p.shape.elevon_from), outer = hinge(p.shape.elevon_to);
  const Vector3d y = side * (outer - inner).normalized();
  const Vector3d x = y.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << x, y, x.cross(y);
  return {Eigen::Quaterniond(R), inner};
}

TriangleMesh make_fixed_wing_elevon(const FixedWingParams& p, double side) {
  MeshBuilder b;
  const double length = (p.shape.elevon_to - p.shape.elevon_from) * 0.5 * p.wing.span_m;
  b.colour(colour_from_srgb(0xe0601c)).place(-0.03, 0.5 * side * length, 0);
  b.box({0.03, 0.5 * length, 0.004}, 0.001);
  return b.take();
}

Vector3d propeller_B(const FixedWingParams& p) {
  return {p.shape.leading_edge_m - 1.04 * p.shape.root_chord_m, 0.0, 0.045};
}

TriangleMesh make_fixed_wing_propeller(const FixedWingParams& p) {
  MeshBuilder b;
  const double radius = std::sqrt(p.propeller.area_m2 / kPi);
  b.colour(colour_from_srgb(0x1d1f22)).place(0, 0, 0);
  b.box({0.004, radius, 0.01}, 0.001);
  return b.take();
}

}  // namespace vinerow::vehicles
