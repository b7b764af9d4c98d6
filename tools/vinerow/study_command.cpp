#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/run/run.h"
#include "tools/report/plot_files.h"
#include "tools/study/cell_worker.h"
#include "tools/study/drive.h"
#include "tools/study/plots/plot_style.h"
#include "tools/study/study_page.h"
#include "tools/study/submitted_job.h"
#include "tools/study/tables.h"
#include "tools/terminal/colour.h"
#include "tools/terminal/interrupt.h"
#include "tools/terminal/progress_line.h"
#include "tools/vinerow/number_checks.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

using study::CellState;
using study::OpenStudy;
using study::Results;

struct StudyArguments {
  std::filesystem::path file, out, cells;
  int jobs = 0;
  bool fresh = false, retry = false, quiet = false, serve = false;
  std::string runner = "local";
  study::SlurmOptions slurm;
  std::vector<std::size_t> numbers;  ///< cell numbers
  std::filesystem::path chunks;
  std::size_t task = 0;
  std::string expected, state;

  study::StudyFolder folder(const OpenStudy& open) const {
    study::StudyFolder folder;
    folder.out = out.empty() ? std::filesystem::path("runs") / open.study.name : out;
    folder.cells = cells.empty() ? folder.out / "cells" : cells;
    return folder;
  }
};

CLI::App* add_action(CLI::App& study, const char* name, const char* words,
                     const std::shared_ptr<StudyArguments>& arguments) {
  CLI::App* action = study.add_subcommand(name, words);
  action->add_option("study", arguments->file, "study file (YAML)")->required();
  action->add_option("--out", arguments->out,
                     "folder for index, tables and kept runs (default: runs/<study name>)");
  action->add_option("--cells", arguments->cells,
                     "folder for finished cells, may be shared by studies (default: <out>/cells)");
  return action;
}

/// Exit status of a study: that of its worst cell.
run::RunStatus status_of(const Results& results) {
  const auto counts = results.counts();
  const auto count = [&](CellState state) {
    const auto found = counts.find(state);
    return found == counts.end() ? std::size_t{0} : found->second;
  };
  if (count(CellState::kBrokenOff) + count(CellState::kCrashed) + count(CellState::kOutOfTime) +
          count(CellState::kOutOfMemory) + count(CellState::kInvalid) + count(CellState::kWaiting) >
      0) {
    return run::RunStatus::kBrokenOff;
  }
  return count(CellState::kNotMet) > 0 ? run::RunStatus::kCriterionFailed : run::RunStatus::kAllMet;
}

Colour state_colour(CellState state) {
  if (state == CellState::kMet) return Colour::kGood;
  if (state == CellState::kWaiting || state == CellState::kNotNeeded) return Colour::kPlain;
  return Colour::kBad;
}

/// Prints the number of cells in each state, and the first cells of each kind of failure with their
/// reasons.
void print_counts(const OpenStudy& open, const Results& results) {
  fmt::print("study    {}: {} settings x {} seeds = {} cells\n", open.study.name,
             open.design.settings(), open.design.seeds(), open.design.cells());
  for (const auto& [state, count] : results.counts()) {
    fmt::print("{} {:7}\n", coloured(fmt::format("{:13}", to_string(state)), state_colour(state)),
               count);
    if (state == CellState::kMet || !study::is_finished(state)) continue;
    constexpr std::size_t kShown = 3;
    std::size_t shown = 0;
    for (std::size_t cell = 0; cell < open.design.cells() && shown < kShown; ++cell) {
      if (results.state(cell) != state) continue;
      fmt::print("              cell {}: {}\n", cell, results.reason(cell));
      ++shown;
    }
  }
  if (results.seeds_change_nothing()) {
    fmt::print("note     all runs of a setting have the same digest: the seed changes nothing\n");
  }
}

/// Exit status of a cell, as `vinerow run` returns it.
int exit_status_of(CellState state) {
  if (state == CellState::kMet) return 0;
  if (state == CellState::kNotMet) return 1;
  return state == CellState::kInvalid ? 2 : 3;
}

