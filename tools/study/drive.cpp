#include "tools/study/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/run/folder_lock.h"
#include "tools/study/cell_worker.h"
#include "tools/study/slurm_runner.h"
#include "tools/study/stop_judge.h"
#include "tools/study/store.h"
#include "tools/study/worker_pool.h"

namespace vinerow::study {
namespace {

using Clock = std::chrono::steady_clock;

bool is_worth_a_retry(CellState state) {
  return state == CellState::kCrashed || state == CellState::kOutOfTime ||
         state == CellState::kOutOfMemory;
}

/// Selects the next cells and collects their results.
class Driver {
 public:
  Driver(const OpenStudy& open, const DriveOptions& options)
      : open_(open),
        options_(options),
        cells_(options.folder.cells),
        index_(options.folder.index(), open.design, open.identity,
               options.fresh ? Index::Access::kRestart : Index::Access::kWrite),
        results_(open.design),
        judge_(results_),
        issued_(open.design.settings(), 0) {}

  DriveResult run() {
    take_over();
    const std::unique_ptr<CellRunner> runner = make_runner();
    Clock::time_point committed = start_;
    report_progress(*runner);
    while (give_all(*runner)) {
      constexpr double kLook_s = 0.2;  // time until Ctrl-C is noticed
      const std::vector<EndedCell> ended = runner->wait(kLook_s);
      give_all(*runner);  // before anything else, so that no worker idles
      for (const EndedCell& cell : ended) take(cell);
      if (runner->is_detached()) {
        detached_ = true;
        break;
      }
      if (options_.interrupted && options_.interrupted()) {
        interrupted_ = true;
        break;
      }
      if (Clock::now() - committed > std::chrono::seconds(1)) {
        index_.commit();
        committed = Clock::now();
      }
      report_progress(*runner);
    }
    if (!interrupted_ && !detached_) remove_unneeded();
    index_.commit();
    report_progress(*runner);
    return {std::move(results_), run_,     finished_before_, interrupted_,
            detached_,           wall_s(), runner->status()};
  }

 private:
  std::unique_ptr<CellRunner> make_runner() const {
    if (options_.slurm) {
      return std::make_unique<SlurmRunner>(open_, options_.folder, *options_.slurm);
    }
    return std::make_unique<WorkerPool>(worker_command(open_, options_.folder), options_.jobs,
                                        open_.study.budget);
  }

  double wall_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /// Whether the cell is finished and has the files that it should leave.
  bool is_complete(std::size_t cell) const {
    const CellState state = results_.state(cell);
    if (!is_finished(state) || (options_.retry && is_worth_a_retry(state))) return false;
    return !leaves_files(open_.study.keep, state) ||
           std::filesystem::exists(options_.folder.kept(cell, open_.identity.of(cell)));
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
        ++finished_before_;
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

  /// Further cells of a setting that the stop rule needs now and that are not complete.
  std::vector<std::size_t> issue(std::size_t setting) {
    std::vector<std::size_t> cells;
    // Complete cells can make the rule need more.
    while (issued_[setting] < judge_.wanted(setting)) {
      const std::size_t cell = open_.design.cell_of(setting, issued_[setting]++);
      ++wanted_;
      if (!is_complete(cell)) cells.push_back(cell);
    }
    return cells;
  }

  /// Gives cells to idle workers. @returns whether any worker is busy
  bool give_all(CellRunner& runner) {
    while (runner.has_free_slot() && !ready_.empty()) {
      runner.give(ready_.front(), open_.identity.of(ready_.front()));
      ready_.pop_front();
    }
    return runner.is_busy();
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
    // Put first: the setting's world is already built.
    const std::vector<std::size_t> more = issue(open_.design.setting_of(ended.cell));
    ready_.insert(ready_.begin(), more.begin(), more.end());
  }

  /// Removes cells that the current rule does not need, so that the table is independent of cells
  /// run under an earlier rule.
  void remove_unneeded() {
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

  void report_progress(const CellRunner& runner) const {
    if (options_.progress) {
      options_.progress(
          {finished_before_ + run_, failed_, wanted_, run_, wall_s(), runner.status()});
    }
  }

  const OpenStudy& open_;
  const DriveOptions& options_;
  CellFiles cells_;
  Index index_;
  Results results_;
  StopJudge judge_;
  std::vector<std::size_t> issued_;  ///< by setting: number of its seeds already considered
  std::deque<std::size_t> ready_;
  Clock::time_point start_ = Clock::now();
  std::size_t run_ = 0, finished_before_ = 0, failed_ = 0, wanted_ = 0;
  bool interrupted_ = false, detached_ = false;
};

}  // namespace

DriveResult drive(const OpenStudy& open, const DriveOptions& options) {
  io::make_folder(options.folder.out);
  const run::FolderLock lock(options.folder.out);
  remove_leftovers(options.folder);
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

}  // namespace vinerow::study
