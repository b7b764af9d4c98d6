#include "engine/io/geo/crs_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"

namespace vinerow::io {

OGRSpatialReference parse_crs(const std::string& text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool is_code = !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
  const std::string name = is_code ? "EPSG:" + text : text;
  OGRSpatialReference crs;
  if (name.empty() ||
      crs.SetFromUserInput(name.c_str(),
                           OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
          OGRERR_NONE) {
    throw ConfigError(
        fmt::format("crs = '{}' is not a coordinate reference system, must be like EPSG:32632",
                    text.substr(0, 60)));
  }
  return crs;
}

OGRSpatialReference make_wgs84() {
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return wgs84;
}

}  // namespace vinerow::io
