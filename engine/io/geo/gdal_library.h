#pragma once
/// GDAL's C interface, from the shared library that its first use opens.
///
/// GDAL brings a hundred libraries of its drivers. Loading them takes 28 of the 46 ms that a
/// program would need until main(), and few runs read geodata by GDAL. So nothing here links it.

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

namespace vinerow::io {

// clang-format off

/// The functions that are in use: files and errors, data sets, reference systems, features,
/// geometries. Their types are those of GDAL's headers.
#define VINEROW_GDAL_FUNCTIONS(X)                                                                 \
  X(CPLErrorReset) X(CPLGetLastErrorType) X(CPLPopErrorHandler) X(CPLPushErrorHandler)            \
  X(CPLQuietErrorHandler) X(CPLSetThreadLocalConfigOption) X(CSLAddString) X(CSLDestroy)          \
  X(VSIFree)                                                                                      \
  X(GDALAllRegister) X(GDALClose) X(GDALCreate) X(GDALDatasetCreateLayer) X(GDALDatasetGetLayer)  \
  X(GDALDatasetGetLayerCount) X(GDALGetDriverByName) X(GDALGetGeoTransform) X(GDALGetRasterBand)  \
  X(GDALGetRasterCount) X(GDALGetRasterNoDataValue) X(GDALGetRasterOffset) X(GDALGetRasterScale)  \
  X(GDALGetRasterUnitType) X(GDALGetRasterXSize) X(GDALGetRasterYSize) X(GDALGetSpatialRef)       \
  X(GDALOpenEx) X(GDALRasterIO) X(GDALSetDescription) X(GDALSetGeoTransform)                      \
  X(GDALSetRasterNoDataValue)                                                                     \
  X(GDALSetRasterOffset) X(GDALSetRasterScale) X(GDALSetRasterUnitType) X(GDALSetSpatialRef)      \
  X(OCTDestroyCoordinateTransformation) X(OCTNewCoordinateTransformation) X(OCTTransform)         \
  X(OSRClone) X(OSRDestroySpatialReference) X(OSRExportToWkt) X(OSRGetAuthorityCode)              \
  X(OSRGetAuthorityName) X(OSRGetLinearUnits) X(OSRGetName) X(OSRGetTargetLinearUnits)            \
  X(OSRImportFromWkt) X(OSRIsCompound) X(OSRIsGeographic) X(OSRIsLocal) X(OSRIsProjected)         \
  X(OSRIsSameGeogCS) X(OSRIsVertical) X(OSRNewSpatialReference) X(OSRSetAxisMappingStrategy)      \
  X(OSRSetFromUserInput) X(OSRSetProjCS) X(OSRSetTM) X(OSRSetWellKnownGeogCS)                     \
  X(OSRStripVertical)                                                                             \
  X(OGR_F_Create) X(OGR_F_Destroy) X(OGR_F_GetFieldAsString) X(OGR_F_GetFieldCount)               \
  X(OGR_F_GetFieldDefnRef) X(OGR_F_GetGeometryRef) X(OGR_F_IsFieldSetAndNotNull)                  \
  X(OGR_F_SetFieldDouble) X(OGR_F_SetFieldInteger64) X(OGR_F_SetFieldString)                      \
  X(OGR_F_SetGeometryDirectly) X(OGR_Fld_Create) X(OGR_Fld_Destroy) X(OGR_Fld_GetNameRef)         \
  X(OGR_L_CreateFeature) X(OGR_L_CreateField) X(OGR_L_GetLayerDefn) X(OGR_L_GetNextFeature)       \
  X(OGR_L_GetSpatialRef) X(OGR_L_ResetReading)                                                    \
  X(OGR_GT_Flatten) X(OGR_G_AddGeometryDirectly) X(OGR_G_AddPoint) X(OGR_G_CloseRings)            \
  X(OGR_G_CreateGeometry) X(OGR_G_GetGeometryCount) X(OGR_G_GetGeometryName)                      \
  X(OGR_G_GetGeometryRef) X(OGR_G_GetGeometryType) X(OGR_G_GetPointCount) X(OGR_G_GetX)           \
  X(OGR_G_GetY) X(OGR_G_GetZ) X(OGR_G_Is3D) X(OGR_G_IsEmpty)

// clang-format on

struct GdalLibrary {
#define VINEROW_GDAL_MEMBER(function) decltype(&::function) function = nullptr;
  VINEROW_GDAL_FUNCTIONS(VINEROW_GDAL_MEMBER)
#undef VINEROW_GDAL_MEMBER
};

/// The library, opened by the first call. Thread safe.
/// @throws ConfigError "geodata need GDAL, which cannot be loaded: ..."
const GdalLibrary& gdal();

}  // namespace vinerow::io
