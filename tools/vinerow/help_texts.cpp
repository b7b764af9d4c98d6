#include "tools/vinerow/help_texts.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "engine/core/check.h"

namespace vinerow::tools {
namespace {

struct HelpText {
  std::string_view command;
  const char* group;
  std::string_view examples;  ///< one per line, without "vinerow"
  std::string_view statuses;  ///< "": the usual ones
};

constexpr const char* kSimulate = "Simulate";
constexpr const char* kLook = "Look at a run";
constexpr const char* kTables = "Numbers of runs and maps";
constexpr const char* kSurvey = "Surveys and maps";
constexpr const char* kParts = "Parts and files";

constexpr std::string_view kUsualStatuses =
    "0 done, 2 bad input (the message names place and fault), 3 broke off or output not written";

constexpr std::array kHelpTexts = {
    HelpText{"run", kSimulate,
             "run assets/scenarios/riseholme_rover.yaml --out runs/x\n"
             "run my.yaml --set rover.controller.speed_mps=0.8 --seed 3 --no-pictures",
             "0 all criteria met, 1 a criterion or a phase failed or a vehicle crashed, 2 bad "
             "input, 3 the simulation broke off or output was not written"},
    HelpText{"validate", kSimulate, "validate my.yaml\nvalidate my.yaml --files-only",
             "0 valid, 2 not valid (the message names place and fault)"},
    HelpText{"study", kSimulate,
             "study run my_study.yaml --jobs 8\nstudy table my_study.yaml\n"
             "study list my_study.yaml --state waiting",
             "0 all cells met their criteria, 1 some did not, 2 bad input, 3 some did not run to "
             "the end or output was not written"},
    HelpText{"dataset", kSimulate,
             "dataset assets/studies/vineyard_dataset.yaml --out datasets/vines",
             "0 done, 2 bad input, 3 some runs broke off, or output was not written"},
    HelpText{"report", kLook, "report runs/x\nreport runs/x --out page.html", ""},
    HelpText{"replay", kLook, "replay runs/x --out replay.html", ""},
    HelpText{"render", kLook,
             "render runs/x --camera chase --every 5\n"
             "render runs/x --camera kind=top,height_m=60 --from 100 --to 200 --every 10",
             ""},
    HelpText{"video", kLook,
             "video runs/x -o drive.mp4 --from 60 --to 90\n"
             "video runs/x -o fast.mp4 --camera kind=chase,vehicle=rover,distance_m=4 --speed 8",
             ""},
    HelpText{"coverage", kLook, "coverage runs/survey --out coverage.png", ""},
    HelpText{"info", kTables, "info runs/x/log.mcap", ""},
    HelpText{"export", kTables,
             "export runs/x --topic /rover/follower -o follower.csv\n"
             "export runs/x --topic '/rover/*' --npz -o arrays\n"
             "export runs/x --topic /rover/lidar -o drive.ply\n"
             "export runs/x --topic /rover/lidar -o drive.las --crs EPSG:32632",
             ""},
    HelpText{"compare", kTables,
             "compare runs/before runs/after --fail-on regression\n"
             "compare maps/may maps/august --geojson growth.geojson",
             "0 done, 1 a difference that --fail-on selects, 2 bad input"},
    HelpText{"survey", kSurvey,
             "survey assets/scenarios/survey_still.yaml --out plans\n"
             "survey --log runs/map_parcel --pictures --picture-width 1368 --out photos\n"
             "survey assets/scenarios/survey_still.yaml --pictures --bands red,nir --out ndvi\n"
             "survey --polygon field.geojson --dem dem.tif --height_m 60 --rotorcraft",
             ""},
    HelpText{"cloud", kSurvey, "cloud assets/scenarios/map_parcel.yaml --out parcel.las", ""},
    HelpText{"map", kSurvey, "map parcel.las --out maps/parcel", ""},
    HelpText{"grid", kSurvey, "grid assets/scenarios/vineyard_4ws_two_rows.yaml --out maps/grid",
             ""},
    HelpText{"trim", kParts, "trim assets/vehicles/mh900_like.yaml --json", ""},
    HelpText{"list", kParts, "list\nlist controller\nlist pure_pursuit", ""},
    HelpText{"schema", kParts, "schema > vinerow.schema.json", ""},
    HelpText{"docs", kParts, "docs --out docs/reference", ""},
    HelpText{"completion", kParts,
             "completion bash > ~/.local/share/bash-completion/completions/vinerow", ""},
};

/// Footer of a command's help: "Examples:", the example lines, and the exit statuses.
std::string footer_of(const HelpText& text) {
  std::string footer = "Examples:\n";
  for (std::string_view rest = text.examples; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    footer += fmt::format("  vinerow {}\n", line);
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  return footer +
         fmt::format("\nExit status: {}\n", text.statuses.empty() ? kUsualStatuses : text.statuses);
}

}  // namespace

void add_help_texts(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    const HelpText* found = nullptr;
    for (const HelpText& text : kHelpTexts) {
      if (text.command == command->get_name()) found = &text;
    }
    VINEROW_DEMAND(found);
    command->group(found->group);
    command->footer(footer_of(*found));
  }
  app.footer(
      fmt::format("Start with:\n  vinerow run assets/scenarios/riseholme_rover.yaml --out runs/x\n"
                  "  vinerow COMMAND --help\n\nExit status: {}; 'run' returns 1 if a criterion or "
                  "phase failed\n",
                  kUsualStatuses));
}

}  // namespace vinerow::tools
