#include "vehicles/parts/mesh_builder.h"

#include <cmath>
#include <utility>
#include <vector>

#include "engine/math/angles.h"
#include "engine/math/srgb.h"

namespace vinerow::vehicles {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

float linear_from_byte(unsigned byte) {
  return static_cast<float>(linear_from_srgb(byte / 255.0));
}

/// Point of a ring about y at an angle from x towards z.
Vector3d on_ring(double radius_m, double y_m, double angle_rad) {
  return {radius_m * std::cos(angle_rad), y_m, radius_m * std::sin(angle_rad)};
}

/// The convex outline moved inwards by `distance_m`.
std::vector<Vector2d> inset(std::span<const Vector2d> outline, double distance_m) {
  const std::size_t count = outline.size();
  std::vector<Vector2d> result;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d& before = outline[(i + count - 1) % count];
    const Vector2d& here = outline[i];
    const Vector2d& after = outline[(i + 1) % count];
    const Vector2d d1 = (here - before).normalized(), d2 = (after - here).normalized();
    const Vector2d n1(-d1.y(), d1.x()), n2(-d2.y(), d2.x());  // inwards of a counter-clockwise line
    const Vector2d mean = n1 + n2;
    result.push_back(here + mean * (distance_m * 2.0 / mean.squaredNorm()));
  }
  return result;
}

}  // namespace

Vector3f colour_from_srgb(unsigned hex) {
  return {linear_from_byte((hex >> 16) & 0xff), linear_from_byte((hex >> 8) & 0xff),
          linear_from_byte(hex & 0xff)};
}

MeshBuilder& MeshBuilder::place(const Pose& X_MF) {
  X_MF_ = X_MF;
  return *this;
}

MeshBuilder& MeshBuilder::place(double x_m, double y_m, double z_m) {
  return place(Pose{Eigen::Quaterniond::Identity(), {x_m, y_m, z_m}});
}

MeshBuilder& MeshBuilder::colour(const Vector3f& rgb) {
  colour_ = rgb;
  return *this;
}

std::uint32_t MeshBuilder::add_vertex(const Vector3d& p_F, const Vector3d& normal_F) {
  mesh_.vertices.push_back((X_MF_ * p_F).cast<float>());
  mesh_.normals.push_back((X_MF_.q * normal_F).normalized().cast<float>());
  mesh_.colours.push_back(colour_);
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

MeshBuilder& MeshBuilder::triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  if (normal.squaredNorm() < 1e-24) return *this;
  const std::uint32_t i = add_vertex(a, normal);
  add_vertex(b, normal);
  add_vertex(c, normal);
  mesh_.triangles.push_back({i, i + 1, i + 2});
  return *this;
}

MeshBuilder& MeshBuilder::quad(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                               const Vector3d& d) {
  const Vector3d normal = (c - a).cross(d - b);
  if (normal.squaredNorm() < 1e-24) return *this;
  const std::uint32_t i = add_vertex(a, normal);
  add_vertex(b, normal);
  add_vertex(c, normal);
  add_vertex(d, normal);
  mesh_.triangles.push_back({i, i + 1, i + 2});
  mesh_.triangles.push_back({i, i + 2, i + 3});
  return *this;
}

MeshBuilder& MeshBuilder::box(const Vector3d& half_extents_m, double chamfer_m) {
  const double c = chamfer_m;
  // Corner of the face across `axis`, for signs s: full extent along the axis, cut along the
  // others.
  const auto corner = [&](const Vector3d& sign, int axis) {
    Vector3d p = sign.cwiseProduct(half_extents_m - Vector3d::Constant(c));
    p[axis] = sign[axis] * half_extents_m[axis];
    return p;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](double su, double sv) {
        Vector3d sign;
        sign[axis] = side, sign[u] = su * side, sign[v] = sv;
        return corner(sign, axis);
      };
      quad(at(-1, -1), at(1, -1), at(1, 1), at(-1, 1));
    }
    if (c <= 0.0) continue;
    // Bevel between the faces across u and v, along `axis`.
    for (const double su : {-1.0, 1.0}) {
      for (const double sv : {-1.0, 1.0}) {
        const auto at = [&](double end, int face) {
          Vector3d sign;
          sign[axis] = end, sign[u] = su, sign[v] = sv;
          return corner(sign, face);
        };
        const double turn = su * sv;
        quad(at(-turn, u), at(-turn, v), at(turn, v), at(turn, u));
      }
    }
  }
  if (c <= 0.0) return *this;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      for (const double sz : {-1.0, 1.0}) {
        const Vector3d sign(sx, sy, sz);
        if (sx * sy * sz > 0.0) {
          triangle(corner(sign, 0), corner(sign, 1), corner(sign, 2));
        } else {
          triangle(corner(sign, 0), corner(sign, 2), corner(sign, 1));
        }
      }
    }
  }
  return *this;
}

MeshBuilder& MeshBuilder::extrude(std::span<const Vector2d> outline, double half_width_m,
                                  double bevel_m) {
  const std::vector<Vector2d> cap = inset(outline, bevel_m);
  const double inner = half_width_m - bevel_m;
  const auto at = [](const Vector2d& p, double y) { return Vector3d(p.x(), y, p.y()); };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t j = (i + 1) % outline.size();
    // Seen from -y the outline runs counter-clockwise: outside is to the right of i -> j.
    quad(at(outline[j], inner), at(outline[j], -inner), at(outline[i], -inner),
         at(outline[i], inner));
    if (bevel_m > 0.0) {
      quad(at(outline[j], -inner), at(cap[j], -half_width_m), at(cap[i], -half_width_m),
           at(outline[i], -inner));
      quad(at(outline[i], inner), at(cap[i], half_width_m), at(cap[j], half_width_m),
           at(outline[j], inner));
    }
    if (i >= 1 && i + 1 < outline.size()) {
      triangle(at(cap[0], -half_width_m), at(cap[i], -half_width_m), at(cap[i + 1], -half_width_m));
      triangle(at(cap[0], half_width_m), at(cap[i + 1], half_width_m), at(cap[i], half_width_m));
    }
  }
  return *this;
}

