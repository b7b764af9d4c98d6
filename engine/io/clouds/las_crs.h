#pragma once
/// The coordinate reference system in the records of a LAS file.

#include <span>
#include <string>

#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// What a file's (extended) variable length records tell of its CRS.
class LasCrs {
 public:
  /// Looks at one record of the user "LASF_Projection"; others are not for this.
  /// @param file  at the record's data, `bytes` long. @throws ConfigError where it is cut off
  void read(BlockFile& file, int record_id, std::uint64_t bytes);

  /// "EPSG:25832", "EPSG:25832+7837", WKT, or "". WKT goes before the GeoTIFF keys where
  /// `prefers_wkt` (global encoding, bit 4) or where there are no keys.
  std::string text(bool prefers_wkt) const;

 private:
  void read_keys(std::span<const std::uint8_t> data);
  int projected_ = 0, geographic_ = 0, vertical_ = 0;  // EPSG codes; 0: untold
  std::string wkt_;
};

}  // namespace vinerow::io
