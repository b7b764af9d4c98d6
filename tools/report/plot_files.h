#pragma once
/// The plots and maps of a report as files of their own, for papers and slides.

#include <filesystem>
#include <string>
#include <vector>

namespace vinerow::tools {

/// One picture, complete: title, legend, and its style in plain colours, which other programs than
/// browsers also know.
struct PlotFile {
  std::string name;  ///< "rover_speed.svg"
  std::string svg;
};

/// @param page        of write_report(), or another whose figures are written alike
/// @param more_style  of that page, beside page_style(): rules that begin with "svg" count
std::vector<PlotFile> plot_files_of(const std::string& page, const std::string& more_style = "");

}  // namespace vinerow::tools
