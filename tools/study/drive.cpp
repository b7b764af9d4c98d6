#include "tools/study/drive.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <iostream>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/output_folder.h"
#include "engine/sim/folder_lock.h"
#include "tools/study/cost_meter.h"
#include "tools/study/stop_judge.h"
#include "tools/study/store.h"
#include "tools/study/worker_pool.h"

namespace vinerow::study {
namespace {

using Clock = std::chrono::steady_clock;

/// The result of a cell whose worker could not tell it.
CellResult result_of_end(const EndedCell& ended) {
  CellResult result;
  result.state = ended.how == EndedCell::How::kOutOfTime     ? CellState::kOutOfTime
                 : ended.how == EndedCell::How::kOutOfMemory ? CellState::kOutOfMemory
                                                             : CellState::kCrashed;
  result.reason = ended.words;
  result.cost.wall_s = ended.wall_s;
  result.cost.host = host_name();
  return result;
}

bool is_worth_a_retry(CellState state) {
  return state == CellState::kCrashed || state == CellState::kOutOfTime ||
         state == CellState::kOutOfMemory;
}

std::vector<std::string> worker_command(const OpenStudy& open, const StudyFolder& folder) {
  return {"vinerow",
          "study",
          "cell",
          open.study.file.string(),
          "--serve",
          "--out",
          folder.out.string(),
          "--cells",
          folder.cells.string()};
}

/// Whether a run of this state leaves its files.
bool leaves_files(io::KeepRuns keep, CellState state) {
  const bool has_run = has_numbers(state) || state == CellState::kBrokenOff;
  if (keep == io::KeepRuns::kFailed) return has_run && state != CellState::kMet;
  return keep != io::KeepRuns::kNothing && has_run;
}

/// Where a cell's files stay. Cells may be counted otherwise after a change of the study.
std::filesystem::path kept_folder(const StudyFolder& folder, std::size_t cell,
                                  const std::string& identity) {
  return folder.kept() / fmt::format("{:06}-{}", cell, identity.substr(0, 8));
}

/// Decides which cell is next, and takes what comes back.
class Driver {
 public:
  Driver(const OpenStudy& open, const DriveOptions& options)
      : open_(open),
        options_(options),
        cells_(options.folder.cells),
        index_(options.folder.index(), open.design, open.identity,
               options.fresh ? Index::Access::kAnew : Index::Access::kWrite),
        results_(open.design),
        judge_(results_),
        issued_(open.design.settings(), 0) {}

  DriveResult run() {
    take_over();
    WorkerPool pool(worker_command(open_, options_.folder), options_.jobs, open_.study.budget);
    Clock::time_point committed = start_;
    tell();
    while (give_all(pool)) {
      constexpr double kLook_s = 0.2;  // after Ctrl-C
      const std::vector<EndedCell> ended = pool.wait(kLook_s);
      give_all(pool);  // workers first: they wait
      for (const EndedCell& cell : ended) take(cell);
      if (options_.interrupted && options_.interrupted()) {
        interrupted_ = true;
        break;
      }
      if (Clock::now() - committed > std::chrono::seconds(1)) {
        index_.commit();
        committed = Clock::now();
      }
      tell();
    }
    if (!interrupted_) leave_out_what_is_not_needed();
    index_.commit();
    tell();
    return {std::move(results_), run_, taken_, interrupted_, wall_s()};
  }

 private:
  double wall_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /// Whether the cell is finished, with the files that it should leave.
  bool is_complete(std::size_t cell) const {
    const CellState state = results_.state(cell);
    if (!is_finished(state) || (options_.retry && is_worth_a_retry(state))) return false;
    return !leaves_files(open_.study.keep, state) ||
           std::filesystem::exists(kept_folder(options_.folder, cell, open_.identity.of(cell)));
  }

  void take_over() {
    index_.load(results_);
    for (std::size_t cell = 0; cell < open_.design.cells(); ++cell) {
      if (!is_finished(results_.state(cell))) {
        if (const auto found = cells_.find(open_.identity.of(cell))) {
          results_.put(cell, *found);
          index_.put(cell, *found);
        }
      }
      if (is_complete(cell)) {
        ++taken_;
        count_failure(cell);
      } else if (is_finished(results_.state(cell))) {
        cells_.remove(open_.identity.of(cell));
        results_.put(cell, {});
      }
    }
    index_.commit();
    for (const std::size_t setting : open_.design.settings_in_running_order()) {
      for (const std::size_t cell : issue(setting)) ready_.push_back(cell);
    }
  }

  /// Further cells of a setting that are wanted by now and not complete.
  std::vector<std::size_t> issue(std::size_t setting) {
    std::vector<std::size_t> cells;
    // Complete ones may make more wanted.
    while (issued_[setting] < judge_.wanted(setting)) {
      const std::size_t cell = open_.design.cell_of(setting, issued_[setting]++);
      ++wanted_;
      if (!is_complete(cell)) cells.push_back(cell);
    }
    return cells;
  }

  /// Gives cells to idle workers. @returns whether any of them works
  bool give_all(WorkerPool& pool) {
    while (pool.has_idle() && !ready_.empty()) {
      pool.give(ready_.front(), open_.identity.of(ready_.front()));
      ready_.pop_front();
    }
    return pool.is_busy();
  }

