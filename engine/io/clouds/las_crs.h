#pragma once
/// The coordinate reference system in the records of a LAS file.

#include <span>
#include <string>

#include "engine/io/files/block_file.h"

namespace vinerow::io {

/// CRS from a file's (extended) variable length records.
class LasCrs {
 public:
  /// Reads one record. @pre its user id is "LASF_Projection"
  ///
  /// @param file  positioned at the record's data, `bytes` long. @throws ConfigError if it is
  /// truncated
  void read(BlockFile& file, int record_id, std::uint64_t bytes);

  /// "EPSG:25832", "EPSG:25832+7837", WKT, or "". WKT is used instead of the GeoTIFF keys if
  /// `prefers_wkt` (global encoding, bit 4) or if there are no keys.
  std::string text(bool prefers_wkt) const;

 private:
  void read_keys(std::span<const std::uint8_t> data);
  int projected_ = 0, geographic_ = 0, vertical_ = 0;  // EPSG codes; 0: not given
  std::string wkt_;
};

}  // namespace vinerow::io
