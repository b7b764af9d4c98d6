#include "engine/io/clouds/point_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/io/clouds/point_cloud_las.h"
#include "engine/io/clouds/point_cloud_pcd.h"
#include "engine/io/clouds/point_cloud_ply.h"
#include "engine/io/clouds/point_cloud_xyz.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {
namespace {

bool is_text_extension(const std::string& extension) {
  constexpr std::array<std::string_view, 5> kText = {".xyz", ".csv", ".txt", ".asc", ".pts"};
  return std::find(kText.begin(), kText.end(), extension) != kText.end();
}

}  // namespace

std::size_t PointCloudReader::read(std::span<CloudPoint> block) {
  std::size_t count = 0;
  while (count < block.size() && !ended_) {
    CloudPoint& point = block[count];
    switch (next(point)) {
      case Next::kEnd:
        ended_ = true;
        break;
      case Next::kWithheld:
        ++tally_.withheld;
        break;
      case Next::kPoint:
        if (point.position.allFinite()) {
          ++count;
        } else {
          ++tally_.not_finite;
        }
    }
  }
  tally_.given += count;
  return count;
}

std::unique_ptr<PointCloudReader> open_point_cloud(const std::filesystem::path& file) {
  return open_point_cloud(BlockFile(file));
}

std::unique_ptr<PointCloudReader> open_point_cloud(BlockFile bytes) {
  const std::string begin = bytes.peek(16);
  const std::string extension = lower_extension(bytes.name());
  if (begin.starts_with("LASF")) return open_las(std::move(bytes));
  if (begin.starts_with("ply\n") || begin.starts_with("ply\r")) return open_ply(std::move(bytes));
  if (begin.starts_with("# .PCD") || begin.starts_with("VERSION")) {
    return open_pcd(std::move(bytes));
  }
  // The extension shows the intended format, so the message can name the fault.
  if (extension == ".las" || extension == ".laz") bytes.fail_kind(begin, "LAS file", "LASF");
  if (extension == ".ply") bytes.fail_kind(begin, "PLY file", "ply");
  if (extension == ".pcd") bytes.fail_kind(begin, "PCD file", "# .PCD or VERSION");
  if (is_text_extension(extension)) return open_xyz(std::move(bytes));
  bytes.fail(fmt::format(
      "has the unknown format '{}', must be one of: .ply, .las, .pcd, .xyz, .csv, .txt, .asc, .pts",
      extension));
}

}  // namespace vinerow::io
