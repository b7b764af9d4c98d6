/// The command `vinerow` with its sub-commands; help_texts.cpp lists them.

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/plain_zeros.h"
#include "engine/run/summary.h"
#include "tools/terminal/colour.h"
#include "tools/vinerow/help_texts.h"
#include "tools/vinerow/subcommands.h"

namespace {

constexpr int kBadInput = 2;
constexpr int kBrokenOff = 3;

/// Rejects a misspelt command. The parser would only report that a command is missing.
void check_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands(nullptr)) known.push_back(command->get_name());
  if (word.starts_with('-') || std::find(known.begin(), known.end(), word) != known.end()) return;
  throw vinerow::ConfigError(fmt::format("unknown command '{}'{} (known: {})", word,
                                         vinerow::did_you_mean(word, known), vinerow::join(known)));
}

void add_colour_option(CLI::App& app) {
  using vinerow::tools::ColourMode;
  static const std::map<std::string, ColourMode> kModes = {
      {"auto", ColourMode::kAuto}, {"always", ColourMode::kAlways}, {"never", ColourMode::kNever}};
  app.add_option_function<std::string>(
         "--color",
         [](const std::string& mode) { vinerow::tools::set_colour_mode(kModes.at(mode)); },
         "coloured output; auto: on a terminal, unless NO_COLOR is set")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->default_str("auto")
      ->trigger_on_parse();
  // The option may also follow a command.
  for (CLI::App* command : app.get_subcommands(nullptr)) command->fallthrough();
}

}  // namespace

int main(int argc, char** argv) {
  // Beyond a file size limit a write fails and is reported; the signal would end the program.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"Vinerow: simulation of robots that work in vineyards and orchards"};
  app.set_version_flag("--version", "vinerow " + vinerow::run::program_version());
  app.require_subcommand(1);
  int exit_status = 0;
  // Order of groups and commands in the help.
  vinerow::tools::add_run_command(app, exit_status);
  vinerow::tools::add_validate_command(app, exit_status);
  vinerow::tools::add_study_command(app, exit_status);
  vinerow::tools::add_dataset_command(app, exit_status);
  vinerow::tools::add_report_command(app, exit_status);
  vinerow::tools::add_replay_command(app, exit_status);
  vinerow::tools::add_render_command(app, exit_status);
  vinerow::tools::add_video_command(app, exit_status);
  vinerow::tools::add_coverage_command(app, exit_status);
  vinerow::tools::add_info_command(app, exit_status);
  vinerow::tools::add_export_command(app, exit_status);
  vinerow::tools::add_compare_command(app, exit_status);
  vinerow::tools::add_survey_command(app, exit_status);
  vinerow::tools::add_cloud_command(app, exit_status);
  vinerow::tools::add_map_command(app, exit_status);
  vinerow::tools::add_grid_command(app, exit_status);
  vinerow::tools::add_trim_command(app, exit_status);
  vinerow::tools::add_list_command(app, exit_status);
  vinerow::tools::add_schema_command(app, exit_status);
  vinerow::tools::add_docs_command(app, exit_status);
  vinerow::tools::add_completion_command(app, exit_status);
  vinerow::tools::add_help_texts(app);
  add_colour_option(app);
  try {
    std::vector<char*> words(argv, argv + argc);
    std::string help = "--help";
    if (argc > 1 && std::string_view(argv[1]) == "help") {
      // "help run" is "run --help".
      words.erase(words.begin() + 1);
      words.push_back(help.data());
    }
    if (words.size() > 1) check_command(app, words[1]);
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help, version
    const std::vector<CLI::App*> given = app.get_subcommands();
    fmt::print(stderr, "vinerow: {}; see 'vinerow {}--help'\n", error.what(),
               given.empty() ? "" : given.front()->get_name() + " ");
    return kBadInput;
  } catch (const vinerow::ConfigError& error) {
    fmt::print(stderr, "vinerow: {}\n", vinerow::io::plain_zeros(error.what()));
    return kBadInput;
  } catch (const vinerow::WriteError& error) {
    fmt::print(stderr, "vinerow: {}\n", vinerow::io::plain_zeros(error.what()));
    return kBrokenOff;
  } catch (const vinerow::SimulationError& error) {
    fmt::print(stderr, "vinerow: {}\n", vinerow::io::plain_zeros(error.what()));
    return kBrokenOff;
  } catch (const std::exception& error) {
    fmt::print(stderr, "vinerow: unexpected failure: {}\n", error.what());
    return kBrokenOff;
  }
  return exit_status;
}
