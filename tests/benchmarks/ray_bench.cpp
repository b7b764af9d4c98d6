/// Rays and distances in a vineyard of paper A's size.

#include <benchmark/benchmark.h>

#include "engine/api/map.h"
#include "engine/core/random.h"
#include "engine/physics/physics_world.h"
#include "tests/benchmarks/bench_worlds.h"

namespace vinerow::ray_bench {
namespace {

struct Vineyard {
  std::unique_ptr<WorldModel> model = bench::make_world("vineyard");
  physics::PhysicsWorld world{{}, *model};

  std::int64_t triangles() const {
    std::int64_t count = 0;
    for (const MeshInstance& instance : model->meshes) {
      if (instance.collides) count += static_cast<std::int64_t>(instance.mesh->triangles.size());
    }
    return count;
  }
};

const Vineyard& vineyard() {
  static const Vineyard instance;
  return instance;
}

/// 4 m rays from the middle of an alley, in all horizontal directions.
void ray_fan_4m(benchmark::State& state) {
  const Vineyard& v = vineyard();
  const auto& line = v.model->rows->alleys[7].line_W;
  RandomStream random(1, "", "rays");
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rays;
  for (int i = 0; i < 4096; ++i) {
    const double share = random.uniform(0.1, 0.9), angle = random.uniform(0.0, 6.28);
    Eigen::Vector3d p = line.front() + share * (line.back() - line.front());
    p.z() = v.model->terrain->height_m(p.x(), p.y()) + 1.0;
    rays.emplace_back(p, Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }
  std::size_t i = 0, hits = 0;
  for (auto _ : state) {
    const auto& [p, dir] = rays[i++ % rays.size()];
    hits += v.world.scene().cast_ray(p, dir, 4.0).has_value();
  }
  state.counters["hit_share"] = static_cast<double>(hits) / static_cast<double>(state.iterations());
  state.counters["triangles"] = static_cast<double>(v.triangles());
}
BENCHMARK(ray_fan_4m)->Unit(benchmark::kNanosecond);

/// Rays of a scanner with 16 lasers that turns in an alley, 20 m, laser by laser, one by one or
/// together.
/// @param range(0)  rays of each cast
void scanner_rays(benchmark::State& state) {
  const Vineyard& v = vineyard();
  const auto& line = v.model->rows->alleys[7].line_W;
  Eigen::Vector3d p = line.front() + 0.4 * (line.back() - line.front());
  p.z() = v.model->terrain->height_m(p.x(), p.y()) + 1.2;
  std::vector<SceneRay> rays;
  for (int laser = 0; laser < 16; ++laser) {
    const double elevation = (-15.0 + 2.0 * laser) * 3.14159265358979 / 180.0;
    for (int column = 0; column < 900; ++column) {
      const double azimuth = 2.0 * 3.14159265358979 * column / 900.0;
      rays.push_back({p,
                      {std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)},
                      20.0});
    }
  }
  const auto count = static_cast<std::size_t>(state.range(0));
  std::vector<std::optional<RayHit>> hits(rays.size());
  for (auto _ : state) {
    for (std::size_t at = 0; at < rays.size(); at += count) {
      if (count == 1) {
        hits[at] = v.world.scene().cast_ray(rays[at].p_W, rays[at].dir_W, rays[at].max_distance_m);
      } else {
        v.world.scene().cast_rays(std::span(rays).subspan(at, count),
                                  std::span(hits).subspan(at, count));
      }
    }
    benchmark::DoNotOptimize(hits.data());
  }
  state.counters["rays_per_s"] =
      benchmark::Counter(static_cast<double>(rays.size()) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}
BENCHMARK(scanner_rays)->Arg(1)->Arg(16)->Arg(14400)->Unit(benchmark::kMillisecond);

void distance_of_rover_box(benchmark::State& state) {
  const Vineyard& v = vineyard();
  const auto& line = v.model->rows->alleys[7].line_W;
  std::size_t i = 0;
  for (auto _ : state) {
    Pose box;
    box.p = line.front() +
            (0.1 + 0.8 * static_cast<double>(i++ % 997) / 997.0) * (line.back() - line.front());
    box.p.z() = v.model->terrain->height_m(box.p.x(), box.p.y()) + 0.6;
    benchmark::DoNotOptimize(v.world.scene().distance_to_box_m(box, {0.8, 0.55, 0.4}, 3.0));
  }
}
BENCHMARK(distance_of_rover_box)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vinerow::ray_bench
