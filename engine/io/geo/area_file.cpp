#include "engine/io/geo/area_file.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "engine/core/error.h"
#include "engine/io/geo/geo_features.h"
#include "engine/io/geo/point_csv.h"
#include "engine/math/geo.h"

namespace vinerow::io {
namespace {

using Eigen::Vector2d;

Polygon read_geojson_area(const std::string& file, const GeoOrigin& origin) {
  const LocalFrame frame(origin);
  Polygon polygon;
  int count = 0;
  for (const GeoFeature& feature : read_features(file)) {
    if (feature.kind != GeometryKind::kPolygon) continue;
    if (++count > 1) continue;
    for (Geodetic point : feature.points) {
      point.altitude_m = origin.altitude_m;
      polygon.push_back(frame.to_local(point).head<2>());
    }
  }
  if (count != 1) {
    throw ConfigError(fmt::format("'{}' has {} polygons, must have one: the area", file, count));
  }
  return polygon;
}

constexpr double kMinArea_m2 = 1.0;

std::string describe_edge(const Polygon& polygon, std::size_t i) {
  const std::size_t j = (i + 1) % polygon.size();
  return fmt::format("from point {} ({:.1f}, {:.1f}) to point {} ({:.1f}, {:.1f})", i + 1,
                     polygon[i].x(), polygon[i].y(), j + 1, polygon[j].x(), polygon[j].y());
}

}  // namespace

Polygon read_area(const std::string& file, const GeoOrigin& origin) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return without_repeats(ending == ".csv" ? read_points_csv(file)
                                          : read_geojson_area(file, origin));
}

std::optional<std::string> find_area_fault(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) {
    return fmt::format("it has {} different point{}, needs at least 3", n, n == 1 ? "" : "s");
  }
  constexpr std::size_t kMaxPoints = 5'000;  // each edge is compared with each other
  if (n > kMaxPoints) {
    return fmt::format("it has {} points, must have at most {}: simplify it", n, kMaxPoints);
  }
  constexpr double kFarApart_m = 50e3;
  for (std::size_t i = 1; i < n; ++i) {
    const double apart_m = (polygon[i] - polygon[0]).norm();
    if (apart_m <= kFarApart_m) continue;
    return fmt::format("its points 1 and {} are {:.0f} km apart, must be at most {:.0f} km", i + 1,
                       apart_m / 1e3, kFarApart_m / 1e3);
  }
  // A triangle cannot cross itself; one without area is rejected below.
  if (const auto crossing = n > 3 ? find_crossing(polygon) : std::nullopt) {
    return fmt::format("its edge {} crosses its edge {}",
                       describe_edge(polygon, static_cast<std::size_t>(crossing->first)),
                       describe_edge(polygon, static_cast<std::size_t>(crossing->second)));
  }
  const double area_m2 = std::abs(signed_area_m2(polygon));
  if (area_m2 < kMinArea_m2) {
    return fmt::format("its {} points enclose {:.3f} m2, must be at least {:g} m2", n, area_m2,
                       kMinArea_m2);
  }
  return std::nullopt;
}

}  // namespace vinerow::io
