#pragma once
/// Pictures inside the page, so small that it stays quick to open.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/render/pixels.h"
#include "engine/scenario/scenario.h"
#include "tools/report/run_folder.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

struct Picture {
  std::filesystem::path file;  ///< PNG
  std::string caption;
  bool is_photo = false;  ///< put into the page as JPEG; drawings stay PNG, with sharp edges
};

/// Pictures of all that a page holds together.
constexpr std::size_t kPictureBudget_bytes = 6'000'000;

/// frames/*.png, coverage*.png, and those in products/*/, each with what it shows. Of more than 36
/// frames as many, evenly.
std::vector<Picture> frame_pictures(const RunFolder& run);
std::vector<Picture> coverage_pictures(const RunFolder& run);
std::vector<Picture> product_pictures(const RunFolder& run);

/// The picture that shows a stranger what the run is about: of a camera that does not look from
/// straight above, nothing drawn over it if there is such a one, its vehicle at work in the parcel,
/// and as much of it as can be showing vehicles that move, which the frames' files tell; where they
/// do not, as many as can be moving. The middle one of equals. Null where there is none.
const Picture* hero_picture(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                            const std::vector<Picture>& frames);

/// The width at which pictures of these files stay inside a budget, 1280 at most.
int fitting_width(const std::vector<Picture>& pictures, std::size_t budget_bytes);

/// <img> with the picture inside. @param most_width  pixels; a wider one is made smaller
/// @throws ConfigError where the file is no PNG
std::string embedded(const Picture& picture, int most_width);

/// <figure> with caption.
std::string picture_figure(const Picture& picture, int most_width);

/// Smaller by averaging what falls into each pixel. @pre 1 <= width <= pixels.width
render::Pixels shrunk(const render::Pixels& pixels, int width);

}  // namespace vinerow::tools::report
