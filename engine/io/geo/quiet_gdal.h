#pragma once
/// Scope without GDAL messages on stderr.

#include <cpl_error.h>

namespace vinerow::io {

/// Silences GDAL during its lifetime: callers report GDAL's errors as one-sentence exceptions.
class QuietGdal {
 public:
  QuietGdal() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

}  // namespace vinerow::io