MeshBuilder& MeshBuilder::lathe(std::span<const Vector2d> outline, int segments) {
  // Normals of the outline's pieces, in (radius, y): to the right of its direction.
  const std::size_t pieces = outline.size() - 1;
  std::vector<Vector2d> normals(pieces);
  for (std::size_t i = 0; i < pieces; ++i) {
    const Vector2d along = outline[i + 1] - outline[i];
    normals[i] =
        along.norm() > 1e-9 ? Vector2d(along.y(), -along.x()).normalized() : Vector2d::Zero();
  }
  const auto vertex_normal = [&](std::size_t piece, bool end) -> Vector2d {
    // Smooth over gentle bends, sharp over an edge of more than 50 degrees.
    const std::size_t neighbour = end ? piece + 1 : piece - 1;
    if (neighbour >= pieces || normals[piece].dot(normals[neighbour]) < 0.64) return normals[piece];
    return (normals[piece] + normals[neighbour]).normalized();
  };
  for (std::size_t i = 0; i < pieces; ++i) {
    if (normals[i].isZero()) continue;
    const Vector2d n0 = vertex_normal(i, false), n1 = vertex_normal(i, true);
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (int k = 0; k <= segments; ++k) {
      const double angle = 2.0 * kPi * k / segments;
      add_vertex(on_ring(outline[i].x(), outline[i].y(), angle), on_ring(n0.x(), n0.y(), angle));
      add_vertex(on_ring(outline[i + 1].x(), outline[i + 1].y(), angle),
                 on_ring(n1.x(), n1.y(), angle));
    }
    for (int k = 0; k < segments; ++k) {
      const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(k);
      if (outline[i].x() > 1e-9) mesh_.triangles.push_back({a, a + 1, a + 2});
      if (outline[i + 1].x() > 1e-9) mesh_.triangles.push_back({a + 1, a + 3, a + 2});
    }
  }
  return *this;
}

MeshBuilder& MeshBuilder::cylinder(double radius_m, double half_width_m, int segments) {
  const Vector2d outline[] = {{0.0, -half_width_m},
                              {radius_m, -half_width_m},
                              {radius_m, half_width_m},
                              {0.0, half_width_m}};
  return lathe(outline, segments);
}

MeshBuilder& MeshBuilder::rod(const Vector3d& a, const Vector3d& b, double radius_m, int segments) {
  const Pose before = X_MF_;
  const Vector3d along = b - a;
  X_MF_ =
      before * Pose{Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), along), 0.5 * (a + b)};
  cylinder(radius_m, 0.5 * along.norm(), segments);
  X_MF_ = before;
  return *this;
}

MeshBuilder& MeshBuilder::ring_sector(double inner_m, double outer_m, double half_width_m,
                                      double from_rad, double to_rad, int segments) {
  const double w = half_width_m;
  for (int k = 0; k < segments; ++k) {
    const double a = from_rad + (to_rad - from_rad) * k / segments;
    const double b = from_rad + (to_rad - from_rad) * (k + 1) / segments;
    // The curved faces are shaded smooth: their normals point along the radius.
    for (const auto& [radius, out] : {std::pair{outer_m, 1.0}, std::pair{inner_m, -1.0}}) {
      const std::uint32_t i = add_vertex(on_ring(radius, out * w, a), on_ring(out, 0.0, a));
      add_vertex(on_ring(radius, out * w, b), on_ring(out, 0.0, b));
      add_vertex(on_ring(radius, -out * w, b), on_ring(out, 0.0, b));
      add_vertex(on_ring(radius, -out * w, a), on_ring(out, 0.0, a));
      mesh_.triangles.push_back({i, i + 1, i + 2});
      mesh_.triangles.push_back({i, i + 2, i + 3});
    }
    quad(on_ring(outer_m, -w, a), on_ring(outer_m, -w, b), on_ring(inner_m, -w, b),
         on_ring(inner_m, -w, a));
    quad(on_ring(inner_m, w, a), on_ring(inner_m, w, b), on_ring(outer_m, w, b),
         on_ring(outer_m, w, a));
  }
  for (const auto& [angle, turn] : {std::pair{from_rad, 1.0}, std::pair{to_rad, -1.0}}) {
    quad(on_ring(inner_m, w * turn, angle), on_ring(outer_m, w * turn, angle),
         on_ring(outer_m, -w * turn, angle), on_ring(inner_m, -w * turn, angle));
  }
  return *this;
}

MeshBuilder& MeshBuilder::append(const TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  const bool has_normals = mesh.normals.size() == mesh.vertices.size();
  const bool has_colours = mesh.colours.size() == mesh.vertices.size();
  if (!has_normals) {
    // Flat faces: a mesh without normals is mostly a CAD part with sharp edges.
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3f own = colour_;
      if (has_colours) colour_ = mesh.colours[t[0]];
      triangle(mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
               mesh.vertices[t[2]].cast<double>());
      colour_ = own;
    }
    return *this;
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    add_vertex(mesh.vertices[i].cast<double>(), mesh.normals[i].cast<double>());
    if (has_colours) mesh_.colours.back() = mesh.colours[i];
  }
  for (const auto& t : mesh.triangles) {
    mesh_.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return *this;
}

}  // namespace vinerow::vehicles
