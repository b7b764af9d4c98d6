#include "tests/fuzz/read_cloud_bytes.h"

#include <array>
#include <memory>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/io/clouds/point_cloud.h"
#include "engine/io/clouds/point_cloud_las.h"
#include "engine/io/clouds/point_cloud_pcd.h"
#include "engine/io/clouds/point_cloud_ply.h"
#include "engine/io/clouds/point_cloud_xyz.h"
#include "engine/io/files/block_file.h"

namespace vinerow::fuzz {
namespace {

const char* name_of(CloudKind kind) {
  switch (kind) {
    case CloudKind::kLas:
      return "input.las";
    case CloudKind::kPly:
      return "input.ply";
    case CloudKind::kPcd:
      return "input.pcd";
    default:
      return "input.xyz";
  }
}

std::unique_ptr<io::PointCloudReader> open(CloudKind kind, io::BlockFile file) {
  switch (kind) {
    case CloudKind::kLas:
      return io::open_las(std::move(file));
    case CloudKind::kPly:
      return io::open_ply(std::move(file));
    case CloudKind::kPcd:
      return io::open_pcd(std::move(file));
    case CloudKind::kXyz:
      return io::open_xyz(std::move(file));
    default:
      return io::open_point_cloud(std::move(file));
  }
}

}  // namespace

std::string read_cloud_bytes(CloudKind kind, std::span<const std::uint8_t> bytes) {
  const std::string name = name_of(kind);
  try {
    io::BlockFile file(name, std::string(bytes.begin(), bytes.end()));
    const std::unique_ptr<io::PointCloudReader> reader = open(kind, std::move(file));
    std::array<io::CloudPoint, 64> block;
    std::uint64_t given = 0;
    std::size_t count = 0;
    do {
      count = reader->read(block);
      for (std::size_t k = 0; k < count; ++k) VINEROW_DEMAND(block[k].position.allFinite());
      given += count;
    } while (count == block.size());
    VINEROW_DEMAND(reader->read(block) == 0);
    VINEROW_DEMAND(reader->tally().given == given);
    // Each record takes a byte of the file at least.
    VINEROW_DEMAND(given + reader->tally().not_finite + reader->tally().withheld <= bytes.size());
  } catch (const ConfigError& error) {
    const std::string sentence = error.what();
    VINEROW_DEMAND(sentence.starts_with("point cloud '" + name + "' "));
    for (const char c : sentence) VINEROW_DEMAND(c >= 0x20 && c < 0x7f);
    return sentence;
  }
  return "";
}

}  // namespace vinerow::fuzz