  void take(const EndedCell& ended) {
    const std::string identity = open_.identity.of(ended.cell);
    if (ended.how == EndedCell::How::kNotStored) {
      index_.commit();
      throw WriteError(ended.words);
    }
    std::optional<CellResult> result;
    if (ended.how == EndedCell::How::kStored) {
      result = cells_.find(identity);
      if (!result) {
        throw WriteError(fmt::format("'{}' has been removed while the study ran",
                                     cells_.file_of(identity).string()));
      }
    } else {
      result = result_of_end(ended);
      cells_.put(identity, *result);
    }
    results_.put(ended.cell, *result);
    index_.put(ended.cell, *result);
    ++run_;
    count_failure(ended.cell);
    // In front: the setting's world is built.
    const std::vector<std::size_t> more = issue(open_.design.setting_of(ended.cell));
    ready_.insert(ready_.begin(), more.begin(), more.end());
  }

  /// By the rule alone, whatever an earlier rule has run: the table does not depend on that.
  void leave_out_what_is_not_needed() {
    for (std::size_t setting = 0; setting < open_.design.settings(); ++setting) {
      for (std::size_t k = judge_.wanted(setting); k < open_.design.seeds(); ++k) {
        const std::size_t cell = open_.design.cell_of(setting, k);
        CellResult none;
        none.state = CellState::kNotNeeded;
        results_.put(cell, none);
        index_.put(cell, none);
      }
    }
  }

  void count_failure(std::size_t cell) {
    if (!has_numbers(results_.state(cell))) ++failed_;
  }

  void tell() const {
    if (options_.progress) {
      options_.progress({taken_ + run_, failed_, wanted_, run_, wall_s()});
    }
  }

  const OpenStudy& open_;
  const DriveOptions& options_;
  CellFiles cells_;
  Index index_;
  Results results_;
  StopJudge judge_;
  std::vector<std::size_t> issued_;  ///< by setting: so many of its seeds were looked at
  std::deque<std::size_t> ready_;
  Clock::time_point start_ = Clock::now();
  std::size_t run_ = 0, taken_ = 0, failed_ = 0, wanted_ = 0;
  bool interrupted_ = false;
};

/// Runs a cell and stores its result, and the run's files where they are to stay.
CellResult run_and_store(const OpenStudy& open, const StudyFolder& folder, std::size_t cell,
                         const std::shared_ptr<RunShelf>& shelf) {
  const std::string identity = open.identity.of(cell);
  const io::KeepRuns keep = open.study.keep;
  const std::filesystem::path kept = kept_folder(folder, cell, identity);
  std::filesystem::path work;
  if (keep != io::KeepRuns::kNothing) {
    work = folder.kept() / fmt::format(".{}.{}", kept.filename().string(), getpid());
    io::make_folder(work);
  }
  CostMeter meter;
  CellResult result =
      run_cell(open.source, open.design.overrides(cell), open.registry, shelf, keep, work);
  result.cost = meter.cost();
  if (!work.empty()) {
    std::error_code error;
    std::filesystem::remove_all(kept, error);
    if (leaves_files(keep, result.state)) {
      std::filesystem::rename(work, kept, error);
    } else {
      std::filesystem::remove_all(work, error);
    }
  }
  // Last: a cell that is there is complete.
  CellFiles(folder.cells).put(identity, result);
  return result;
}

}  // namespace

DriveResult drive(const OpenStudy& open, const DriveOptions& options) {
  io::make_folder(options.folder.out);
  const FolderLock lock(options.folder.out);
  return Driver(open, options).run();
}

Results look(const OpenStudy& open, const StudyFolder& folder) {
  Results results(open.design);
  std::error_code error;
  if (std::filesystem::exists(folder.index(), error)) {
    Index(folder.index(), open.design, open.identity, Index::Access::kRead).load(results);
  }
  const CellFiles cells(folder.cells);
  for (std::size_t cell = 0; cell < open.design.cells(); ++cell) {
    if (results.state(cell) != CellState::kWaiting) continue;
    if (const auto found = cells.find(open.identity.of(cell))) results.put(cell, *found);
  }
  return results;
}

void serve(const OpenStudy& open, const StudyFolder& folder) {
  // Whatever a part prints must not stand between the answers.
  const int answers = dup(STDOUT_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const auto shelf = std::make_shared<RunShelf>();
  std::size_t cell = 0;
  std::string identity;
  while (std::cin >> cell >> identity) {
    std::string answer = "stored";
    try {
      if (cell >= open.design.cells() || open.identity.of(cell) != identity) {
        throw ConfigError(
            fmt::format("'{}', its scenario or the program has changed while the "
                        "study ran",
                        open.study.file.string()));
      }
      run_and_store(open, folder, cell, shelf);
    } catch (const std::exception& error) {
      answer = error.what();
      std::replace(answer.begin(), answer.end(), '\n', ' ');
    }
    answer += '\n';
    if (write(answers, answer.data(), answer.size()) < 0) return;
  }
}

CellResult run_one(const OpenStudy& open, const StudyFolder& folder, std::size_t cell) {
  const CellFiles cells(folder.cells);
  const std::string identity = open.identity.of(cell);
  if (const auto found = cells.find(identity)) return *found;
  WorkerPool pool(worker_command(open, folder), 1, open.study.budget);
  pool.give(cell, identity);
  std::vector<EndedCell> ended;
  while (ended.empty()) ended = pool.wait(1.0);
  if (ended.front().how == EndedCell::How::kNotStored) throw WriteError(ended.front().words);
  if (ended.front().how != EndedCell::How::kStored)
    cells.put(identity, result_of_end(ended.front()));
  return cells.find(identity).value();
}

}  // namespace vinerow::study
