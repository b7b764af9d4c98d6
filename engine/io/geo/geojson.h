#pragma once
/// GeoJSON (RFC 7946): features with points, lines and polygons, coordinates in WGS84 degrees, or
/// in the system that a member `crs` names (GeoJSON of 2008).

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
      points;  ///< one for a point; the outer ring for a polygon; altitude 0 where not given
  bool has_altitude = false;  ///< every coordinate has a third number
  std::map<std::string, std::string>
      properties;  ///< texts as they are, numbers and others as JSON text
  int index = 0;   ///< position of the feature in the file, 0-based

  /// @returns the property, or "" where the feature has none
  std::string property(const std::string& name) const;
};

/// Reads a FeatureCollection, a single Feature or a bare geometry. Multi-geometries become several
/// features with the same index.
/// @throws ConfigError naming the file (and feature): missing file, malformed JSON (with line and
/// column), no GeoJSON,
///         a coordinate that is no finite number or lies outside +-180, +-90 deg, a line of fewer
///         than 2 points
std::vector<GeoFeature> read_geojson(const std::filesystem::path& file);

/// Rows, poles and vines of a survey.
struct SurveyFile {
  std::vector<GeoFeature> rows;   ///< LineStrings
  std::vector<GeoFeature> poles;  ///< Points whose type or name says pole or post
  std::vector<GeoFeature> vines;  ///< Points whose type or name says vine or tree
};

/// Reads rows (and, where the file has them, poles and vines) from any file of read_features
/// (geo_features.h). Where there is no LineString, points that tell their row's number (property
/// row, row_id, row_number or row_nr; poles alone where some are called so) make the rows.
/// @param row_type  take LineStrings whose property `type` is this; "" takes `row`, `vine_row`,
/// `connection_line` if
///                  any line has one of them, else every line that is not called mid_row_line
/// @throws ConfigError as read_geojson, and "'file' has no LineString (40 points): rows are needed"
/// or, where lines are
///         there but none of the wanted type, the types that are there
SurveyFile read_survey(const std::filesystem::path& file, const std::string& row_type = "");

}  // namespace vinerow::io
