#pragma once
/// Driver of a study: runs the cells that are not finished.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "tools/study/open_study.h"
#include "tools/study/results.h"
#include "tools/study/slurm_runner.h"
#include "tools/study/study_folder.h"

namespace vinerow::study {

struct StudyProgress {
  std::size_t finished = 0;  ///< cells finished before and by this call
  std::size_t failed = 0;    ///< of these, cells that did not run to the end
  std::size_t total = 0;     ///< needed cells
  std::size_t run = 0;       ///< cells run by this call
  double wall_s = 0.0;       ///< wall time of this call
  std::string runner;        ///< status of the runner; may be empty
};

struct DriveOptions {
  StudyFolder folder;
  int jobs = 1;                       ///< number of parallel cells on this machine
  std::optional<SlurmOptions> slurm;  ///< if set, the cells run on Slurm
  bool fresh = false;                 ///< start a new index
  bool retry = false;                 ///< rerun cells that crashed or exceeded their budget
  std::function<void(const StudyProgress&)> progress;
  std::function<bool()> interrupted;
};

struct DriveResult {
  Results results;
  std::size_t run = 0;              ///< cells run by this call
  std::size_t finished_before = 0;  ///< cells finished before
  bool interrupted = false;
  bool detached = false;  ///< the cells continue without this process
  double wall_s = 0.0;
  std::string runner;  ///< last status of the runner
};

/// Reuses finished cells, runs the others, and maintains the index. Finished cells stay however the
/// call ends.
/// @throws ConfigError if the index belongs to another study, or another driver uses the folder;
///   WriteError if results cannot be stored
DriveResult drive(const OpenStudy& open, const DriveOptions& options);

/// Finished cells, from the index and the cell files. Writes nothing.
Results look(const OpenStudy& open, const StudyFolder& folder);

}  // namespace vinerow::study
