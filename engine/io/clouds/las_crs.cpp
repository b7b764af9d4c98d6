#include "engine/io/clouds/las_crs.h"

#include <fmt/format.h>

#include "engine/io/clouds/point_cloud_scalar.h"

namespace vinerow::io {
namespace {

// Records of the user "LASF_Projection" (LAS 1.4-R15, section 3).
constexpr int kWkt = 2112;
constexpr int kGeoKeyDirectory = 34735;

// Keys of GeoTIFF 1.0, section 6.2, whose values are EPSG codes.
constexpr int kGeographicType = 2048;
constexpr int kProjectedCsType = 3072;
constexpr int kVerticalCsType = 4096;

/// Codes from 1024 to 32766 are EPSG's; 0 is "undefined", 32767 "user-defined".
bool is_epsg(int code) {
  return code >= 1024 && code < 32767;
}

}  // namespace

void LasCrs::read(BlockFile& file, int record_id, std::uint64_t bytes) {
  if (record_id != kWkt && record_id != kGeoKeyDirectory) return;
  if (bytes > BlockFile::kBytes) {
    file.fail(
        fmt::format("has a CRS record of {} bytes, must be at most {}", bytes, BlockFile::kBytes));
  }
  const auto count = static_cast<std::size_t>(bytes);
  const std::uint8_t* data = file.take(count);
  if (data == nullptr) file.fail("is cut off in the record of its CRS");
  if (record_id == kGeoKeyDirectory) {
    read_keys({data, count});
  } else {
    wkt_.assign(reinterpret_cast<const char*>(data), count);
    wkt_.resize(std::min(wkt_.find('\0'), wkt_.size()));
  }
}

void LasCrs::read_keys(std::span<const std::uint8_t> data) {
  // Four 16-bit numbers: version, revision, minor, count of keys; then four for each key: id,
  // location of the value (0: the fourth number), count, value.
  const auto at = [&](std::size_t k) { return int{load<std::uint16_t>(data.data() + 2 * k)}; };
  if (data.size() < 8) return;
  const std::size_t keys =
      std::min<std::size_t>(static_cast<std::size_t>(at(3)), data.size() / 8 - 1);
  for (std::size_t k = 1; k <= keys; ++k) {
    if (at(4 * k + 1) != 0 || !is_epsg(at(4 * k + 3))) continue;
    if (at(4 * k) == kProjectedCsType) projected_ = at(4 * k + 3);
    if (at(4 * k) == kGeographicType) geographic_ = at(4 * k + 3);
    if (at(4 * k) == kVerticalCsType) vertical_ = at(4 * k + 3);
  }
}

std::string LasCrs::text(bool prefers_wkt) const {
  const int horizontal = projected_ != 0 ? projected_ : geographic_;
  if (!wkt_.empty() && (prefers_wkt || horizontal == 0)) return wkt_;
  if (horizontal == 0) return "";
  return vertical_ == 0 ? fmt::format("EPSG:{}", horizontal)
                        : fmt::format("EPSG:{}+{}", horizontal, vertical_);
}

}  // namespace vinerow::io