void check_cell(const OpenStudy& open, std::size_t cell) {
  if (cell < open.design.cells()) return;
  throw ConfigError(fmt::format("there is no cell {}, the study has cells 0 to {}", cell,
                                open.design.cells() - 1));
}

void write_report(const OpenStudy& open, const Results& results, const study::StudyFolder& folder) {
  io::make_folder(folder.out);
  const std::filesystem::path file = folder.out / "study.html";
  write_whole_file(file, study_page(open, results));
  fmt::print("report   {}\n", file.string());
}

void write_tables(const Results& results, const study::StudyFolder& folder) {
  io::make_folder(folder.out);
  const std::pair<const char*, std::string> tables[] = {
      {"cells.csv", study::cells_csv(results)},
      {"settings.csv", study::settings_csv(results)},
      {"costs.csv", study::costs_csv(results)}};
  for (const auto& [name, text] : tables) {
    write_whole_file(folder.out / name, text);
    fmt::print("table    {}\n", (folder.out / name).string());
  }
}

void show_progress(ProgressLine& line, const study::StudyProgress& progress) {
  const double rate =
      progress.wall_s > 0.0 ? static_cast<double>(progress.run) / progress.wall_s : 0;
  const auto left =
      static_cast<double>(progress.total - std::min(progress.finished, progress.total));
  std::string detail =
      fmt::format("{} of {} cells, {} failed", progress.finished, progress.total, progress.failed);
  if (rate > 0.0) detail += fmt::format(", {:.3g} cells/s, {:.0f} s left", rate, left / rate);
  if (!progress.runner.empty()) detail += "; " + progress.runner;
  const double total = static_cast<double>(std::max<std::size_t>(progress.total, 1));
  line.show("running", static_cast<double>(progress.finished) / total, detail);
}

void run_study(const StudyArguments& arguments, bool must_be_there, int& exit_status) {
  const OpenStudy open(arguments.file);
  study::DriveOptions options;
  options.folder = arguments.folder(open);
  std::error_code error;
  if (must_be_there && !std::filesystem::exists(options.folder.index(), error)) {
    throw ConfigError(
        fmt::format("'{}' does not exist: there is nothing to resume; 'vinerow study "
                    "run {}' starts the study",
                    options.folder.index().string(), arguments.file.string()));
  }
  check_study(open);
  options.jobs = arguments.jobs > 0
                     ? arguments.jobs
                     : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const study::SlurmOptions& slurm = arguments.slurm;
  if (arguments.runner == "slurm") {
    options.slurm = slurm;
  } else if (!slurm.sbatch.empty() || slurm.chunk > 0 || slurm.patience_s > 0.0 || slurm.detach) {
    throw ConfigError("--sbatch, --chunk, --patience and --detach need '--runner slurm'");
  }
  options.fresh = arguments.fresh;
  options.retry = arguments.retry;
  ProgressLine line(arguments.quiet);
  options.progress = [&line](const study::StudyProgress& p) { show_progress(line, p); };
  options.interrupted = is_interrupted;
  watch_for_interrupt();
  const study::DriveResult result = study::drive(open, options);
  line.end();
  print_counts(open, result.results);
  fmt::print("run      {} cells in {:.1f} s, {} were already finished\n", result.run, result.wall_s,
             result.finished_before);
  if (result.detached) {
    fmt::print("detached {}\n'vinerow study resume {} --runner slurm' collects the results\n",
               result.runner, arguments.file.string());
    exit_status = 0;
    return;
  }
  write_tables(result.results, options.folder);
  write_report(open, result.results, options.folder);
  if (result.interrupted) {
    fmt::print(
        stderr,
        "vinerow: interrupted: finished cells are kept; 'vinerow study resume {}' continues\n",
        arguments.file.string());
  }
  exit_status = static_cast<int>(status_of(result.results));
}

