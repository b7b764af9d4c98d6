#pragma once
/// Keeps GDAL off stderr.

#include <cpl_error.h>

namespace vinerow::io {

/// GDAL prints its errors on stderr; ours say them in one sentence.
class QuietGdal {
 public:
  QuietGdal() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

}  // namespace vinerow::io
