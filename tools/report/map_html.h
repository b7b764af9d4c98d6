#pragma once
/// report.html of a map that was made of a point cloud.

#include <string>
#include <vector>

#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::tools {

/// A picture beside the page.
struct ReportPicture {
  std::string file;     ///< relative to the page
  std::string caption;  ///< one sentence
};

/// One page that opens without a network: headline figures, pictures, a table of rows, notes. Well
/// formed as XML, too. @param title  of the page, like the parcel's name
std::string map_report_html(const mapping::CloudMap& map,
                            const std::vector<ReportPicture>& pictures, const std::string& title);

/// The same figures for a terminal, a line each, keys first.
std::string map_report_text(const mapping::CloudMap& map);

}  // namespace vinerow::tools
