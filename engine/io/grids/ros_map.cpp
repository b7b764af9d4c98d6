#include "engine/io/grids/ros_map.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/yaml.h"
#include "engine/io/grids/pgm.h"

namespace vinerow::io {
namespace {

constexpr std::uint16_t kFreePixel = 254, kOccupiedPixel = 0;

double number_of(const YamlNode& node, const std::string& key) {
  if (node.is_scalar()) {
    const YamlScalar value = scalar_value(node);
    if (const auto* number = std::get_if<double>(&value); number && std::isfinite(*number)) {
      return *number;
    }
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  }
  fail_at(node.mark, fmt::format("{} = {}, must be a finite number", key, shown(node)));
}

const YamlNode& require_key(const YamlNode& map, const std::string& key,
                            const std::filesystem::path& file) {
  const YamlNode* node = map.find(key);
  if (!node) throw ConfigError(fmt::format("ROS map '{}' has no key '{}'", file.string(), key));
  return *node;
}

double threshold(const YamlNode& map, const std::string& key, const std::filesystem::path& file) {
  const YamlNode& node = require_key(map, key, file);
  const double value = number_of(node, key);
  if (value < 0.0 || value > 1.0) {
    fail_at(node.mark, fmt::format("{} = {}, must be >= 0 and <= 1", key, shown(node)));
  }
  return value;
}

bool read_negate(const YamlNode& map) {
  const YamlNode* node = map.find("negate");
  if (!node) return false;
  if (node->is_scalar()) {
    const YamlScalar value = scalar_value(*node);
    if (const auto* flag = std::get_if<bool>(&value)) return *flag;
    if (const auto* whole = std::get_if<std::int64_t>(&value); whole && (*whole | 1) == 1) {
      return *whole == 1;
    }
  }
  fail_at(node->mark, fmt::format("negate = {}, must be 0 or 1", shown(*node)));
}

Eigen::Vector2d read_origin(const YamlNode& node) {
  if (!node.is_list() || node.items.size() != 3) {
    fail_at(node.mark, fmt::format("origin = {}, must be [x, y, yaw] in m and rad", shown(node)));
  }
  if (number_of(node.items[2], "origin's yaw") != 0.0) {
    fail_at(node.items[2].mark,
            fmt::format("origin's yaw = {} rad, must be 0: rotated maps are not supported",
                        shown(node.items[2])));
  }
  return {number_of(node.items[0], "origin's x"), number_of(node.items[1], "origin's y")};
}

}  // namespace

RosMap load_ros_map(const std::filesystem::path& yaml_file) {
  const YamlNode map = load_yaml_file(yaml_file);
  if (!map.is_mapping()) {
    throw ConfigError(fmt::format("ROS map '{}' must be a mapping with image, resolution, origin",
                                  yaml_file.string()));
  }
  const YamlNode& name = require_key(map, "image", yaml_file);
  if (!name.is_scalar() || name.text.empty()) {
    fail_at(name.mark, fmt::format("image = {}, must be the name of a PGM file", shown(name)));
  }
  const YamlNode& resolution = require_key(map, "resolution", yaml_file);
  RosMap result;
  OccupancyGrid& grid = result.grid;
  grid.cell_m = number_of(resolution, "resolution");
  if (grid.cell_m <= 0.0) {
    fail_at(resolution.mark, fmt::format("resolution = {}, must be > 0 m", shown(resolution)));
  }
  grid.corner_W = read_origin(require_key(map, "origin", yaml_file));
  const bool negate = read_negate(map);
  const double occupied_above = threshold(map, "occupied_thresh", yaml_file);
  const double free_below = threshold(map, "free_thresh", yaml_file);
  if (free_below > occupied_above) {
    throw ConfigError(
        fmt::format("ROS map '{}': free_thresh = {} must not be above occupied_thresh = {}",
                    yaml_file.string(), free_below, occupied_above));
  }
  if (const YamlNode* mode = map.find("mode"); mode && mode->text != "trinary") {
    fail_at(mode->mark, fmt::format("mode = {}, must be 'trinary'", shown(*mode)));
  }

  const std::filesystem::path picture = yaml_file.parent_path() / name.text;
  std::error_code error;
  if (!std::filesystem::exists(picture, error)) {
    fail_at(name.mark, fmt::format("image = {}: '{}' does not exist{}", shown(name),
                                   picture.string(), nearest_file_hint(picture)));
  }
  const GrayImage image = read_pgm(picture);
  grid.columns = image.width;
  grid.rows = image.height;
  grid.cells.resize(image.values.size());
  std::int64_t unknown = 0;
  for (int j = 0; j < grid.rows; ++j) {
    // The picture's first row is in the north, the grid's in the south.
    const std::size_t from = static_cast<std::size_t>(grid.rows - 1 - j) * image.width;
    for (int i = 0; i < grid.columns; ++i) {
      const int value = image.values[from + i];
      const double p = (negate ? value : image.maximum - value) / double(image.maximum);
      const bool free = p<free_below, occupied = p> occupied_above;
      unknown += !free && !occupied;
      grid.cells[static_cast<std::size_t>(j) * grid.columns + i] = free ? 0 : 1;
    }
  }
  if (unknown > 0) {
    result.notes.push_back(
        fmt::format("ROS map '{}': {} of {} cells are unknown and count as occupied",
                    yaml_file.string(), unknown, grid.cells.size()));
  }
  return result;
}

void save_ros_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_file) {
  VINEROW_DEMAND(!grid.empty());
  GrayImage image;
  image.width = grid.columns;
  image.height = grid.rows;
  image.values.reserve(grid.cells.size());
  for (int j = grid.rows - 1; j >= 0; --j) {
    for (int i = 0; i < grid.columns; ++i) {
      image.values.push_back(grid.occupied(i, j) ? kOccupiedPixel : kFreePixel);
    }
  }
  std::filesystem::path picture = yaml_file;
  picture.replace_extension(".pgm");
  write_pgm(picture, image);

  YamlNode origin = yaml_list();
  for (const double value : {grid.corner_W.x(), grid.corner_W.y(), 0.0}) {
    origin.items.push_back(yaml_number(value));
  }
  YamlNode map = yaml_mapping();
  map.put("image", yaml_text(picture.filename().string()));
  map.put("resolution", yaml_number(grid.cell_m));
  map.put("origin", std::move(origin));
  map.put("negate", yaml_integer(0));
  map.put("occupied_thresh", yaml_number(0.65));
  map.put("free_thresh", yaml_number(0.196));
  map.put("mode", yaml_text("trinary"));
  write_whole_file(yaml_file, to_yaml(map));
}

}  // namespace vinerow::io
