#pragma once
/// Coordinate reference systems and transformations between them, by GDAL and PROJ.

#include <cstddef>
#include <memory>
#include <string>

#include "engine/io/geo/gdal_library.h"

namespace vinerow::io {

/// A coordinate reference system. Transformations take and give x = easting or longitude first,
/// regardless of the authority's axis order.
class Crs {
 public:
  /// Copies a system of GDAL, which stays its owner.
  explicit Crs(OGRSpatialReferenceH copied);
  /// Without any definition.
  Crs();

  OGRSpatialReferenceH get() const { return handle_.get(); }

  /// "" if GDAL knows none.
  std::string name() const;
  bool is_geographic() const { return gdal().OSRIsGeographic(get()) != 0; }
  bool is_projected() const { return gdal().OSRIsProjected(get()) != 0; }
  bool is_compound() const { return gdal().OSRIsCompound(get()) != 0; }
  /// Unit of z in metres: that of the vertical part, or of a projected system.
  double height_unit_m() const;

  /// Leaves the horizontal part.
  void strip_vertical();

 private:
  struct Destroyer {
    void operator()(OGRSpatialReferenceH crs) const { gdal().OSRDestroySpatialReference(crs); }
  };
  std::unique_ptr<void, Destroyer> handle_;
};

/// False for none, for a system without a definition and for a local one.
bool is_georeferenced(OGRSpatialReferenceH crs);

/// @param text  "EPSG:25832", the code alone, WKT, or another form that PROJ reads, except files
/// and URLs
/// @throws ConfigError "crs = 'x' is not a coordinate reference system, must be like EPSG:32632"
Crs parse_crs(const std::string& text);

/// @param wkt  of another Crs
Crs parse_wkt(const std::string& wkt);
/// WKT that parse_wkt() reads; "" for a system without a definition.
std::string wkt_of(const Crs& crs);

/// WGS84 with longitude and latitude in degrees, in this order.
Crs make_wgs84();

/// Transformation of positions from one system to another.
class Transformation {
 public:
  /// None.
  Transformation() = default;
  /// None if there is no way from one to the other.
  Transformation(const Crs& from, const Crs& to);

  explicit operator bool() const { return handle_ != nullptr; }

  /// In place. @returns false if one of the positions cannot be transformed @pre not none
  bool apply(double& x, double& y) const { return apply(1, &x, &y); }
  bool apply(std::size_t count, double* x, double* y) const {
    return gdal().OCTTransform(handle_.get(), static_cast<int>(count), x, y, nullptr) != 0;
  }

 private:
  struct Destroyer {
    void operator()(OGRCoordinateTransformationH transformation) const {
      gdal().OCTDestroyCoordinateTransformation(transformation);
    }
  };
  std::unique_ptr<void, Destroyer> handle_;
};

}  // namespace vinerow::io
