#include "worlds/mapping/photogrammetry/uniform_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "worlds/mapping/photogrammetry/cloud_tiles.h"
#include "worlds/mapping/photogrammetry/point_colour.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kTrianglesAtOnce = 2048;
constexpr double kOutlierBelow_m = 2.0, kOutlierAbove_m = 8.0;

void check_uniform_options(const UniformCloudOptions& options) {
  const auto demand = [](bool fine, const char* what, double value, const char* must) {
    if (!fine) throw ConfigError(fmt::format("{} is {}, must be {}", what, value, must));
  };
  demand(options.noise_m >= 0.0 && options.noise_m <= 10.0, "the noise of points", options.noise_m,
         "0 to 10 m");
  demand(options.weeds.height_m >= 0.0 && options.weeds.height_m <= 10.0, "the height of weeds",
         options.weeds.height_m, "0 to 10 m");
  demand(options.outliers >= 0.0 && options.outliers <= 1.0, "the share of outliers",
         options.outliers, "0 to 1");
}

/// Random integer with this mean.
int draw_count(double mean, RandomStream& random) {
  return static_cast<int>(std::floor(mean + random.uniform()));
}

/// Puts points where their surface is, with their errors.
class Collector {
 public:
  Collector(const UniformCloudOptions& options, const SurveyArea& area,
            std::vector<SampledPoint>& points, CloudTally& tally, RandomStream& random)
      : options_(options), area_(area), points_(points), tally_(tally), random_(random) {}

  bool wants(const Vector3d& p_W) const { return area_.contains(p_W.head<2>()); }

  void add(const Vector3d& p_W, const std::array<std::uint8_t, 3>& rgb, PointClass truth) {
    SampledPoint point{p_W, rgb, truth};
    ++tally_.aims;
    if (options_.outliers > 0.0 && random_.uniform() < options_.outliers) {
      point.p_W.z() += random_.uniform(-kOutlierBelow_m, kOutlierAbove_m);
      point.truth = PointClass::kUnclassified;
      ++tally_.outliers;
    } else {
      const double n_x = random_.normal(), n_y = random_.normal(), n_z = random_.normal();
      const Vector3d error = options_.noise_m * Vector3d(n_x, n_y, n_z);
      point.p_W += error;
      tally_.horizontal_error2_m2 += error.head<2>().squaredNorm();
      tally_.height_error2_m2 += error.z() * error.z();
    }
    points_.push_back(point);
    ++tally_.points;
    tally_.ground_points += point.truth == PointClass::kGround ? 1 : 0;
    tally_.canopy_points += point.truth == PointClass::kCanopy ? 1 : 0;
  }

 private:
  const UniformCloudOptions& options_;
  const SurveyArea& area_;
  std::vector<SampledPoint>& points_;
  CloudTally& tally_;
  RandomStream& random_;
};

void sample_ground(const HeightField& terrain, const CloudTiles& tiles, std::int64_t tile,
                   const Weeds& weeds, const PointColour& colour, Collector& to,
                   RandomStream& random) {
  const Vector2d corner = tiles.corner_W(tile);
  for (int cell = 0; cell < tiles.side() * tiles.side(); ++cell) {
    const Vector2d low =
        corner + tiles.cell_m() * Vector2d(cell % tiles.side(), cell / tiles.side());
    const Vector2d middle = low + 0.5 * Vector2d(tiles.cell_m(), tiles.cell_m());
    // Area of surface over area of plan.
    const double steep = 1.0 / terrain.normal_W(middle.x(), middle.y()).z();
    for (int count = draw_count(steep, random); count > 0; --count) {
      const double u = random.uniform(), v = random.uniform();
      const Vector2d p = low + tiles.cell_m() * Vector2d(u, v);
      Vector3d p_W(p.x(), p.y(), 0.0);
      if (!terrain.contains(p.x(), p.y()) || !to.wants(p_W)) continue;
      p_W.z() = terrain.height_m(p.x(), p.y());
      const double weed_m = weeds.height_m(p);
      if (weed_m > 0.0) {
        p_W.z() += weed_m * random.uniform(0.5, 1.0);
        to.add(p_W, colour.of_weed(random.uniform()), PointClass::kLowVegetation);
      } else {
        const RayHit hit{0.0, terrain.normal_W(p.x(), p.y()), SurfaceClass::kTerrain, -1};
        to.add(p_W, colour.of(hit, p_W, random.uniform()), PointClass::kGround);
      }
    }
  }
}

