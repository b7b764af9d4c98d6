#pragma once
/// Runs the cells of a study that are not finished yet.

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
  std::size_t finished = 0;  ///< before and by this call
  std::size_t failed = 0;    ///< of them: what did not run to its end
  std::size_t total = 0;     ///< cells, as far as they are needed
  std::size_t run = 0;       ///< by this call
  double wall_s = 0.0;       ///< of this call
  std::string runner;        ///< what the runner says of itself; may be empty
};

struct DriveOptions {
  StudyFolder folder;
  int jobs = 1;                       ///< cells at a time on this machine
  std::optional<SlurmOptions> slurm;  ///< set: the cells run there
  bool fresh = false;                 ///< begin a new index
  bool retry = false;                 ///< run cells again that crashed or went over their budget
  std::function<void(const StudyProgress&)> progress;
  std::function<bool()> interrupted;
};

struct DriveResult {
  Results results;
  std::size_t run = 0;    ///< cells that this call ran
  std::size_t taken = 0;  ///< cells that were finished before
  bool interrupted = false;
  bool detached = false;  ///< the cells go on without this process
  double wall_s = 0.0;
  std::string runner;  ///< what the runner said at last
};

/// Takes finished cells over, runs the others, keeps the index. Whatever ends it, what is finished
/// stays.
/// @throws ConfigError where the index is of something else, or another driver has the folder;
///   WriteError where results cannot be stored
DriveResult drive(const OpenStudy& open, const DriveOptions& options);

/// What is finished, from the index and the cells' files, without writing anything.
Results look(const OpenStudy& open, const StudyFolder& folder);

}  // namespace vinerow::study
