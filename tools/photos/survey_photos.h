#pragma once
/// Photographs of a survey as its camera takes them, for photogrammetry: JPEG files with camera and
/// position, which COLMAP, OpenDroneMap, Metashape and Pix4D read, or TIFF files of a multispectral
/// camera's bands.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/product.h"
#include "engine/api/world_model.h"

namespace vinerow::tools {

struct SurveyPhotoOptions {
  /// Columns of the photographs, with the camera's shape and field of view; absent: the camera's.
  std::optional<int> columns;
  std::uint64_t seed = 1;  ///< of the noise
  /// Names of photo_bands(), in the order of the camera's sensors; empty: colours.
  std::vector<std::string> bands;
};

/// Bands that a survey can be photographed in: blue, green, red, red_edge, nir.
std::vector<std::string> photo_bands();

/// Number of a pixel of reflectance 1 in a band. MicaSense's software scales reflectances alike.
constexpr int kPanel = 32768;

/// The camera of these photographs.
/// @throws ConfigError if a photograph would be too small or too large, or a band is unknown or
/// twice
SurveyCamera photo_camera(const SurveyCamera& camera, const SurveyPhotoOptions& options);

/// Draws each picture by rays on the world as cameras see it, with an ideal lens, a global shutter
/// and automatic exposure. Vehicles are not in them: the aircraft is above, and where others were
/// is not known. Writes:
///
///   <folder>/photo_0001.jpg ...  Exif has the position that the vehicle estimated, or the true one
///                                without estimates
///   <folder>/photo_0001_red.tif ...  instead, if bands are wanted: 16-bit reflectances. A level
///                                white panel would have kPanel
///   <folder>/geo.txt             the same positions for OpenDroneMap, with the angles of the XMP
///                                and the rms of the positions' errors
///   <folder>/truth.csv           true position and orientation, in W and in WGS84
///
/// The folder is complete or absent. @param drawn  is called after each photograph with their
/// number so far, from any thread but never by two at once; if it returns false the work ends
/// @returns whether all were drawn
/// @throws ConfigError: no pictures, a camera below the ground, a folder that is not empty;
///   WriteError
bool write_survey_photos(const PictureSet& pictures, const WorldModel& world,
                         const SurveyPhotoOptions& options, const std::filesystem::path& folder,
                         const std::function<bool(int done)>& drawn);

}  // namespace vinerow::tools
