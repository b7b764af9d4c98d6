#pragma once
/// Runner that submits cells as Slurm job arrays. A task runs a chunk of cells, one after the
/// other, and stores each. Stored cells stay however a task ends; the others are submitted again.

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
  std::size_t chunk = 0;            ///< cells per task; 0: enough for 200 tasks
  double patience_s = 0.0;          ///< time without a running task until giving up; 0: wait
  bool detach = false;              ///< exit once the tasks are submitted
};

class SlurmRunner final : public CellRunner {
 public:
  /// Adopts tasks that an earlier driver left running; cancels those of another version of the
  /// study.
  /// @param open  outlives the runner
  /// @throws ConfigError if there is no Slurm, or it does not answer
  SlurmRunner(const OpenStudy& open, const StudyFolder& folder, const SlurmOptions& options);
  /// Cancels the tasks unless detached.
  ~SlurmRunner() override;

  bool has_free_slot() const override { return true; }
  bool is_busy() const override { return !pending_.empty() || !live_.empty(); }
  void give(std::size_t cell, const std::string& identity) override;
  /// @throws ConfigError if Slurm refuses the first job; WriteError if the patience is exceeded
  std::vector<EndedCell> wait(double longest_s) override;
  std::string status() const override { return status_; }
  bool is_detached() const override { return options_.detach && submitted_ && pending_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;
  using TaskName = std::pair<std::string, std::size_t>;  ///< name of the job, task

  struct LiveTask {
    std::string job;  ///< number of the array
    std::filesystem::path folder;
    Chunk cells;                ///< given cells that have not ended
    Clock::time_point ended{};  ///< time at which Slurm reported its end
    std::string state, reason;  ///< at its end
  };

  void adopt();
  std::vector<Chunk> take_chunks();
  void submit();
  void poll(std::vector<EndedCell>& ended);
  void collect(LiveTask& task, std::vector<EndedCell>& ended);
  void note_end(const TaskName& name, LiveTask& task, const slurm::Task* reported);
  void give_back(const TaskName& name, LiveTask& task, std::vector<EndedCell>& ended);
  void check_patience();
  void forget(const TaskName& name);
  std::vector<std::string> live_names() const;
  std::vector<std::string> live_jobs() const;

  const OpenStudy& open_;
  StudyFolder folder_;
  SlurmOptions options_;
  CellFiles cells_;
  std::size_t max_tasks_;
  std::vector<std::size_t> pending_;  ///< in order of submission
  std::map<TaskName, LiveTask> live_;
  std::map<std::size_t, TaskName> adopted_;  ///< by cell
  std::set<std::filesystem::path> kept_;     ///< folders of failed jobs, kept for their logs
  std::map<std::size_t, int> failures_;      ///< failed tasks by the cell at which they stopped
  int barren_tasks_ = 0;                     ///< tasks that failed without a result
  bool submitted_ = false, any_stored_ = false;
  Clock::time_point started_ = Clock::now(), next_poll_ = started_, next_submit_ = started_,
                    last_sign_ = started_;
  std::string status_;
};

}  // namespace vinerow::study
