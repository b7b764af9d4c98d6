#pragma once
/// GeoJSON (RFC 7946) reader: features with points, lines and polygons. Coordinates are WGS84
/// degrees, or in the system that a member `crs` names (GeoJSON of 2008).

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/geo.h"

namespace vinerow::io {

enum class GeometryKind { kPoint, kLineString, kPolygon };

struct GeoFeature {
  GeometryKind kind = GeometryKind::kPoint;
  std::vector<Geodetic>
      points;  ///< one for a point; the outer ring for a polygon; altitude 0 if not given
  bool has_altitude = false;  ///< every coordinate has a third number
  std::map<std::string, std::string>
      properties;  ///< texts as they are, numbers and others as JSON text
  int index = 0;   ///< position of the feature in the file, 0-based

  /// @returns the property, or "" if it is missing
  std::string property(const std::string& name) const;
};

/// Reads a FeatureCollection, a single Feature or a bare geometry. Multi-geometries become several
/// features with the same index.
/// @throws ConfigError naming the file (and feature): missing file, malformed JSON (with line and
/// column), not GeoJSON, a coordinate that is not a finite number or outside +-180, +-90 deg, a
/// line of fewer than 2 points
std::vector<GeoFeature> read_geojson(const std::filesystem::path& file);

/// Rows, poles and vines of a survey file.
struct SurveyFile {
  std::vector<GeoFeature> rows;   ///< LineStrings
  std::vector<GeoFeature> poles;  ///< points whose type or name contains pole or post
  std::vector<GeoFeature> vines;  ///< points whose type or name contains vine or tree
  int areas = 0;                  ///< polygons, which are left out
  int other_points = 0;           ///< left out too; 0 if rows are built from points
};

/// Reads rows, and poles and vines if the file has them, from any file of read_features
/// (geo_features.h). If there is no LineString, rows are built from points with a row number
/// (property row, row_id, row_number or row_nr). If some of these points are poles, only poles are
/// used.
/// @param row_type  selects LineStrings whose property `type` is this. "" selects `row`, `vine_row`
/// and `connection_line` if any line has one of them, else every line except mid_row_line
/// @throws ConfigError as read_geojson, and "'file' has no LineString (40 points): rows are needed"
/// or, if no line has the wanted type, the types that exist
SurveyFile read_survey(const std::filesystem::path& file, const std::string& row_type = "");

}  // namespace vinerow::io
