#pragma once
/// Scope without GDAL messages on stderr.

#include "engine/io/geo/gdal_library.h"

namespace vinerow::io {

/// Silences GDAL during its lifetime: callers report GDAL's errors as one-sentence exceptions.
class QuietGdal {
 public:
  QuietGdal() { gdal().CPLPushErrorHandler(gdal().CPLQuietErrorHandler); }
  ~QuietGdal() { gdal().CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

}  // namespace vinerow::io
