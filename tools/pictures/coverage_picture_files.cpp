#include "tools/pictures/coverage_picture_files.h"

#include <fmt/format.h>

#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/pictures/coverage_picture.h"

namespace vinerow::tools {
namespace {

void write_coverage_of(const playback::SurveyCoverage& coverage,
                       const std::filesystem::path& picture) {
  io::make_folder_of(picture);
  render::write_png(picture.string(), draw_coverage(coverage));
  std::filesystem::path numbers = picture;
  numbers.replace_extension(".json");
  write_whole_file(numbers, playback::coverage_json(coverage));
}

/// Picture file of a camera. With several cameras the file name contains the camera's name.
std::filesystem::path coverage_file_of(const playback::SurveyCoverage& coverage,
                                       const std::filesystem::path& out, std::size_t cameras) {
  if (cameras == 1) return out;
  std::filesystem::path file = out;
  return file.replace_filename(fmt::format("{}_{}_{}{}", out.stem().string(), coverage.vehicle,
                                           coverage.camera, out.extension().string()));
}

}  // namespace

std::vector<std::filesystem::path> write_coverage(const std::filesystem::path& log,
                                                  const Registry& registry,
                                                  const playback::CoverageChoice& choice,
                                                  const std::filesystem::path& out) {
  std::vector<std::filesystem::path> files;
  const std::vector<playback::SurveyCoverage> all = playback::read_coverage(log, registry, choice);
  for (const playback::SurveyCoverage& coverage : all) {
    files.push_back(coverage_file_of(coverage, out, all.size()));
    write_coverage_of(coverage, files.back());
  }
  return files;
}

}  // namespace vinerow::tools
