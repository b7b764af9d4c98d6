/// Numbers of things by triangle, whatever was met before.

#include "engine/sensors/camera/thing_numbers.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace vinerow::sensors::thing_numbers_test {
namespace {

/// Two meshes, with things of 2, 1 and 3 triangles, and one without things.
std::vector<MeshInstance> meshes() {
  std::vector<MeshInstance> result(3);
  for (MeshInstance& instance : result) {
    TriangleMesh mesh;
    mesh.triangles.assign(6, {0, 1, 2});
    if (&instance != &result.back()) mesh.things = {0, 2, 3};
    instance.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  }
  return result;
}

TEST(ThingNumbers, DoNotDependOnWhatTheRayBeforeMet) {
  const std::vector<MeshInstance> world = meshes();
  const ThingNumbers numbers(world);
  const std::uint32_t of_mesh[] = {2, 2, 3, 4, 4, 4};
  const auto expected = [&](int mesh, int triangle) {
    return mesh == 2 ? 8u : of_mesh[triangle] + 3u * static_cast<std::uint32_t>(mesh);
  };
  const auto hit_of = [](int index) {
    RayHit hit;
    hit.mesh = index / 6;
    hit.triangle = index % 6;
    return hit;
  };
  for (int before = 0; before < 18; ++before) {
    for (int now = 0; now < 18; ++now) {
      ThingNumbers::Found last;
      numbers.of(hit_of(before), last);
      const std::uint32_t number = numbers.of(hit_of(now), last);
      EXPECT_EQ(number, expected(now / 6, now % 6)) << now << " after " << before;
      const ThingNumbers::Thing thing = numbers.thing(number);
      EXPECT_EQ(thing.mesh, now / 6);
      EXPECT_LE(thing.first_triangle, static_cast<std::uint32_t>(now % 6));
      EXPECT_GT(thing.end_triangle, static_cast<std::uint32_t>(now % 6));
    }
  }
  ThingNumbers::Found last;
  numbers.of(hit_of(0), last);
  EXPECT_EQ(numbers.of(RayHit{}, last), ThingNumbers::kTerrain);
  EXPECT_EQ(numbers.end(), 9u);
}

}  // namespace
}  // namespace vinerow::sensors::thing_numbers_test
