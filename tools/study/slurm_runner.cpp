#include "tools/study/slurm_runner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/program.h"
#include "engine/core/whole_file.h"

namespace vinerow::study {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Failed tasks at a cell after which the cell is not tried again. Chosen.
constexpr int kMaxFailures = 3;
/// Failed tasks without any result after which the study stops: the fault affects all tasks.
/// Chosen.
constexpr int kMaxBarrenTasks = 3;
/// Time until files written on another machine are visible. Chosen.
constexpr auto kGrace = 60s;
/// Time in which cells are gathered, so that few jobs are submitted. Chosen.
constexpr auto kGather = 5s;
/// Time until the next submission after Slurm refused a job while others wait. Chosen.
constexpr auto kRetrySubmit = 30s;

EndedCell::How how_of(const std::string& state) {
  if (state == "TIMEOUT" || state == "DEADLINE") return EndedCell::How::kOutOfTime;
  if (state == "OUT_OF_MEMORY") return EndedCell::How::kOutOfMemory;
  return EndedCell::How::kCrashed;
}

}  // namespace

SlurmRunner::SlurmRunner(const OpenStudy& open, const StudyFolder& folder,
                         const SlurmOptions& options)
    : open_(open), folder_(folder), options_(options), cells_(folder.cells) {
  slurm::demand_commands();
  max_tasks_ = slurm::max_tasks();
  adopt();
}

SlurmRunner::~SlurmRunner() {
  if (is_detached()) return;
  try {
    slurm::cancel(live_jobs());
  } catch (const std::exception&) {
    // scancel did not start: Slurm ends the tasks at their time limit.
  }
}

void SlurmRunner::adopt() {
  const std::vector<SubmittedJob> jobs = submitted_jobs(folder_);
  std::vector<std::string> names;
  for (const SubmittedJob& job : jobs) names.push_back(job.name);
  const slurm::Queue queue = slurm::queue_of(names);
  if (!queue.complaint.empty()) {
    throw ConfigError(fmt::format("Slurm does not answer: {}", queue.complaint));
  }
  std::vector<std::string> outdated;
  for (const SubmittedJob& job : jobs) {
    bool is_alive = false;
    for (const slurm::Task& task : queue.tasks) {
      if (task.name != job.name || task.has_ended() || task.index >= job.chunks.size()) continue;
      if (job.digest != open_.identity.whole()) {
        outdated.push_back(task.job);
        continue;
      }
      is_alive = true;
      const TaskName name = {job.name, task.index};
      live_[name] = {task.job, job.folder, {}, {}, "", ""};
      for (const std::size_t cell : job.chunks[task.index]) adopted_[cell] = name;
    }
    std::error_code ignored;
    if (!is_alive) fs::remove_all(job.folder, ignored);
  }
  std::sort(outdated.begin(), outdated.end());
  outdated.erase(std::unique(outdated.begin(), outdated.end()), outdated.end());
  slurm::cancel(outdated);
}

void SlurmRunner::give(std::size_t cell, const std::string&) {
  const auto found = adopted_.find(cell);
  const auto task = found == adopted_.end() ? live_.end() : live_.find(found->second);
  if (task != live_.end() && task->second.ended == Clock::time_point{}) {
    task->second.cells.push_back(cell);
    submitted_ = true;
  } else {
    pending_.push_back(cell);
  }
}

/// Pending cells as tasks. A cell at which a task failed gets a task of its own.
std::vector<Chunk> SlurmRunner::take_chunks() {
  constexpr std::size_t kTasks = 200, kLongest = 100;
  const std::size_t length =
      options_.chunk > 0
          ? options_.chunk
          : std::clamp<std::size_t>((pending_.size() + kTasks - 1) / kTasks, 1, kLongest);
  std::vector<Chunk> chunks;
  bool open_chunk = false;
  for (const std::size_t cell : pending_) {
    const bool is_suspect = failures_.contains(cell);
    if (is_suspect || !open_chunk || chunks.back().size() >= length) chunks.emplace_back();
    chunks.back().push_back(cell);
    open_chunk = !is_suspect;
  }
  pending_.clear();
  return chunks;
}

