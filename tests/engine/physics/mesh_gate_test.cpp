/// The proof that a body of one shape or several is clear of a static mesh, and what it must never
/// hide: a contact. Spheres against an upright box: who touches is known in closed form.

#include "engine/physics/mesh_gate.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/random.h"
#include "tests/engine/physics/small_worlds.h"

namespace vinerow::physics::mesh_gate_test {
namespace {

using Eigen::Vector3d;

const Vector3d kPost_half_m(0.05, 0.05, 1.0);
using Centres = std::vector<Vector3d>;
/// Several spheres are a compound; one in the middle of the body is a single shape.
const Centres kFour_B{{0.5, 0.4, 0}, {0.5, -0.4, 0}, {-0.5, 0.4, 0.1}, {-0.5, -0.4, 0.1}};
const Centres kTwo_B(kFour_B.begin(), kFour_B.begin() + 2), kBeside_B{kFour_B.front()};
const Centres kMiddle_B{Vector3d::Zero()};
constexpr double kRadius_m = 0.15;

/// Four posts of one mesh, as a row has them: its bounding box covers what lies between them.
const Vector3d kPosts_W[] = {{-2, -2, 0}, {2, -2, 0}, {-2, 2, 0}, {2, 2, 0}};

WorldModel make_posts() {
  auto mesh = std::make_shared<TriangleMesh>();
  for (const Vector3d& p_W : kPosts_W) {
    const auto post = test::make_box_mesh(kPost_half_m.cast<float>());
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (const auto& vertex : post->vertices) mesh->vertices.push_back(vertex + p_W.cast<float>());
    for (auto corners : post->triangles) {
      for (auto& corner : corners) corner += first;
      mesh->triangles.push_back(corners);
    }
  }
  WorldModel model;
  model.meshes.push_back(test::make_instance("posts", mesh, Vector3d::Zero(), SurfaceClass::kPost));
  return model;
}

/// Gap between the nearest sphere and the nearest post; negative: they overlap.
double gap_m(const Pose& X_WB, const Centres& spheres_B) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Vector3d& sphere_B : spheres_B) {
    for (const Vector3d& post_W : kPosts_W) {
      const Vector3d from_post = (X_WB * sphere_B - post_W).cwiseAbs();
      gap = std::min(gap, (from_post - kPost_half_m).cwiseMax(0.0).norm() - kRadius_m);
    }
  }
  return gap;
}

/// Places a body of spheres at poses of `next` and compares who touches.
template <typename Next>
void compare_contacts(const Centres& spheres_B, const Next& next) {
  const WorldModel model = make_posts();
  PhysicsWorld world({}, model);
  BodySpec spec = test::make_sphere(kRadius_m, 5.0, {0, 0, 10});
  spec.shapes.clear();
  for (const Vector3d& sphere_B : spheres_B) {
    spec.shapes.push_back({SphereShape{kRadius_m}, Pose{{1, 0, 0, 0}, sphere_B}});
  }
  const BodyId body = world.add_body(spec);
  world.set_kinematic(body, true);
  int touching = 0, near = 0;
  bool touched = false;
  for (int k = 0; k < 20000; ++k) {
    const Pose X_WB = next();
    const double gap = gap_m(X_WB, spheres_B);
    // Bullet counts a sphere as touching within its margin, to rounding.
    if (std::abs(gap) < 1e-4) continue;
    world.set_state(body, {X_WB, Vector3d::Zero(), Vector3d::Zero()});
    world.step(world.settings().step);
    const bool touches = std::any_of(world.contacts().begin(), world.contacts().end(),
                                     [](const Contact& c) { return c.depth_m > 0.0; });
    // Bullet keeps contact points for a step when the body moves little.
    if (gap < 0.0 || !touched) {
      ASSERT_EQ(touches, gap < 0.0) << "gap " << gap << " m, case " << k;
    }
    touched = touches;
    touching += touches;
    near += !touches && gap < 0.05;
  }
  EXPECT_GT(touching, 100);
  EXPECT_GT(near, 50);
}

TEST(MeshGate, BodiesTouchExactlyWhenOneOfTheirShapesDoes) {
  RandomStream random(7, "test", "mesh_gate");
  for (const Centres& spheres_B : {kMiddle_B, kBeside_B, kTwo_B, kFour_B}) {
    compare_contacts(spheres_B, [&] {
      return Pose{quaternion_from_rpy(
                      {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)}),
                  {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-1.5, 1.5)}};
    });
  }
}

/// Most searches of the mesh are saved here, since the body moves less than its last distance.
TEST(MeshGate, BodiesThatMoveLittleTouchExactlyWhenOneOfTheirShapesDoes) {
  RandomStream random(8, "test", "mesh_gate");
  for (const Centres& spheres_B : {kMiddle_B, kTwo_B, kFour_B}) {
    double phase = 0.0;
    compare_contacts(spheres_B, [&] {
      // Curves between and through the posts, with turns in place, at 5 mm to 25 mm a step.
      phase += random.uniform(0.002, 0.01);
      return Pose{quaternion_from_rpy({0.5 * std::sin(2.3 * phase), 0.5 * std::cos(3.1 * phase),
                                       3.0 * std::sin(1.7 * phase)}),
                  {2.5 * std::cos(phase), 2.5 * std::sin(1.41 * phase), std::sin(0.37 * phase)}};
    });
  }
}

}  // namespace
}  // namespace vinerow::physics::mesh_gate_test
