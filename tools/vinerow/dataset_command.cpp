#include <fmt/format.h>

#include "engine/run/run.h"
#include "tools/dataset/make_dataset.h"
#include "tools/terminal/interrupt.h"
#include "tools/terminal/progress_line.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

struct DatasetArguments {
  std::filesystem::path file, out;
  bool quiet = false;
};

void print_dataset(const dataset::DatasetReport& report, const std::filesystem::path& out) {
  using dataset::Split;
  fmt::print("data set {}: {} pictures for training, {} for validation, {} for tests\n",
             out.string(), report.pictures(Split::kTrain), report.pictures(Split::kValidation),
             report.pictures(Split::kTest));
  std::map<std::string, int> things;
  for (const auto& part : report.things) {
    for (const auto& [name, count] : part) things[name] += count;
  }
  std::string words;
  for (const auto& [name, count] : things) {
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", name, count);
  }
  fmt::print("things   {}\n", words.empty() ? "none" : words);
  for (const std::string& note : report.notes) fmt::print("note     {}\n", note);
  int failed = 0;
  for (const dataset::CellReport& cell : report.cells) failed += cell.failure.empty() ? 0 : 1;
  if (failed > 0) {
    constexpr int kShown = 3;
    fmt::print("broke off {} of {} runs\n", failed, report.cells.size());
    int shown = 0;
    for (const dataset::CellReport& cell : report.cells) {
      if (cell.failure.empty() || shown++ >= kShown) continue;
      fmt::print("         run {}: {}\n", cell.cell, cell.failure);
    }
  }
  fmt::print("card     {}\n", (out / "README.md").string());
}

run::RunStatus make(const DatasetArguments& arguments) {
  const study::OpenStudy open(arguments.file);
  const std::filesystem::path out =
      arguments.out.empty() ? std::filesystem::path("datasets") / open.study.name : arguments.out;
  ProgressLine line(arguments.quiet);
  watch_for_interrupt();
  const auto report = dataset::make_dataset(open, out, [&](int done, int most) {
    line.count("drawing pictures", done, most);
    return !is_interrupted();
  });
  line.end();
  if (!report) {
    fmt::print(stderr, "vinerow: interrupted: no data set is kept\n");
    return run::RunStatus::kBrokenOff;
  }
  print_dataset(*report, out);
  for (const dataset::CellReport& cell : report->cells) {
    if (!cell.failure.empty()) return run::RunStatus::kBrokenOff;
  }
  return run::RunStatus::kAllMet;
}

}  // namespace

void add_dataset_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<DatasetArguments>();
  CLI::App* command = app.add_subcommand(
      "dataset",
      "labelled pictures for training from a study's runs: COCO, YOLO, KITTI, depth, poses, card");
  command->add_option("study", arguments->file, "study file (YAML) with the key 'dataset'")
      ->required();
  command->add_option("--out", arguments->out, "folder to create (default: datasets/<study name>)");
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->callback(
      [arguments, &exit_status] { exit_status = static_cast<int>(make(*arguments)); });
}

}  // namespace vinerow::tools
