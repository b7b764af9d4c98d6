#include "engine/io/clouds/parcel_frame.h"

#include <ostream>

#include "engine/core/random.h"
#include "engine/math/geo.h"
#include "tests/engine/io/clouds/point_cloud_files.h"
#include "tests/engine/io/geo/utm32.h"

namespace vinerow::io::parcel_frame_test {
namespace {

struct Parcel {
  const char* crs;
  double latitude_deg, longitude_deg;
  Eigen::Vector3d middle;
  double half;  // of the box, in the CRS's unit
  bool is_fitted;
};

void PrintTo(const Parcel& parcel, std::ostream* out) {
  *out << parcel.crs << " about " << parcel.middle.transpose() << ", half " << parcel.half;
}

class ParcelFrameOf : public ::testing::TestWithParam<Parcel> {};

/// Against the exact frame: the error of a point must be below a tenth of a millimetre.
TEST_P(ParcelFrameOf, IsTheExactFrame) {
  const Parcel& parcel = GetParam();
  const CloudFrame exact(
      parcel.crs, {rad_from_deg(parcel.latitude_deg), rad_from_deg(parcel.longitude_deg), 100.0});
  const Eigen::Vector3d half(parcel.half, parcel.half, 150.0);
  const ParcelFrame frame(
      exact, {Eigen::Vector3d(parcel.middle - half), Eigen::Vector3d(parcel.middle + half)});
  EXPECT_EQ(frame.is_fitted(), parcel.is_fitted);
  RandomStream random(1, "", "parcel");
  std::vector<CloudPoint> points(2000);
  for (CloudPoint& point : points) {
    for (int k = 0; k < 3; ++k) {
      point.position[k] = parcel.middle[k] + random.uniform(-1.0, 1.0) * half[k];
    }
  }
  std::vector<CloudPoint> expected = points;
  frame.to_local(points);
  for (CloudPoint& point : expected) point.position = exact.to_local(point.position);
  double largest_m = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    largest_m = std::max(largest_m, (points[k].position - expected[k].position).norm());
  }
  EXPECT_LT(largest_m, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(
    Systems, ParcelFrameOf,
    ::testing::Values(Parcel{"EPSG:25832", 44.99, 9.5, {540000, 4982000, 120}, 100, true},
                      Parcel{"EPSG:25832", 44.99, 9.5, {540000, 4982000, 120}, 7500, true},
                      Parcel{"EPSG:4326", 45.0, 9.5, {9.5, 45, 120}, 0.05, true},
                      Parcel{"EPSG:2263", 40.75, -74.0, {984000, 212000, 100}, 5000, true},  // feet
                      Parcel{"EPSG:27700", 53.3, -0.5, {500000, 380000, 20}, 500, true},
                      Parcel{"EPSG:3003", 44.99, 9.5, {1540000, 4982000, 120}, 500, true},
                      Parcel{"EPSG:3857", 45.0, 9.5, {1057500, 5621500, 100}, 500, true},
                      // As large as a country: no polynomial of degree 3.
                      Parcel{"EPSG:25832", 44.99, 9.5, {540000, 4982000, 120}, 200000, false}));

TEST(ParcelFrame, ComesFromTheSeriesOfTheProjection) {
  const GeoOrigin origin{rad_from_deg(45.0), rad_from_deg(9.5), 100.0};
  const CloudFrame exact("EPSG:25832", origin);
  const LocalFrame local(origin);
  std::vector<CloudPoint> points;
  std::vector<Eigen::Vector3d> expected;
  Eigen::AlignedBox3d box;
  for (const double step : {-1e-3, -4e-4, 0.0, 3e-4, 1e-3}) {
    const Geodetic place{origin.latitude_rad + rad_from_deg(step),
                         origin.longitude_rad - rad_from_deg(1.4 * step), 100.0 + 3e4 * step};
    const Eigen::Vector2d en = utm32(place.latitude_rad, place.longitude_rad);
    points.emplace_back().position = {en.x(), en.y(), place.altitude_m};
    expected.push_back(local.to_local(place));
    box.extend(points.back().position);
  }
  ParcelFrame(exact, box).to_local(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_LT((points[k].position - expected[k]).norm(), 1e-3);  // of the series
  }
}

/// A single point, and points that lie along one axis.
TEST(ParcelFrame, BoxesWithoutWidth) {
  const CloudFrame exact("EPSG:25832", {rad_from_deg(44.99), rad_from_deg(9.5), 100.0});
  const Eigen::Vector3d a(540000, 4982000, 120), b(540080, 4982000, 120);
  for (const Eigen::AlignedBox3d& box : {Eigen::AlignedBox3d(a), Eigen::AlignedBox3d(a, b)}) {
    const ParcelFrame frame(exact, box);
    EXPECT_TRUE(frame.is_fitted());
    std::vector<CloudPoint> points(1);
    points[0].position = box.max();
    frame.to_local(points);
    EXPECT_LT((points[0].position - exact.to_local(box.max())).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace vinerow::io::parcel_frame_test
