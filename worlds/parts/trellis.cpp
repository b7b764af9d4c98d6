#include "worlds/parts/trellis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "worlds/parts/primitives.h"

namespace vinerow::worlds {
namespace {

const Eigen::Vector3f kBark(0.075f, 0.052f, 0.036f);
const Eigen::Vector3f kSteel(0.32f, 0.33f, 0.34f);
const Eigen::Vector3f kWood(0.22f, 0.165f, 0.11f);
constexpr double kWireRadius_m = 0.0025;
constexpr double kBuriedDepth_m = 0.1;  // feet reach below the ground's triangles

}  // namespace

const ParameterTable<TrellisParams>& trellis_table() {
  using P = TrellisParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .boolean("posts", &P::posts, "true: rows have posts and wires")
          .number("post_spacing_m", "m", &P::post_spacing_m, between(0.1, 100.0),
                  "distance between posts of a row")
          .number("post_height_m", "m", &P::post_height_m, above(0.0, 10.0),
                  "height of posts above ground")
          .degrees("end_post_lean_deg", &P::end_post_lean_rad, between(0.0, 40.0),
                   "outward lean of end posts")
          .number("trunk_radius_m", "m", &P::trunk_radius_m, between(1e-3, 0.5),
                  "radius of vine stems")
          .number("arm_height_m", "m", &P::arm_height_m, above(0.0, 10.0),
                  "height of the vines' arms and of the first wire; default: 0.75 m, of a pergola "
                  "0.1 m "
                  "below its roof");
  return table;
}

TriangleMesh make_trunks(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                         const std::vector<double>& vine_s_m, double vine_spacing_m,
                         const TrellisParams& params, int level, RandomStream random) {
  TriangleMesh mesh;
  const int sides = level == 0 ? 5 : 3;
  for (const double s_m : vine_s_m) {
    mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    const Pose X_WR = mapping::row_frame(row, ground, s_m);
    // The same numbers are drawn at every level, so that levels show the same stems.
    const double girth = random.uniform(0.8, 1.25);
    double bend_m[3][2];
    for (auto& bend : bend_m) {
      bend[0] = random.uniform(-0.05, 0.05);
      bend[1] = random.uniform(-0.035, 0.035);
    }
    const float shade = static_cast<float>(random.uniform(0.75, 1.3));
    const double r = params.trunk_radius_m * girth, top = params.arm_m();
    const auto point = [&](double share, int bend, double radius) {
      const Eigen::Vector3d p(bend < 0 ? 0.0 : bend_m[bend][0], bend < 0 ? 0.0 : bend_m[bend][1],
                              share * top);
      return TubePoint{X_WR * p, radius};
    };
    const std::array<TubePoint, 5> stem = {
        TubePoint{X_WR * Eigen::Vector3d(0, 0, -kBuriedDepth_m), 1.25 * r},
        point(0.05, -1, 1.2 * r), point(0.4, 0, 0.95 * r), point(0.75, 1, 0.85 * r),
        point(1.0, 2, 0.8 * r)};
    if (level == 0) {
      append_tube(mesh, stem, sides, shade * kBark);
      const double reach_m = 0.46 * vine_spacing_m;
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector3d head(bend_m[2][0], bend_m[2][1], top - 0.02);
        const Eigen::Vector3d elbow(sign * 0.4 * reach_m, 0.5 * bend_m[1][1], top + 0.03);
        const Eigen::Vector3d end(sign * reach_m, 0.0, top + 0.02);
        const std::array<TubePoint, 3> arm = {TubePoint{X_WR * head, 0.7 * r},
                                              TubePoint{X_WR * elbow, 0.55 * r},
                                              TubePoint{X_WR * end, 0.4 * r}};
        append_tube(mesh, arm, 3, shade * kBark);
      }
    } else {
      const std::array<TubePoint, 2> far = {stem[0], stem[4]};
      append_tube(mesh, far, sides, shade * kBark);
    }
  }
  return mesh;
}

