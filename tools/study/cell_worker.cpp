#include "tools/study/cell_worker.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <thread>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/study/cost_meter.h"
#include "tools/study/numbers.h"
#include "tools/study/store.h"
#include "tools/study/worker_pool.h"

namespace vinerow::study {
namespace {

namespace fs = std::filesystem;

/// Folder of a run that has not ended: ".000012-1a2b3c4d.<host>.<process>".
fs::path work_folder(const fs::path& kept) {
  return kept.parent_path() /
         fmt::format(".{}.{}.{}", kept.filename().string(), host_name(), getpid());
}

/// Runs a cell and stores its result, and the run's files if they are to be kept.
void run_and_store(const OpenStudy& open, const StudyFolder& folder, std::size_t cell,
                   const std::shared_ptr<RunShelf>& shelf) {
  const std::string identity = open.identity.of(cell);
  const scenario::KeepRuns keep = open.study.keep;
  const fs::path kept = folder.kept(cell, identity);
  fs::path work;
  if (keep != scenario::KeepRuns::kNothing) {
    work = work_folder(kept);
    io::make_folder(work);
  }
  CostMeter meter;
  CellResult result =
      run_cell(open.source, open.design.overrides(cell), open.registry, shelf, keep, work);
  result.cost = meter.cost();
  if (!work.empty()) {
    std::error_code error;
    fs::remove_all(kept, error);
    if (leaves_files(keep, result.state)) {
      fs::rename(work, kept, error);
    } else {
      fs::remove_all(work, error);
    }
  }
  // Last: the cell file marks the cell as complete.
  CellFiles(folder.cells).put(identity, result);
}

}  // namespace

fs::path StudyFolder::kept(std::size_t cell, const std::string& identity) const {
  return kept() / fmt::format("{:06}-{}", cell, identity.substr(0, 8));
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

bool leaves_files(scenario::KeepRuns keep, CellState state) {
  const bool has_run = has_numbers(state) || state == CellState::kBrokenOff;
  if (keep == scenario::KeepRuns::kFailed) return has_run && state != CellState::kMet;
  return keep != scenario::KeepRuns::kNothing && has_run;
}

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

void serve(const OpenStudy& open, const StudyFolder& folder) {
  // The study's other workers have the other cores.
  const ShareOfCores share(std::max(1u, std::thread::hardware_concurrency()));
  // Output of parts must not mix with the answers.
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

void run_cells(const OpenStudy& open, const StudyFolder& folder,
               const std::vector<std::size_t>& cells, int jobs, const DescribeCell& report) {
  const CellFiles files(folder.cells);
  WorkerPool pool(worker_command(open, folder), jobs, open.study.budget);
  auto next = cells.begin();
  const auto give_all = [&] {
    while (pool.has_free_slot() && next != cells.end()) {
      const std::size_t cell = *next++;
      const std::string identity = open.identity.of(cell);
      if (const auto found = files.find(identity)) {
        report(cell, *found);
      } else {
        pool.give(cell, identity);
      }
    }
    return pool.is_busy();
  };
  while (give_all()) {
    for (const EndedCell& ended : pool.wait(1.0)) {
      if (ended.how == EndedCell::How::kNotStored) throw WriteError(ended.words);
      const std::string identity = open.identity.of(ended.cell);
      if (ended.how != EndedCell::How::kStored) files.put(identity, result_of_end(ended));
      report(ended.cell, files.find(identity).value());
    }
  }
}

void remove_leftovers(const StudyFolder& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.kept(), error)) {
    const std::string name = entry.path().filename().string();
    const std::string middle = fmt::format(".{}.", host_name());
    const std::size_t at = name.find(middle);
    if (name.front() != '.' || at == std::string::npos) continue;
    const auto process = static_cast<pid_t>(number_in(name.substr(at + middle.size())).value_or(0));
    const bool is_alive = process > 0 && (kill(process, 0) == 0 || errno == EPERM);
    if (process > 0 && !is_alive) fs::remove_all(entry.path(), error);
  }
}

}  // namespace vinerow::study
