#pragma once
/// Report page of a map made from a point cloud.

#include <string>
#include <vector>

#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::tools {

/// Picture file next to the page.
struct ReportPicture {
  std::string file;     ///< relative to the page
  std::string caption;  ///< one sentence
};

/// Page that opens without a network: headline figures, pictures, a table of rows, notes. It is
/// well-formed XML too. @param title  title of the page, such as the parcel's name
std::string map_report_html(const mapping::CloudMap& map,
                            const std::vector<ReportPicture>& pictures, const std::string& title);

/// The same figures for a terminal, one per line, keys first.
std::string map_report_text(const mapping::CloudMap& map);

}  // namespace vinerow::tools
