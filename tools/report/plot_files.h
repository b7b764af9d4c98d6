#pragma once
/// Export of a report's plots and maps as separate files, for papers and slides.

#include <filesystem>
#include <string>
#include <vector>

namespace vinerow::tools {

/// Complete picture with title, legend and style. Colours are literal, for programs other than
/// browsers.
struct PlotFile {
  std::string name;  ///< "rover_speed.svg"
  std::string svg;
};

/// Plots of a page.
/// @param page        page of write_report(), or another with figures of the same form
/// @param more_style  style of that page in addition to page_style(): rules that begin with "svg"
/// count
std::vector<PlotFile> plot_files_of(const std::string& page, const std::string& more_style = "");

}  // namespace vinerow::tools
