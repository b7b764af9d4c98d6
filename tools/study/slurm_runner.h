#pragma once
/// Runs cells as job arrays of Slurm: a task runs a chunk of cells, one after the other, and stores
/// each. Whatever becomes of a task, what it has stored is there; what it has not is submitted
/// again.

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/study/cell_runner.h"
#include "tools/study/open_study.h"
#include "tools/study/slurm.h"
#include "tools/study/store.h"
#include "tools/study/study_folder.h"
#include "tools/study/submitted_job.h"

namespace vinerow::study {

struct SlurmOptions {
  std::vector<std::string> sbatch;  ///< options of sbatch: "--partition=long"
  std::size_t chunk = 0;            ///< cells of a task; 0: as many that there are 200 tasks
  double patience_s = 0.0;  ///< without any running task, until the runner gives up; 0: it waits
  bool detach = false;      ///< leave the tasks alone once they are submitted
};

class SlurmRunner final : public CellRunner {
 public:
  /// Finds the tasks that an earlier driver left running; ends those of another state of the study.
  /// @param open  outlives the runner
  /// @throws ConfigError where there is no Slurm, or it does not answer
  SlurmRunner(const OpenStudy& open, const StudyFolder& folder, const SlurmOptions& options);
  /// Ends the tasks, unless they are to go on.
  ~SlurmRunner() override;

  bool has_room() const override { return true; }
  bool is_busy() const override { return !pending_.empty() || !live_.empty(); }
  void give(std::size_t cell, const std::string& identity) override;
  /// @throws ConfigError where Slurm refuses the first job; WriteError where patience is at its end
  std::vector<EndedCell> wait(double longest_s) override;
  std::string status() const override { return status_; }
  bool is_detached() const override { return options_.detach && submitted_ && pending_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;
  using TaskName = std::pair<std::string, std::size_t>;  ///< name of the job, task

  struct LiveTask {
    std::string job;  ///< number of the array
    std::filesystem::path folder;
    Chunk cells;                ///< that were given and have not ended
    Clock::time_point ended{};  ///< set: when Slurm said so
    std::string state, reason;  ///< then
  };

  void adopt();
  std::vector<Chunk> take_chunks();
  void submit();
  void poll(std::vector<EndedCell>& ended);
  void collect(LiveTask& task, std::vector<EndedCell>& ended);
  void note_end(const TaskName& name, LiveTask& task, const slurm::Task* told);
  void give_back(const TaskName& name, LiveTask& task, std::vector<EndedCell>& ended);
  void check_patience();
  void forget(const TaskName& name);
  std::vector<std::string> live_names() const;
  std::vector<std::string> live_jobs() const;

  const OpenStudy& open_;
  StudyFolder folder_;
  SlurmOptions options_;
  CellFiles cells_;
  std::size_t most_tasks_;
  std::vector<std::size_t> pending_;  ///< in order of submission
  std::map<TaskName, LiveTask> live_;
  std::map<std::size_t, TaskName> adopted_;  ///< by cell
  std::set<std::filesystem::path> kept_;     ///< folders of jobs that failed: their logs tell why
  std::map<std::size_t, int> failures_;      ///< of tasks, by the cell that they stopped at
  int barren_tasks_ = 0;                     ///< failed without a result
  bool submitted_ = false, any_stored_ = false;
  Clock::time_point started_ = Clock::now(), next_poll_ = started_, next_submit_ = started_,
                    last_sign_ = started_;
  std::string status_;
};

}  // namespace vinerow::study