void SlurmRunner::submit() {
  const std::vector<Chunk> chunks = take_chunks();
  for (std::size_t begin = 0; begin < chunks.size(); begin += max_tasks_) {
    const std::size_t end = std::min(begin + max_tasks_, chunks.size());
    const SubmittedJob job = prepare_job(
        open_, folder_, std::vector<Chunk>(&chunks[begin], &chunks[begin] + (end - begin)));
    slurm::Submission submission;
    submission.name = job.name;
    submission.script = job.script();
    submission.logs = job.folder;
    submission.tasks = job.chunks.size();
    submission.options = options_.sbatch;
    if (open_.study.budget.time_s > 0.0) {
      // Time for starting a task, in addition to its cells.
      constexpr double kStart_s = 300.0;
      std::size_t longest = 0;
      for (const Chunk& chunk : job.chunks) longest = std::max(longest, chunk.size());
      submission.time_limit_s = static_cast<double>(longest) * open_.study.budget.time_s + kStart_s;
    }
    const slurm::Submitted answer = slurm::submit(submission);
    if (answer.job.empty()) {
      std::error_code ignored;
      fs::remove_all(job.folder, ignored);
      if (live_.empty()) {
        throw ConfigError(fmt::format("Slurm refused the job: {}", answer.complaint));
      }
      // Slurm accepts no more for now, e.g. because of a job limit.
      for (std::size_t k = begin; k < chunks.size(); ++k) {
        pending_.insert(pending_.end(), chunks[k].begin(), chunks[k].end());
      }
      next_submit_ = Clock::now() + kRetrySubmit;
      status_ = fmt::format("Slurm accepts no more jobs: {}", answer.complaint);
      return;
    }
    for (std::size_t k = 0; k < job.chunks.size(); ++k) {
      live_[{job.name, k}] = {answer.job, job.folder, job.chunks[k], {}, "", ""};
    }
    submitted_ = true;
  }
  status_ = fmt::format("{} tasks submitted as {}", live_.size(), fmt::join(live_jobs(), ", "));
  next_submit_ = Clock::now() + kGather;
}

std::vector<std::string> SlurmRunner::live_names() const {
  std::vector<std::string> names;
  for (const auto& [name, task] : live_) {
    if (names.empty() || names.back() != name.first) names.push_back(name.first);
  }
  return names;
}

std::vector<std::string> SlurmRunner::live_jobs() const {
  std::set<std::string> jobs;
  for (const auto& [name, task] : live_) jobs.insert(task.job);
  return {jobs.begin(), jobs.end()};
}

std::vector<EndedCell> SlurmRunner::wait(double longest_s) {
  std::vector<EndedCell> ended;
  if (!pending_.empty() && (live_.empty() || Clock::now() >= next_submit_)) submit();
  if (is_detached()) return ended;
  const auto longest =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(longest_s));
  std::this_thread::sleep_for(std::clamp(next_poll_ - Clock::now(), Clock::duration{}, longest));
  if (Clock::now() < next_poll_) return ended;
  poll(ended);
  // Poll often at first, then rarely, to keep the load on Slurm's controller low.
  next_poll_ = Clock::now() + std::clamp<Clock::duration>((Clock::now() - started_) / 30, 1s, 15s);
  return ended;
}

void SlurmRunner::collect(LiveTask& task, std::vector<EndedCell>& ended) {
  std::erase_if(task.cells, [&](std::size_t cell) {
    if (!cells_.find(open_.identity.of(cell))) return false;
    ended.push_back({cell, EndedCell::How::kStored, "", 0.0});
    any_stored_ = true;
    last_sign_ = Clock::now();
    return true;
  });
}

void SlurmRunner::note_end(const TaskName& name, LiveTask& task, const slurm::Task* reported) {
  if (reported && !reported->has_ended()) return;
  if (reported) {
    task.state = reported->state;
    task.reason = reported->reason;
  } else {
    task.state = slurm::state_in_accounting(task.job, name.second);
    if (!task.state.empty() && !slurm::is_end(task.state)) return;
  }
  task.ended = Clock::now();
}