void add_slurm_options(CLI::App& action, StudyArguments& arguments) {
  action
      .add_option("--runner", arguments.runner,
                  "where the cells run: local or slurm (default: local)")
      ->group("On a cluster (Slurm)")
      ->check(CLI::IsMember({"local", "slurm"}));
  study::SlurmOptions& slurm = arguments.slurm;
  action.add_option("--chunk", slurm.chunk, "cells per Slurm task (default: enough for 200 tasks)")
      ->check(positive())
      ->group("On a cluster (Slurm)");
  action
      .add_option("--sbatch", slurm.sbatch,
                  "option for sbatch, e.g. --sbatch=--partition=long (may be given several times)")
      ->allow_extra_args(false)
      ->group("On a cluster (Slurm)");
  action
      .add_option("--patience", slurm.patience_s,
                  "give up after this many seconds without a running task (default: wait)")
      ->check(positive())
      ->group("On a cluster (Slurm)");
  action.add_flag("--detach", slurm.detach, "exit once the tasks are submitted")
      ->group("On a cluster (Slurm)");
}

/// Runs cells that an external driver names, by their numbers or as a task of a job array.
void run_named_cells(const StudyArguments& arguments, const OpenStudy& open, int& exit_status) {
  const study::StudyFolder folder = arguments.folder(open);
  const bool is_task = !arguments.chunks.empty();
  if (!arguments.expected.empty() && arguments.expected != open.identity.whole()) {
    throw ConfigError(
        fmt::format("'{}', a file it names or the program has changed since the job was "
                    "submitted",
                    open.study.file.string()));
  }
  const std::vector<std::size_t> cells =
      is_task ? study::read_chunk(arguments.chunks, arguments.task) : arguments.numbers;
  for (const std::size_t cell : cells) check_cell(open, cell);
  int worst = 0;
  study::run_cells(open, folder, cells, std::max(arguments.jobs, 1),
                   [&worst](std::size_t cell, const study::CellResult& result) {
                     fmt::print("cell {}: {}{}{}\n", cell, to_string(result.state),
                                result.reason.empty() ? "" : ": ", result.reason);
                     std::fflush(stdout);
                     worst = std::max(worst, exit_status_of(result.state));
                   });
  // A task succeeds if all results are stored.
  exit_status = is_task ? 0 : worst;
}

}  // namespace

