#pragma once
/// Where a study lies.

#include <cstddef>
#include <filesystem>
#include <string>

namespace vinerow::study {

struct StudyFolder {
  std::filesystem::path out;    ///< index, tables, kept runs
  std::filesystem::path cells;  ///< of finished cells; may be shared by studies
  std::filesystem::path index() const { return out / "study.sqlite"; }
  std::filesystem::path kept() const { return out / "kept"; }
  /// Of one cell's run. Cells may be counted otherwise after a change of the study.
  std::filesystem::path kept(std::size_t cell, const std::string& identity) const;
  /// What was submitted to a cluster and has not ended.
  std::filesystem::path submitted() const { return out / "slurm"; }
};

}  // namespace vinerow::study
