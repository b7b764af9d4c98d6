#pragma once
/// Slurm by its own commands: sbatch, squeue, sacct, scancel, scontrol.

#include <filesystem>
#include <string>
#include <vector>

namespace vinerow::study::slurm {

/// @throws ConfigError where Slurm's commands are absent
void demand_commands();

/// Tasks of one array at most (MaxArraySize); 1001, Slurm's own default, where it does not say.
std::size_t most_tasks();

/// A job array; its tasks are numbered from 0.
struct Submission {
  std::string name;
  std::filesystem::path script;
  std::filesystem::path logs;  ///< folder: <task>.log
  std::size_t tasks = 1;
  double time_limit_s = 0.0;         ///< of a task; 0: the partition's
  std::vector<std::string> options;  ///< the user's, of sbatch; they win over ours
};

struct Submitted {
  std::string job;        ///< its number; empty where Slurm refused it
  std::string complaint;  ///< why
};
/// @throws WriteError where sbatch does not start
Submitted submit(const Submission& submission);

struct Task {
  std::string job;  ///< number of the array
  std::string name;
  std::size_t index = 0;
  std::string state;   ///< "RUNNING"
  std::string reason;  ///< why it waits or failed: "Resources", "NonZeroExitCode"; may be empty

  bool is_running() const;
  /// It will not run again.
  bool has_ended() const;
};

struct Queue {
  std::vector<Task> tasks;  ///< that Slurm remembers: it forgets what ended minutes ago
  std::string complaint;    ///< why there is no answer; empty: there is
};
/// Tasks of the jobs of these names. @throws WriteError where squeue does not start
Queue queue_of(const std::vector<std::string>& names);

/// State of a task that the queue has forgotten: "TIMEOUT"; empty where there is no accounting.
std::string state_in_accounting(const std::string& job, std::size_t index);

/// Whether a task that has this state will not run again.
bool is_end(const std::string& state);

/// Ends the tasks of these jobs that wait or run.
void cancel(const std::vector<std::string>& jobs);

}  // namespace vinerow::study::slurm