void add_study_command(CLI::App& app, int& exit_status) {
  CLI::App* study = app.add_subcommand(
      "study", "run a scenario many times with varied values and seeds, and tabulate the results");
  study->require_subcommand(1);
  auto arguments = std::make_shared<StudyArguments>();
  for (const bool resumes : {false, true}) {
    CLI::App* action =
        resumes ? add_action(*study, "resume", "continue a study", arguments)
                : add_action(*study, "run", "run the cells that are not finished", arguments);
    action
        ->add_option("--jobs", arguments->jobs, "number of parallel cells (default: one per core)")
        ->check(positive());
    if (!resumes) {
      action->add_flag("--fresh", arguments->fresh,
                       "start a new index; results of unchanged cells are reused");
    }
    action->add_flag("--retry", arguments->retry,
                     "rerun cells that crashed or exceeded their budget");
    action->add_flag("--quiet", arguments->quiet, "show no progress");
    add_slurm_options(*action, *arguments);
    action->callback(
        [arguments, resumes, &exit_status] { run_study(*arguments, resumes, exit_status); });
  }
  add_action(*study, "check", "check the study and the files it names; run nothing", arguments)
      ->callback([arguments, &exit_status] {
        const OpenStudy open(arguments->file);
        check_study(open);
        fmt::print("study    {}: {} settings x {} seeds = {} cells\n", open.study.name,
                   open.design.settings(), open.design.seeds(), open.design.cells());
        exit_status = 0;
      });
  add_action(*study, "status", "print how many cells are finished, failed, waiting", arguments)
      ->callback([arguments, &exit_status] {
        const OpenStudy open(arguments->file);
        const Results results = look(open, arguments->folder(open));
        print_counts(open, results);
        exit_status = static_cast<int>(status_of(results));
      });
  add_action(*study, "table", "write cells.csv, settings.csv and costs.csv", arguments)
      ->callback([arguments, &exit_status] {
        const OpenStudy open(arguments->file);
        const study::StudyFolder folder = arguments->folder(open);
        const Results results = look(open, folder);
        write_tables(results, folder);
        exit_status = static_cast<int>(status_of(results));
      });
  add_action(*study, "report", "write study.html: outcome, plots, effects, differences", arguments)
      ->callback([arguments, &exit_status] {
        const OpenStudy open(arguments->file);
        const study::StudyFolder folder = arguments->folder(open);
        const Results results = look(open, folder);
        write_tables(results, folder);
        write_report(open, results, folder);
        exit_status = static_cast<int>(status_of(results));
      });
  add_action(*study, "plot", "write the plots of the report as SVG files into <out>/plots",
             arguments)
      ->callback([arguments, &exit_status] {
        const OpenStudy open(arguments->file);
        const study::StudyFolder folder = arguments->folder(open);
        io::make_folder(folder.out / "plots");
        const std::string page = study_page(open, look(open, folder));
        for (const PlotFile& plot : plot_files_of(page, study::study_plot_style())) {
          write_whole_file(folder.out / "plots" / plot.name, plot.svg);
          fmt::print("plot     {}\n", (folder.out / "plots" / plot.name).string());
        }
        exit_status = 0;
      });
  CLI::App* list = add_action(*study, "list", "print the numbers of cells", arguments);
  list->add_option("--state", arguments->state,
                   "only cells in this state, e.g. waiting (default: all)");
  list->callback([arguments, &exit_status] {
    const OpenStudy open(arguments->file);
    const bool all = arguments->state.empty();
    const CellState state = all ? CellState::kWaiting : study::cell_state_of(arguments->state);
    const Results results = look(open, arguments->folder(open));
    for (std::size_t cell = 0; cell < open.design.cells(); ++cell) {
      if (all || results.state(cell) == state) fmt::print("{}\n", cell);
    }
    exit_status = 0;
  });
  CLI::App* cell =
      add_action(*study, "cell", "run one or several cells and store their results", arguments);
  CLI::Option* numbers =
      cell->add_option("number", arguments->numbers, "cell numbers, from 0")->expected(1, -1);
  cell->add_option("--jobs", arguments->jobs, "number of parallel cells (default: 1)")
      ->check(positive());
  cell->add_flag("--serve", arguments->serve, "run cells named by a driver")->group("");
  CLI::Option* chunks =
      cell->add_option("--chunks", arguments->chunks, "file that lists the cells of each task")
          ->group("");
  cell->add_option("--task", arguments->task, "line of the file of --chunks, from 0")->group("");
  cell->add_option("--expect", arguments->expected, "digest of the study")->group("");
  cell->callback([arguments, numbers, chunks, &exit_status] {
    const OpenStudy open(arguments->file);
    exit_status = 0;
    if (arguments->serve) return serve(open, arguments->folder(open));
    if (numbers->count() == 0 && chunks->count() == 0) {
      throw ConfigError("a cell number must be given");
    }
    run_named_cells(*arguments, open, exit_status);
  });
  CLI::App* repeat = add_action(
      *study, "repeat",
      "run one cell as 'vinerow run' does, with log, pictures and report in <out>/repeat/<cell>",
      arguments);
  repeat->add_option("number", arguments->numbers, "cell number, from 0")->required()->expected(1);
  repeat->add_flag("--quiet", arguments->quiet, "show no progress");
  repeat->callback([arguments, &exit_status] {
    const OpenStudy open(arguments->file);
    const std::size_t number = arguments->numbers.front();
    check_cell(open, number);
    RunChoice choice;
    choice.out = arguments->folder(open).out / "repeat" / std::to_string(number);
    choice.quiet = arguments->quiet;
    const scenario::Scenario scenario =
        open.source.load(open.registry, open.design.overrides(number));
    exit_status = static_cast<int>(run_and_report(scenario, open.registry, choice));
  });
}

}  // namespace vinerow::tools
