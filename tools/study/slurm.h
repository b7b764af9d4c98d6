#pragma once
/// Slurm interface through its commands sbatch, squeue, sacct, scancel, scontrol.

#include <filesystem>
#include <string>
#include <vector>

namespace vinerow::study::slurm {

/// @throws ConfigError if Slurm's commands are absent
void demand_commands();

/// Maximum number of tasks in an array (MaxArraySize); 1001, Slurm's default, if unknown.
std::size_t max_tasks();

/// Job array; its tasks are numbered from 0.
struct Submission {
  std::string name;
  std::filesystem::path script;
  std::filesystem::path logs;  ///< folder: <task>.log
  std::size_t tasks = 1;
  double time_limit_s = 0.0;         ///< limit of a task; 0: that of the partition
  std::vector<std::string> options;  ///< user's options for sbatch; they override ours
};

struct Submitted {
  std::string job;        ///< number of the job; empty if Slurm refused it
  std::string complaint;  ///< reason of a refusal
};
/// @throws WriteError if sbatch does not start
Submitted submit(const Submission& submission);

struct Task {
  std::string job;  ///< number of the array
  std::string name;
  std::size_t index = 0;
  std::string state;  ///< "RUNNING"
  std::string
      reason;  ///< reason of waiting or failure: "Resources", "NonZeroExitCode"; may be empty

  bool is_running() const;
  /// Whether it will not run again.
  bool has_ended() const;
};

struct Queue {
  std::vector<Task> tasks;  ///< known tasks; Slurm forgets tasks some minutes after their end
  std::string complaint;    ///< reason of a missing answer; empty if there is an answer
};
/// Tasks of the jobs with these names. @throws WriteError if squeue does not start
Queue queue_of(const std::vector<std::string>& names);

/// State of a task that the queue has forgotten: "TIMEOUT"; empty without accounting.
std::string state_in_accounting(const std::string& job, std::size_t index);

/// Whether a task in this state will not run again.
bool is_end(const std::string& state);

/// Cancels the waiting and running tasks of these jobs.
void cancel(const std::vector<std::string>& jobs);

}  // namespace vinerow::study::slurm
