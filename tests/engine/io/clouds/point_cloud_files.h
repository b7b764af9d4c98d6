#pragma once
/// What the tests of point clouds share: files made of bytes, and all points of one.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/io/clouds/point_cloud.h"
#include "tests/support/folder_test.h"

namespace vinerow::io {

/// The bytes of a number, in the byte order of the file.
template <class T>
std::string bytes_of(T value, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::string(bytes.data(), bytes.size());
}

/// Bytes put after one another as a specification lists them.
class Bytes {
 public:
  template <class T>
  Bytes& put(T value) {
    text += bytes_of(value);
    return *this;
  }
  Bytes& put_text(const std::string& value, std::size_t padded_to = 0) {
    text += value;
    if (value.size() < padded_to) text.append(padded_to - value.size(), '\0');
    return *this;
  }
  std::string text;
};

class PointCloudFiles : public vinerow::test::FolderTest {
 protected:
  PointCloudFiles() : FolderTest("point_cloud") {}

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    // A new file each time: disks are slow to cut one off that they still write.
    std::filesystem::remove(folder_ / name);
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  /// All points, read in blocks of three, so that blocks end inside of files.
  static std::vector<CloudPoint> points_of(PointCloudReader& reader) {
    std::vector<CloudPoint> points;
    std::array<CloudPoint, 3> block;
    std::size_t count = 0;
    do {
      count = reader.read(block);
      points.insert(points.end(), block.begin(), block.begin() + count);
    } while (count == block.size());
    EXPECT_EQ(reader.read(block), 0u);  // and stays at its end
    return points;
  }
  std::vector<CloudPoint> read(const std::string& name, const std::string& content) const {
    return points_of(*open_point_cloud(write(name, content)));
  }

  /// What opening and reading says, without the folder, which differs from machine to machine.
  template <class F>
  std::string error_in(F&& f) const {
    try {
      f();
    } catch (const ConfigError& e) {
      return without_folder(e.what());
    }
    return "no error";
  }
  std::string error_of(const std::string& name, const std::string& content) const {
    return error_in([&] { read(name, content); });
  }
};

/// Position, colour (-1: none) and classification (-1: none) in one line.
inline std::string shown(const CloudPoint& point) {
  std::string text;
  for (int k = 0; k < 3; ++k) text += ::testing::PrintToString(point.position[k]) + " ";
  for (std::size_t k = 0; k < 3; ++k) {
    text += std::to_string(point.rgb ? int{(*point.rgb)[k]} : -1) + " ";
  }
  return text + std::to_string(point.classification ? int{*point.classification} : -1);
}

}  // namespace vinerow::io
