#pragma once
/// Parameters of a camera's lens.

#include <optional>
#include <string>
#include <vector>

#include "engine/api/lens.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::sensors {

struct LensParams {
  int width_px = 640;
  int height_px = 480;
  CameraInfo::Lens lens = CameraInfo::Lens::kBrownConrady;
  double horizontal_fov_rad = 1.2;
  std::optional<double> fx_px, fy_px, cx_px, cy_px;
  std::vector<double> distortion;
};

/// `width_px` to `distortion`.
const ParameterTable<LensParams>& lens_table();

/// @param who  for errors
/// @throws ConfigError if the distortion maps two directions to one pixel of the picture
Lens make_lens(const LensParams& params, const std::string& who);

}  // namespace vinerow::sensors
