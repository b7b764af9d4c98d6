#include "engine/io/geo/crs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "engine/core/error.h"

namespace vinerow::io {
namespace {

/// True for what GDAL would open and read as a definition: a file, one of its virtual file systems,
/// or a URL, apart from the names that OGC gives to systems in the form of one. (The C interface
/// has no switch for this before GDAL 3.9.)
bool names_a_file(const std::string& text) {
  std::string start = text.substr(0, 32);
  for (char& c : start) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (start.rfind("/vsi", 0) == 0) return true;
  for (const char* scheme : {"http://", "https://"}) {
    if (start.rfind(scheme, 0) != 0) continue;
    const std::string host = start.substr(std::string(scheme).size());
    return host.rfind("opengis.net/def/crs/", 0) != 0 &&
           host.rfind("www.opengis.net/def/crs/", 0) != 0;
  }
  std::error_code too_long;
  return std::filesystem::exists(text, too_long);
}

/// A definition that GDAL reads brings its authority's order of axes, so this follows each reading.
void put_easting_first(OGRSpatialReferenceH crs) {
  gdal().OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
}

}  // namespace

Crs::Crs(OGRSpatialReferenceH copied) : handle_(gdal().OSRClone(copied)) {
  put_easting_first(get());
}

Crs::Crs() : handle_(gdal().OSRNewSpatialReference(nullptr)) {
  put_easting_first(get());
}

std::string Crs::name() const {
  const char* name = gdal().OSRGetName(get());
  return name == nullptr ? "" : name;
}

double Crs::height_unit_m() const {
  if (is_compound() || gdal().OSRIsVertical(get()) != 0) {
    return gdal().OSRGetTargetLinearUnits(get(), "VERT_CS", nullptr);
  }
  return is_projected() ? gdal().OSRGetLinearUnits(get(), nullptr) : 1.0;
}

void Crs::strip_vertical() {
  if (is_compound()) gdal().OSRStripVertical(get());
}

bool is_georeferenced(OGRSpatialReferenceH crs) {
  return crs != nullptr && gdal().OSRGetName(crs) != nullptr && gdal().OSRIsLocal(crs) == 0;
}

Crs parse_crs(const std::string& text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool is_code = !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
  const std::string name = is_code ? "EPSG:" + text : text;
  Crs crs;
  if (name.empty() || names_a_file(name) ||
      gdal().OSRSetFromUserInput(crs.get(), name.c_str()) != OGRERR_NONE) {
    throw ConfigError(
        fmt::format("crs = '{}' is not a coordinate reference system, must be like EPSG:32632",
                    text.substr(0, 60)));
  }
  put_easting_first(crs.get());
  return crs;
}

Crs parse_wkt(const std::string& wkt) {
  Crs crs;
  std::string text = wkt;
  char* rest = text.data();  // GDAL moves it to behind what it has read
  gdal().OSRImportFromWkt(crs.get(), &rest);
  put_easting_first(crs.get());
  return crs;
}

std::string wkt_of(const Crs& crs) {
  char* text = nullptr;
  gdal().OSRExportToWkt(crs.get(), &text);
  std::string wkt = text == nullptr ? "" : text;
  gdal().VSIFree(text);
  return wkt;
}

Crs make_wgs84() {
  Crs wgs84;
  gdal().OSRSetWellKnownGeogCS(wgs84.get(), "WGS84");
  put_easting_first(wgs84.get());
  return wgs84;
}

Transformation::Transformation(const Crs& from, const Crs& to)
    : handle_(gdal().OCTNewCoordinateTransformation(from.get(), to.get())) {}

}  // namespace vinerow::io
