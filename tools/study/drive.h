#pragma once
/// Runs the cells of a study that are not finished yet, on this machine.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "tools/study/open_study.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// Where a study lies.
struct StudyFolder {
  std::filesystem::path out;    ///< index, tables, kept runs
  std::filesystem::path cells;  ///< of finished cells; may be shared by studies
  std::filesystem::path index() const { return out / "study.sqlite"; }
  std::filesystem::path kept() const { return out / "kept"; }
};

struct StudyProgress {
  std::size_t finished = 0;  ///< before and by this call
  std::size_t failed = 0;    ///< of them: what did not run to its end
  std::size_t total = 0;     ///< cells, as far as they are needed
  std::size_t run = 0;       ///< by this call
  double wall_s = 0.0;       ///< of this call
};

struct DriveOptions {
  StudyFolder folder;
  int jobs = 1;
  bool fresh = false;  ///< begin a new index
  bool retry = false;  ///< run cells again that crashed or went over their budget
  std::function<void(const StudyProgress&)> progress;
  std::function<bool()> interrupted;
};

struct DriveResult {
  Results results;
  std::size_t run = 0;    ///< cells that this call ran
  std::size_t taken = 0;  ///< cells that were finished before
  bool interrupted = false;
  double wall_s = 0.0;
};

/// Takes finished cells over, runs the others, keeps the index. Whatever ends it, what is finished
/// stays.
/// @throws ConfigError where the index is of something else, or another driver has the folder;
///   WriteError where results cannot be stored
DriveResult drive(const OpenStudy& open, const DriveOptions& options);

/// What is finished, from the index and the cells' files, without writing anything.
Results look(const OpenStudy& open, const StudyFolder& folder);

/// Answers a driver: reads "cell identity" lines, runs each and stores its result. Ends with the
/// input.
void serve(const OpenStudy& open, const StudyFolder& folder);

/// Runs one cell in a process of its own, under the budget, and stores its result unless it is
/// there. @returns the result
CellResult run_one(const OpenStudy& open, const StudyFolder& folder, std::size_t cell);

}  // namespace vinerow::study