void SlurmRunner::poll(std::vector<EndedCell>& ended) {
  const slurm::Queue queue = slurm::queue_of(live_names());
  if (!queue.complaint.empty()) {
    status_ = fmt::format("Slurm does not answer: {}", queue.complaint);
    check_patience();
    return;
  }
  std::map<TaskName, const slurm::Task*> reported;
  for (const slurm::Task& task : queue.tasks) reported[{task.name, task.index}] = &task;
  std::size_t running = 0, waiting = 0;
  std::string reason;
  std::vector<TaskName> gone;
  for (auto& [name, task] : live_) {
    const auto found = reported.find(name);
    const slurm::Task* const found_task = found == reported.end() ? nullptr : found->second;
    if (task.ended == Clock::time_point{}) note_end(name, task, found_task);
    const bool has_ended = task.ended != Clock::time_point{};
    if (found_task && found_task->is_running()) {
      ++running;
      last_sign_ = Clock::now();
    } else if (!has_ended) {
      ++waiting;
      if (found_task && !found_task->reason.empty()) reason = found_task->reason;
    }
    if (has_ended || (found_task && found_task->is_running())) collect(task, ended);
    if (!has_ended) continue;
    // A completed task has stored its cells; the files are only not visible yet.
    const bool may_come = task.state == "COMPLETED" || task.state.empty();
    if (!task.cells.empty() && may_come && Clock::now() - task.ended < kGrace) continue;
    if (!task.cells.empty()) give_back(name, task, ended);
    gone.push_back(name);
  }
  for (const TaskName& name : gone) forget(name);
  status_ = fmt::format("{} tasks running, {} waiting{}", running, waiting,
                        reason.empty() ? "" : fmt::format(" ({})", reason));
  check_patience();
}

void SlurmRunner::give_back(const TaskName& name, LiveTask& task, std::vector<EndedCell>& ended) {
  const std::string last =
      last_line_of(read_bytes(task.folder / fmt::format("{}.log", name.second)).value_or(""))
          .substr(0, kLongestLine);
  const std::string words = fmt::format(
      "Slurm task {}_{} ended {}{}{}{}", task.job, name.second,
      task.state.empty() ? "without a trace" : "as " + task.state,
      task.reason.empty() ? "" : fmt::format(" ({})", task.reason), last.empty() ? "" : ": ", last);
  kept_.insert(task.folder);
  if (task.state == "CANCELLED") {
    ended.push_back({task.cells.front(), EndedCell::How::kNotStored,
                     words + "; finished cells are kept, 'vinerow study resume' continues", 0.0});
    return;
  }
  const EndedCell::How how = how_of(task.state);
  const bool is_of_cell = how != EndedCell::How::kCrashed;
  if (!any_stored_ && !is_of_cell && ++barren_tasks_ >= kMaxBarrenTasks) {
    ended.push_back(
        {task.cells.front(), EndedCell::How::kNotStored, "no task has a result: " + words, 0.0});
    return;
  }
  // The task stopped at its first cell without a result; the cells after it were not tried.
  const std::size_t suspect = task.cells.front();
  if (++failures_[suspect] >= kMaxFailures) {
    ended.push_back({suspect, how, words, 0.0});
    task.cells.erase(task.cells.begin());
  }
  pending_.insert(pending_.end(), task.cells.begin(), task.cells.end());
}

void SlurmRunner::forget(const TaskName& name) {
  const fs::path folder = live_.at(name).folder;
  live_.erase(name);
  const bool is_used = std::any_of(
      live_.begin(), live_.end(), [&](const auto& other) { return other.second.folder == folder; });
  if (is_used || kept_.contains(folder)) return;
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

void SlurmRunner::check_patience() {
  const std::chrono::duration<double> silent = Clock::now() - last_sign_;
  if (options_.patience_s <= 0.0 || silent.count() < options_.patience_s) return;
  throw WriteError(
      fmt::format("no task has run for {:.0f} s ({}); finished cells are kept, 'vinerow study "
                  "resume' continues",
                  silent.count(), status_));
}

}  // namespace vinerow::study
