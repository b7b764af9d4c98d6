#pragma once
/// Owning pointers for GDAL objects.

#include <initializer_list>
#include <memory>

#include "engine/io/geo/gdal_library.h"

namespace vinerow::io {

struct DatasetCloser {
  void operator()(GDALDatasetH dataset) const { gdal().GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, DatasetCloser>;

struct FeatureDestroyer {
  void operator()(OGRFeatureH feature) const { gdal().OGR_F_Destroy(feature); }
};
using FeatureHandle = std::unique_ptr<void, FeatureDestroyer>;

/// "NAME=VALUE" texts of a driver.
class DriverOptions {
 public:
  DriverOptions(std::initializer_list<const char*> options) {
    for (const char* option : options) list_ = gdal().CSLAddString(list_, option);
  }
  ~DriverOptions() { gdal().CSLDestroy(list_); }
  DriverOptions(const DriverOptions&) = delete;
  DriverOptions& operator=(const DriverOptions&) = delete;
  char** list() const { return list_; }

 private:
  char** list_ = nullptr;
};

}  // namespace vinerow::io
