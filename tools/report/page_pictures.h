#pragma once
/// Pictures embedded in the page, scaled so that the page opens quickly.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/imaging/pixels.h"
#include "engine/scenario/scenario.h"
#include "tools/report/run_folder.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

struct Picture {
  std::filesystem::path file;  ///< PNG
  std::string caption;
  bool is_photo = false;  ///< embedded as JPEG; drawings stay PNG, with sharp edges
};

/// Maximum total size of the pictures in a page. Chosen.
constexpr std::size_t kPictureBudget_bytes = 6'000'000;

/// Pictures frames/*.png, coverage*.png and products/*/*.png, each with a caption. At most 36
/// frames, evenly spaced.
std::vector<Picture> frame_pictures(const RunFolder& run);
std::vector<Picture> coverage_pictures(const RunFolder& run);
std::vector<Picture> product_pictures(const RunFolder& run);

/// Title picture of the run. In order of importance it prefers: a camera that does not look
/// straight down, no overlays, the camera's vehicle moving, that vehicle at a row, and the largest
/// share of the picture that shows moving vehicles (from data in the frame's file; without data,
/// the number of moving vehicles). Of equal ones the middle one. Null without frames.
const Picture* hero_picture(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                            const std::vector<Picture>& frames);

/// Width at which the pictures stay within a budget, at most 1280 px.
int fitting_width(const std::vector<Picture>& pictures, std::size_t budget_bytes);

/// <img> with the picture embedded. @param max_width  pixels; a wider picture is scaled down
/// @throws ConfigError if the file is not a PNG
std::string embedded(const Picture& picture, int max_width);

/// <figure> with picture and caption.
std::string picture_figure(const Picture& picture, int max_width);

/// Picture scaled down by averaging over each target pixel. @pre 1 <= width <= pixels.width
imaging::Pixels shrunk(const imaging::Pixels& pixels, int width);

}  // namespace vinerow::tools::report
