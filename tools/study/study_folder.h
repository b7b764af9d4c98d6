#pragma once
/// Folders of a study.

#include <cstddef>
#include <filesystem>
#include <string>

namespace vinerow::study {

struct StudyFolder {
  std::filesystem::path out;    ///< index, tables, kept runs
  std::filesystem::path cells;  ///< finished cells; may be shared by studies
  std::filesystem::path index() const { return out / "study.sqlite"; }
  std::filesystem::path kept() const { return out / "kept"; }
  /// Folder of a cell's kept run. It contains the identity, because a change of the study may
  /// renumber the cells.
  std::filesystem::path kept(std::size_t cell, const std::string& identity) const;
  /// Folder of jobs submitted to a cluster that have not ended.
  std::filesystem::path submitted() const { return out / "slurm"; }
};

}  // namespace vinerow::study
