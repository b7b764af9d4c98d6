#include "controllers/planning/survey/survey_area.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>

#include "controllers/parts/paths/pose2.h"
#include "engine/core/error.h"
#include "engine/io/geo/geo_features.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

constexpr double kSameCorner_m = 1e-6;
constexpr double kLeastArea_m2 = 1.0;

/// Whether closed segments a-b and c-d share a point; straight ones on top of each other too.
bool share_a_point(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto side = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    const double area = cross(q - p, r - p), slack = 1e-12 * (q - p).norm() * (r - p).norm();
    return area > slack ? 1 : area < -slack ? -1 : 0;
  };
  const auto is_between = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return (r - p).dot(r - q) <= 0.0;
  };
  const int s1 = side(a, b, c), s2 = side(a, b, d), s3 = side(c, d, a), s4 = side(c, d, b);
  if (s1 * s2 < 0 && s3 * s4 < 0) return true;
  return (s1 == 0 && is_between(a, b, c)) || (s2 == 0 && is_between(a, b, d)) ||
         (s3 == 0 && is_between(c, d, a)) || (s4 == 0 && is_between(c, d, b));
}

std::string describe_edge(const Polygon2& polygon, std::size_t i) {
  const std::size_t j = (i + 1) % polygon.size();
  return fmt::format("from point {} ({:.1f}, {:.1f}) to point {} ({:.1f}, {:.1f})", i + 1,
                     polygon[i].x(), polygon[i].y(), j + 1, polygon[j].x(), polygon[j].y());
}

Polygon2 read_geojson_area(const std::string& file, const GeoOrigin& origin) {
  const LocalFrame frame(origin);
  Polygon2 polygon;
  int count = 0;
  for (const io::GeoFeature& feature : io::read_features(file)) {
    if (feature.kind != io::GeometryKind::kPolygon) continue;
    if (++count > 1) continue;
    for (Geodetic point : feature.points) {
      point.altitude_m = origin.altitude_m;
      polygon.push_back(frame.to_local(point).head<2>());
    }
  }
  if (count != 1) {
    throw ConfigError(
        fmt::format("'{}' has {} polygons, must have one: the area to survey", file, count));
  }
  return polygon;
}

Polygon2 read_csv_area(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw ConfigError(fmt::format("{}: cannot be read", file));
  Polygon2 polygon;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    std::string fields = line;
    for (char& c : fields) c = (c == ',' || c == ';') ? ' ' : c;
    std::istringstream parser(fields);
    parser.imbue(std::locale::classic());
    Vector2d p;
    std::string rest;
    if (parser >> p.x() >> p.y() && p.allFinite() && !(parser >> rest)) {
      polygon.push_back(p);
    } else if (number > 1) {  // the first line may hold names
      throw ConfigError(
          fmt::format("{}:{}: '{}' must be two numbers, x and y in metres", file, number, line));
    }
  }
  return polygon;
}

}  // namespace

Polygon2 clean_polygon(const Polygon2& polygon) {
  Polygon2 clean;
  for (const Vector2d& p : polygon) {
    if (clean.empty() || (p - clean.back()).norm() > kSameCorner_m) clean.push_back(p);
  }
  while (clean.size() > 1 && (clean.front() - clean.back()).norm() <= kSameCorner_m) {
    clean.pop_back();
  }
  return clean;
}

std::optional<std::string> find_polygon_fault(const Polygon2& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return fmt::format("it has {} different points, needs at least 3", n);
  constexpr std::size_t kMostPoints = 5'000;  // each edge is held against each other
  if (n > kMostPoints) {
    return fmt::format("it has {} points, must have at most {}: simplify it", n, kMostPoints);
  }
  constexpr double kFarApart_m = 50e3;
  for (std::size_t i = 1; i < n; ++i) {
    const double apart_m = (polygon[i] - polygon[0]).norm();
    if (apart_m <= kFarApart_m) continue;
    return fmt::format("its points 1 and {} lie {:.0f} km apart, must be at most {:.0f} km", i + 1,
                       apart_m / 1e3, kFarApart_m / 1e3);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vector2d &a = polygon[i], &b = polygon[(i + 1) % n];
      const Vector2d &c = polygon[j], &d = polygon[(j + 1) % n];
      // Neighbours share a corner; they are at fault only where they turn back onto each other.
      const bool follows = j == i + 1, leads = (j + 1) % n == i;
      bool crosses = false;
      if (follows || leads) {
        const Vector2d u = follows ? Vector2d(a - b) : Vector2d(b - a);
        const Vector2d v = follows ? Vector2d(d - c) : Vector2d(c - d);
        crosses = n > 3 && u.dot(v) > 0.0 && std::abs(cross(u, v)) <= 1e-9 * u.norm() * v.norm();
      } else {
        crosses = share_a_point(a, b, c, d);
      }
      if (crosses) {
        return fmt::format("its edge {} crosses its edge {}", describe_edge(polygon, i),
                           describe_edge(polygon, j));
      }
    }
  }
  const double area_m2 = std::abs(polygon_area_m2(polygon));
  if (area_m2 < kLeastArea_m2) {
    return fmt::format("its {} points enclose {:.3f} m2, must be at least {:g} m2", n, area_m2,
                       kLeastArea_m2);
  }
  return std::nullopt;
}

double polygon_area_m2(const Polygon2& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // About the first point, so that places far from the origin lose no digits.
    twice += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  }
  return 0.5 * twice;
}

bool is_inside_polygon(const Vector2d& p, const Polygon2& polygon) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
    inside ^= p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }
  return inside;
}

Polygon2 widen_polygon(const Polygon2& polygon, double margin_m) {
  if (margin_m == 0.0) return polygon;
  const double outward = polygon_area_m2(polygon) > 0.0 ? -1.0 : 1.0;  // of the left normal
  Polygon2 wide;
  const std::size_t n = polygon.size();
  std::vector<std::size_t> first;  // of each corner's points
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d in = (polygon[i] - polygon[(i + n - 1) % n]).normalized();
    const Vector2d out = (polygon[(i + 1) % n] - polygon[i]).normalized();
    const Vector2d n_in = outward * left_of(in), n_out = outward * left_of(out);
    // The corner of the moved edges lies at margin (n_in + n_out) / (1 + n_in n_out).
    const double spread = 1.0 + n_in.dot(n_out);
    first.push_back(wide.size());
    constexpr double kCutOff = 0.5;  // where the corner would lie farther than twice the margin
    if (spread >= kCutOff) {
      wide.push_back(polygon[i] + margin_m / spread * (n_in + n_out));
    } else {
      wide.push_back(polygon[i] + margin_m * (n_in + in));
      wide.push_back(polygon[i] + margin_m * (n_out - out));
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d edge = polygon[(i + 1) % n] - polygon[i];
    const std::size_t end = first[(i + 1) % n], begin = (end + wide.size() - 1) % wide.size();
    if (edge.dot(wide[end] - wide[begin]) <= 0.0) return {};
  }
  return clean_polygon(wide);
}

Polygon2 read_survey_area(const std::string& file, const GeoOrigin& origin) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return clean_polygon(ending == ".csv" ? read_csv_area(file) : read_geojson_area(file, origin));
}

}  // namespace vinerow::controllers
