#pragma once
/// Files of a cloud in the frame of the map.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/time.h"
#include "engine/io/geo/local_to_crs.h"
#include "tools/export/cloud_message.h"

namespace vinerow::tools {

/// One file, of which nothing is left unless it is finished.
class MapCloudFile {
 public:
  virtual ~MapCloudFile() = default;
  MapCloudFile(const MapCloudFile&) = delete;
  MapCloudFile& operator=(const MapCloudFile&) = delete;

  /// @param fields  of all points, with x, y and z
  virtual void begin(const std::vector<CloudField>& fields) = 0;
  /// @param point  bytes of the fields  @param p_W  its place  @param time  of the run
  virtual void put(const std::uint8_t* point, const Eigen::Vector3d& p_W, Time time) = 0;
  virtual void finish(std::uint64_t points) = 0;

 protected:
  MapCloudFile() = default;
};

/// Place of W in a coordinate reference system.
struct CrsPlace {
  std::string crs;  ///< "EPSG:25832"
  GeoOrigin origin;
};

/// PLY and PCD: all fields, coordinates in single precision, `time` of the run in double precision.
/// @param file  .ply or .pcd
std::unique_ptr<MapCloudFile> make_table_cloud(const std::filesystem::path& file);

/// LAS 1.2, point format 1: coordinates of the map, or of a CRS, in tenths of a millimetre;
/// intensity in hundredths of its unit, at most 65535; the time of the run; the ring as user data.
/// @throws ConfigError if the CRS is not known
std::unique_ptr<MapCloudFile> make_las_cloud(const std::filesystem::path& file,
                                             const std::optional<CrsPlace>& place);

}  // namespace vinerow::tools
