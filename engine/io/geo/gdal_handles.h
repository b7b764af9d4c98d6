#pragma once
/// Owning pointers for GDAL objects.

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <memory>

namespace vinerow::io {

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

struct TransformDestroyer {
  void operator()(OGRCoordinateTransformation* t) const {
    OGRCoordinateTransformation::DestroyCT(t);
  }
};
using Transformation = std::unique_ptr<OGRCoordinateTransformation, TransformDestroyer>;

}  // namespace vinerow::io