/// Some triangles of a mesh.
struct Piece {
  int mesh;  ///< of the world
  std::size_t first, last;
};

std::vector<Piece> cut_meshes(const WorldModel& world) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    const MeshInstance& instance = world.meshes[i];
    if (!instance.collides || !instance.mesh || instance.surface == SurfaceClass::kWire ||
        instance.surface == SurfaceClass::kVehicle) {
      continue;
    }
    const std::size_t count = instance.mesh->triangles.size();
    for (std::size_t first = 0; first < count; first += kTrianglesAtOnce) {
      pieces.push_back({static_cast<int>(i), first, std::min(count, first + kTrianglesAtOnce)});
    }
  }
  return pieces;
}

void sample_piece(const MeshInstance& instance, const Piece& piece, double density_per_m2,
                  const PointColour& colour, Collector& to, RandomStream& random) {
  const TriangleMesh& mesh = *instance.mesh;
  for (std::size_t t = piece.first; t < piece.last; ++t) {
    Vector3d corners[3];
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = instance.X_WM * mesh.vertices[mesh.triangles[t][k]].cast<double>();
    }
    const Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Vector3d across = ab.cross(ac);
    const double twice_m2 = across.norm();
    if (!(twice_m2 > 0.0)) continue;
    const RayHit hit{0.0, across / twice_m2, instance.surface, piece.mesh};
    for (int count = draw_count(0.5 * twice_m2 * density_per_m2, random); count > 0; --count) {
      double v = random.uniform(), w = random.uniform();
      if (v + w > 1.0) v = 1.0 - v, w = 1.0 - w;
      const Vector3d p_W = corners[0] + v * ab + w * ac;
      const double grain = random.uniform();
      if (to.wants(p_W)) to.add(p_W, colour.of(hit, p_W, grain), class_of(instance.surface));
    }
  }
}

}  // namespace

CloudTally sample_uniformly(const WorldModel& world, const SurveyArea& area,
                            const UniformCloudOptions& options, const CloudSink& sink) {
  check_uniform_options(options);
  const CloudTiles tiles(area, 0.0, options.density_per_m2);
  const std::vector<Piece> pieces = cut_meshes(world);
  const Weeds weeds(options.weeds, world.rows->rows, area,
                    RandomStream(options.seed, "cloud", "weeds"));
  const PointColour colour(world);
  const std::int64_t ground_tiles = world.terrain ? tiles.count() : 0;
  const std::int64_t count = ground_tiles + static_cast<std::int64_t>(pieces.size());
  std::vector<CloudTally> tallies(static_cast<std::size_t>(count));
  CloudTally all;
  stream_points(
      count,
      [&](std::int64_t k, std::vector<SampledPoint>& points) {
        RandomStream random(options.seed, "cloud", fmt::format("uniform.{}", k));
        Collector to(options, area, points, tallies[static_cast<std::size_t>(k)], random);
        if (k < ground_tiles) {
          sample_ground(*world.terrain, tiles, k, weeds, colour, to, random);
        } else {
          const Piece& piece = pieces[static_cast<std::size_t>(k - ground_tiles)];
          sample_piece(world.meshes[static_cast<std::size_t>(piece.mesh)], piece,
                       options.density_per_m2, colour, to, random);
        }
      },
      [&](std::int64_t k) { all.add(tallies[static_cast<std::size_t>(k)]); }, sink);
  return all;
}

}  // namespace vinerow::mapping
