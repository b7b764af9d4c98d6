#include "worlds/mapping/reading/cloud_sample.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "worlds/mapping/reading/repeated_places.h"

namespace vinerow::mapping::cloud_sample_test {
namespace {

TEST(CloudSample, KeepsAllOfFew) {
  CloudSample sample;
  for (std::size_t k = 0; k < CloudSample::kMax; ++k) sample.add({1.0 * k, 0, 0});
  ASSERT_EQ(sample.points().size(), CloudSample::kMax);
  EXPECT_EQ(sample.window(), 1u);
  for (std::size_t k = 0; k < CloudSample::kMax; ++k) EXPECT_EQ(sample.points()[k].x(), 1.0 * k);
}

/// One of each window, in order, and every place inside a window alike: a raster whose width
/// divides the window shows all of its columns.
TEST(CloudSample, KeepsOneOfEachWindowOfMany) {
  constexpr std::size_t kCount = 3'000'000, kColumns = 8;
  CloudSample sample;
  for (std::size_t k = 0; k < kCount; ++k) sample.add({1.0 * k, 0, 0});
  const std::uint64_t window = sample.window();
  EXPECT_EQ(window, 64u);  // the least power of two that leaves at most kMax of 3 million
  ASSERT_NEAR(static_cast<double>(sample.points().size()), kCount / 64.0, 1.0);
  std::array<double, kColumns> columns{};
  for (std::size_t k = 0; k < sample.points().size(); ++k) {
    const auto index = static_cast<std::uint64_t>(sample.points()[k].x());
    EXPECT_EQ(index / window, k);
    columns[index % kColumns] += 1.0;
  }
  const double mean = kCount / 64.0 / kColumns;
  for (const double held : columns) EXPECT_NEAR(held, mean, 5.0 * std::sqrt(mean));
}

TEST(CloudSample, BulkLeavesOutTheShareOfEachSide) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= 1000; ++k) points.emplace_back(k, -k, 7);
  const Eigen::AlignedBox3d bulk = bulk_of(points, 0.01);
  EXPECT_EQ(bulk.min(), Eigen::Vector3d(10, -990, 7));
  EXPECT_EQ(bulk.max(), Eigen::Vector3d(990, -10, 7));
  const Eigen::AlignedBox3d all = bulk_of(points, 0.0);
  EXPECT_EQ(all.min(), Eigen::Vector3d(0, -1000, 7));
  EXPECT_EQ(all.max(), Eigen::Vector3d(1000, 0, 7));
}

TEST(CloudSample, FootprintLiesAlongTheParcel) {
  // 200 m by 5 m, turned by 30 degrees.
  std::vector<Eigen::Vector3d> points;
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  for (int i = 0; i <= 400; ++i) {
    for (int j = 0; j <= 40; ++j) {
      const double x = 0.5 * i, y = 0.125 * j;
      points.emplace_back(c * x - s * y, s * x + c * y, 0);
    }
  }
  const Footprint print = footprint_of(points);
  EXPECT_NEAR(print.length_m, 198.0, 1.01);  // without 0.5 % of each side, to a step
  EXPECT_NEAR(print.width_m, 5.0, 0.126);
}

TEST(CloudSample, DensestSquareCentimetre) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 100; ++k) points.emplace_back(0.013 * k, 0, 0);
  for (int k = 0; k < 7; ++k) points.emplace_back(-0.0349 + 1e-3 * k, -2.005, k);
  EXPECT_EQ(densest_square_centimetre(points), 5u);  // -0.0349 to -0.0309, then -0.0299, -0.0289
}

TEST(RepeatedPlaces, CountsExactlyWhatFits) {
  RepeatedPlaces places;
  for (int k = 0; k < 1000; ++k) places.add({0.1 * k, 2, 3});
  EXPECT_EQ(places.count(), 0u);
  for (int k = 0; k < 10; ++k) places.add({0.1 * 5, 2, 3});
  places.add({0.1 * 6, 2, 3});
  places.add({0.1 * 6, 2, std::nextafter(3, 4)});
  EXPECT_EQ(places.count(), 11u);
  places.add({0.0, 2, 3});
  places.add({-0.0, 2, 3});  // the same place
  EXPECT_EQ(places.count(), 13u);
  EXPECT_TRUE(places.is_exact());
}

TEST(RepeatedPlaces, EstimatesWhatDoesNot) {
  // 3 million places, every twentieth of them twice.
  constexpr int kPlaces = 3'000'000, kRepeated = kPlaces / 20;
  RepeatedPlaces places;
  for (int k = 0; k < kPlaces; ++k) places.add({1e-3 * k, 1e-3 * (k % 977), 0});
  for (int k = 0; k < kPlaces; k += 20) places.add({1e-3 * k, 1e-3 * (k % 977), 0});
  EXPECT_FALSE(places.is_exact());
  // At least half of kMax places are remembered: their repeated ones vary by their square root.
  const double remembered = 0.5 * RepeatedPlaces::kMax / 20.0;
  EXPECT_NEAR(static_cast<double>(places.count()), kRepeated,
              4.0 * kRepeated / std::sqrt(remembered));
}

TEST(RepeatedPlaces, TenMillionPointsInOneSpotTakeNoMemory) {
  RepeatedPlaces places;
  for (int k = 0; k < 10'000'000; ++k) places.add({1, 2, 3});
  EXPECT_EQ(places.count(), 9'999'999u);
}

}  // namespace
}  // namespace vinerow::mapping::cloud_sample_test
