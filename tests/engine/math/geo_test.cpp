#include "engine/math/geo.h"

#include <gtest/gtest.h>

#include <complex>
#include <fstream>
#include <sstream>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"

namespace vinerow::io::geo_test {
namespace {

GeoOrigin origin_deg(double latitude_deg, double longitude_deg, double altitude_m = 0.0) {
  return {rad_from_deg(latitude_deg), rad_from_deg(longitude_deg), altitude_m};
}

TEST(LocalFrame, OriginIsZero) {
  const LocalFrame frame(origin_deg(53.26810042662116, -0.5244249078498293, 42.0));
  EXPECT_LT(
      frame.to_local({frame.origin().latitude_rad, frame.origin().longitude_rad, 42.0}).norm(),
      1e-8);
}

TEST(LocalFrame, ASecondOfArcHasTheLengthOfTheEllipsoidsRadii) {
  // WGS84: M = a(1-e2)/(1-e2 sin2)^1.5 along the meridian, N cos(lat) along the parallel.
  const double latitude = rad_from_deg(45.0), a = 6378137.0, e2 = 6.69437999014e-3;
  const double w2 = 1.0 - e2 * std::sin(latitude) * std::sin(latitude);
  const double M = a * (1.0 - e2) / std::pow(w2, 1.5), N = a / std::sqrt(w2);
  const double second = rad_from_deg(1.0 / 3600.0);
  const LocalFrame frame(origin_deg(45.0, 8.0));
  const double lon = frame.origin().longitude_rad;
  // Chord and arc of 31 m differ by 1e-11; the parallel's curve shifts the other axis by 0.04 mm.
  EXPECT_NEAR(frame.to_local({latitude + second, lon, 0.0}).y(), M * second, 1e-4);
  EXPECT_NEAR(frame.to_local({latitude, lon + second, 0.0}).x(), N * std::cos(latitude) * second,
              1e-6);
}

TEST(LocalFrame, ThereAndBackIsTheSamePlace) {
  const LocalFrame frame(origin_deg(-33.9, 151.2, 80.0));
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(300, -200, 15),
                                   Eigen::Vector3d(-5000, 4000, 900)}) {
    EXPECT_LT((frame.to_local(frame.to_geodetic(p)) - p).norm(), 1e-7);
  }
}

TEST(LocalFrame, GroundFallsAwayFromTheTangentPlane) {
  const LocalFrame frame(origin_deg(45.0, 8.0));
  const double lat = rad_from_deg(45.0) + 1000.0 / 6367000.0;
  // d^2 / 2R = 0.0785 m at 1 km
  EXPECT_NEAR(frame.to_local({lat, frame.origin().longitude_rad, 0.0}).z(), -0.0785, 0.0005);
}

TEST(LocalFrame, RefusesALatitudeBeyondThePole) {
  try {
    LocalFrame frame(origin_deg(95.0, 8.0));
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("latitude must be within +-90 deg"), std::string::npos);
  }
}

/// Rows of a CSV file without its first, split at commas.
std::vector<std::vector<std::string>> read_csv(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (row.size() >= 3) rows.push_back(row);
  }
  return rows;
}

struct Fit {
  double rms_m, scale, rotation_deg;
};

using Points = std::vector<std::complex<double>>;

/// Least squares of w = a z + b with complex a (rotation and scale) and b.
Fit fit_similarity(const Points& from, const Points& to) {
  const auto count = static_cast<double>(from.size());
  std::complex<double> from_mean, to_mean, product;
  for (std::size_t i = 0; i < from.size(); ++i)
    from_mean += from[i] / count, to_mean += to[i] / count;
  double square = 0.0, residual = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    product += std::conj(from[i] - from_mean) * (to[i] - to_mean);
    square += std::norm(from[i] - from_mean);
  }
  const std::complex<double> a = product / square;
  for (std::size_t i = 0; i < from.size(); ++i) {
    residual += std::norm(a * (from[i] - from_mean) - (to[i] - to_mean));
  }
  return {std::sqrt(residual / count), std::abs(a), deg_from_rad(std::arg(a))};
}

TEST(LocalFrame, RiseholmeVinesMatchTheirGridCoordinates) {
  VINEROW_OUTSIDE_DATA(folder, "vineyard_detection/data");
  const auto geodetic = read_csv(folder / "riseholme_vineyard_lat_long_vines.csv");
  const auto grid = read_csv(folder / "riseholme_vineyard_easting_northing_vines.csv");
  ASSERT_EQ(geodetic.size(), 120u);
  ASSERT_EQ(grid.size(), 120u);
  const LocalFrame frame(origin_deg(53.26810042662116, -0.5244249078498293));
  Points local, spherical, expected;
  constexpr double kSphereRadius_m = 6371000.0;
  for (int i = 0; i < 120; ++i) {
    const auto& g = geodetic[static_cast<std::size_t>(i)];
    const auto& e = grid[static_cast<std::size_t>(i)];
    const double lat = rad_from_deg(std::stod(g[1])), lon = rad_from_deg(std::stod(g[2]));
    const Eigen::Vector3d p_W = frame.to_local({lat, lon, 0.0});
    local.emplace_back(p_W.x(), p_W.y());
    spherical.emplace_back(kSphereRadius_m * std::cos(frame.origin().latitude_rad) *
                               (lon - frame.origin().longitude_rad),
                           kSphereRadius_m * (lat - frame.origin().latitude_rad));
    expected.emplace_back(std::stod(e[1]), std::stod(e[2]));
  }
  const Fit fit = fit_similarity(local, expected);
  RecordProperty("residual_rms_mm", std::to_string(1000.0 * fit.rms_m));
  // Reference: 0.39 mm rms (coordinates rounded to 1 mm and 1e-8 deg), scale of OSGB, grid
  // convergence.
  EXPECT_LT(fit.rms_m, 1e-3);
  EXPECT_NEAR(fit.rms_m, 0.39e-3, 0.05e-3);
  EXPECT_NEAR(fit.scale, 0.9997465, 2e-6);
  EXPECT_NEAR(std::abs(fit.rotation_deg), 1.181, 0.002);
  // A spherical Earth of any radius leaves 9.6 mm: the test would see it.
  EXPECT_GT(fit_similarity(spherical, expected).rms_m, 5e-3);
}

}  // namespace
}  // namespace vinerow::io::geo_test
