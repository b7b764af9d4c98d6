/// Facts in a photograph: orientation in closed form, and fields where a reader looks for them.
/// (photos_command reads whole files by Pillow.)

#include "tools/photos/photo_facts.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "engine/math/angles.h"

namespace vinerow::tools::photo_facts_test {
namespace {

using Eigen::Vector3d;

/// A camera that looks down along -z with its upper edge to a bearing, then tilted.
Eigen::Quaterniond looking_down(double bearing_deg, double forward_deg, double left_up_deg) {
  // x of S down, z of S to the upper edge, y to the left.
  const double bearing = rad_from_deg(bearing_deg);
  const Vector3d up(std::sin(bearing), std::cos(bearing), 0.0), down = -Vector3d::UnitZ();
  Eigen::Matrix3d R;
  R.col(0) = down;
  R.col(2) = up;
  R.col(1) = up.cross(down);
  // Turning the upper edge up tilts the axis forward: about the right edge's axis, -y of S.
  return Eigen::Quaterniond(R) * Eigen::AngleAxisd(rad_from_deg(forward_deg), -Vector3d::UnitY()) *
         Eigen::AngleAxisd(rad_from_deg(left_up_deg), Vector3d::UnitZ());
}

Vector3d degrees(const Eigen::Quaterniond& q_WS) {
  return photo_angles(q_WS) * (180.0 / kPi);
}

TEST(PhotoFacts, AnglesAreThoseOfTheUpperEdge) {
  EXPECT_LT(degrees(looking_down(0, 0, 0)).norm(), 1e-9);
  EXPECT_LT((degrees(looking_down(90, 0, 0)) - Vector3d(90, 0, 0)).norm(), 1e-9);
  EXPECT_LT((degrees(looking_down(-120, 0, 0)) - Vector3d(-120, 0, 0)).norm(), 1e-9);
  EXPECT_LT((degrees(looking_down(30, 10, 0)) - Vector3d(30, 10, 0)).norm(), 1e-9);
  // The axis then points ahead of straight down.
  const Vector3d axis = looking_down(0, 10, 0) * Vector3d::UnitX();
  EXPECT_NEAR(axis.y(), std::sin(rad_from_deg(10)), 1e-12);
  EXPECT_LT((degrees(looking_down(30, 0, 20)) - Vector3d(30, 0, 20)).norm(), 1e-9);
}

/// Rationals of a field of a TIFF directory, read as its specification says.
std::vector<double> fractions(const std::string& exif, std::uint16_t directory_tag,
                              std::uint16_t tag) {
  const auto number = [&](std::size_t at, int bytes) {
    std::uint32_t value = 0;
    for (int i = bytes; i-- > 0;) {
      value = value << 8 | static_cast<std::uint8_t>(exif.at(6 + at + static_cast<std::size_t>(i)));
    }
    return value;
  };
  const auto find = [&](std::size_t directory, std::uint16_t wanted) -> std::size_t {
    for (std::uint32_t i = 0; i < number(directory, 2); ++i) {
      const std::size_t field = directory + 2 + 12 * i;
      if (number(field, 2) == wanted) return field;
    }
    ADD_FAILURE() << "no tag " << wanted;
    return 0;
  };
  const std::size_t field = find(number(find(8, directory_tag) + 8, 4), tag);
  std::vector<double> values;
  for (std::uint32_t i = 0; i < number(field + 4, 4); ++i) {
    const std::size_t at = number(field + 8, 4) + 8 * i;
    values.push_back(static_cast<double>(number(at, 4)) / number(at + 4, 4));
  }
  return values;
}

TEST(PhotoFacts, NoSecondIsRoundedUpToSixty) {
  PhotoFacts facts;
  facts.model = "test";
  facts.focal_length_mm = 8.8;
  facts.sensor_width_mm = 13.2;
  facts.columns = 1320;
  facts.rows = 880;
  facts.q_WS = looking_down(0, 0, 0);
  facts.place.latitude_rad = rad_from_deg(44.0 + 59.0 / 60.0 + 59.999999 / 3600.0);
  facts.place.longitude_rad = rad_from_deg(-7.5);
  facts.place.altitude_m = -12.25;
  const std::string exif = exif_segment(facts);
  ASSERT_EQ(exif.substr(0, 8), std::string("Exif\0\0II", 8));
  EXPECT_EQ(fractions(exif, 0x8825, 2), (std::vector<double>{45.0, 0.0, 0.0}));
  EXPECT_EQ(fractions(exif, 0x8825, 4), (std::vector<double>{7.0, 30.0, 0.0}));
  EXPECT_EQ(fractions(exif, 0x8825, 6), std::vector<double>{12.25});
  // 100 pixels to the millimetre.
  EXPECT_EQ(fractions(exif, 0x8769, 0xa20e), std::vector<double>{1000.0});
  EXPECT_EQ(fractions(exif, 0x8769, 0x920a), std::vector<double>{8.8});
}

}  // namespace
}  // namespace vinerow::tools::photo_facts_test
