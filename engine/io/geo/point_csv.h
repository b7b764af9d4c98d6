#pragma once
/// Points in the plane of the world from a CSV file.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace vinerow::io {

/// Reads lines "x,y" in metres. Skips a byte order mark, a first line of names, empty lines and
/// lines that start with '#'. A semicolon may stand for the comma.
/// @throws ConfigError with file, and line and text of the first one that is neither
std::vector<Eigen::Vector2d> read_points_csv(const std::string& file);

}  // namespace vinerow::io
