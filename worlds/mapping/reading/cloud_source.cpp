#include "worlds/mapping/reading/cloud_source.h"

namespace vinerow::mapping {

void add_source(const CloudReadReport& read, CloudMap& map) {
  CloudMapReport& report = map.report;
  report.file = std::filesystem::path(read.file).filename().string();
  report.format = read.format;
  report.crs = read.crs;
  report.cloud_bytes = static_cast<std::int64_t>(read.file_bytes);
  report.not_finite = static_cast<std::int64_t>(read.not_finite);
  report.reduction = report.cloud_bytes > 0 ? 1.0 - static_cast<double>(report.mesh_bytes) /
                                                        static_cast<double>(report.cloud_bytes)
                                            : 0.0;
  report.notes.insert(report.notes.begin(), read.sentences.begin(), read.sentences.end());
  map.has_origin = read.has_origin;
  map.origin = read.origin;
  for (CloudMap& block : map.blocks) add_source(read, block);
}

}  // namespace vinerow::mapping