TriangleMesh make_line_posts(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                             const std::vector<double>& post_s_m, const TrellisParams& params) {
  TriangleMesh mesh;
  for (const double s_m : post_s_m) {
    mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    const Pose X_WR = mapping::row_frame(row, ground, s_m);
    const std::array<TubePoint, 2> post = {
        TubePoint{X_WR * Eigen::Vector3d(0, 0, -kBuriedDepth_m), params.post_radius_m},
        TubePoint{X_WR * Eigen::Vector3d(0, 0, params.post_height_m), params.post_radius_m}};
    append_tube(mesh, post, 6, kSteel);
  }
  return mesh;
}

TriangleMesh make_end_posts(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                            double start_m, double end_m, const TrellisParams& params) {
  TriangleMesh mesh;
  for (const bool at_start : {true, false}) {
    mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    const Pose X_WR = mapping::row_frame(row, ground, at_start ? start_m : end_m);
    const double sign = at_start ? -1.0 : 1.0;
    const double lean = params.end_post_lean_rad, height = params.post_height_m;
    const Eigen::Vector3d up(sign * std::sin(lean), 0.0, std::cos(lean));
    const std::array<TubePoint, 2> post = {
        TubePoint{X_WR * Eigen::Vector3d(-kBuriedDepth_m * up), params.end_post_radius_m},
        TubePoint{X_WR * Eigen::Vector3d(height * up), 0.9 * params.end_post_radius_m}};
    append_tube(mesh, post, 8, kWood);
  }
  return mesh;
}

TriangleMesh make_wires(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                        double start_m, double end_m, const TrellisParams& params) {
  TriangleMesh mesh;
  const std::vector<double> stations = spread_posts(start_m, end_m, params.post_spacing_m);
  const double first = params.arm_m(), last = params.post_height_m - 0.05;
  constexpr int kWires = 4;
  for (int w = 0; w < kWires; ++w) {
    const double height_m = first + (last - first) * w / (kWires - 1);
    std::vector<TubePoint> points;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      // At the ends the wire meets the leaning post.
      const double sign = i == 0 ? -1.0 : (i + 1 == stations.size() ? 1.0 : 0.0);
      const Eigen::Vector3d p(sign * height_m * std::tan(params.end_post_lean_rad), 0.0, height_m);
      points.push_back({mapping::row_frame(row, ground, stations[i]) * p, kWireRadius_m});
    }
    append_tube(mesh, points, 3, kSteel);
  }
  return mesh;
}

TriangleMesh make_roof_wires(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                             double start_m, double end_m, const TrellisParams& params,
                             const RoofParams& roof) {
  constexpr double kApart_m = 0.5;
  TriangleMesh mesh;
  const std::vector<double> stations = spread_posts(start_m, end_m, params.post_spacing_m);
  const int gaps = std::max(1, static_cast<int>(std::ceil(roof.width_m / kApart_m - 1e-9)));
  for (int w = 0; w <= gaps; ++w) {
    const double left_m = roof.width_m * (static_cast<double>(w) / gaps - 0.5);
    std::vector<TubePoint> points;
    for (const double s_m : stations) {
      const Pose X_WR = mapping::row_frame(row, ground, s_m);
      points.push_back({X_WR * Eigen::Vector3d(0.0, left_m, roof.height_m), kWireRadius_m});
    }
    append_tube(mesh, points, 3, kSteel);
  }
  return mesh;
}

TriangleMesh make_roof_beams(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                             const std::vector<double>& post_s_m, const RoofParams& roof) {
  // The wires lie on the beams.
  constexpr double kRadius_m = 0.03;
  TriangleMesh mesh;
  for (const double s_m : post_s_m) {
    mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    const Pose X_WR = mapping::row_frame(row, ground, s_m);
    const auto end = [&](double side) {
      return TubePoint{X_WR * Eigen::Vector3d(0.0, side * 0.5 * roof.width_m,
                                              roof.height_m - kRadius_m - kWireRadius_m),
                       kRadius_m};
    };
    const std::array<TubePoint, 2> beam = {end(-1.0), end(1.0)};
    append_tube(mesh, beam, 6, kWood);
  }
  return mesh;
}

std::vector<double> spread_posts(double start_m, double end_m, double spacing_m) {
  const int spans = std::max(1, static_cast<int>(std::ceil((end_m - start_m) / spacing_m - 1e-9)));
  std::vector<double> stations;
  for (int i = 0; i <= spans; ++i) stations.push_back(start_m + (end_m - start_m) * i / spans);
  return stations;
}

}  // namespace vinerow::worlds
