#include <fmt/format.h>

#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/vinerow/manual_pages.h"
#include "tools/vinerow/parts_page.h"
#include "tools/vinerow/reference_pages.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {

namespace {

using Pages = std::vector<std::pair<std::string, std::string>>;  // name of a file, text

Pages all_reference_pages(const CLI::App& app) {
  const Registry registry = make_registry({});
  return {
      {"parts.md", parts_page(registry)},     {"metrics.md", metrics_page(registry)},
      {"signals.md", signals_page(registry)}, {"messages.md", messages_page()},
      {"cli.md", command_line_page(app)},
  };
}

}  // namespace

void add_docs_command(CLI::App& app, int& exit_status) {
  auto folder = std::make_shared<std::filesystem::path>("docs/reference");
  CLI::App* command = app.add_subcommand(
      "docs", "write the reference pages: parts, metrics, signals, messages, command line");
  command->add_option("--out", *folder, "folder of the pages")->capture_default_str();
  auto manual = std::make_shared<bool>(false);
  command->add_flag("--man", *manual,
                    "write the manual pages vinerow(1), vinerow-run(1), ... instead");
  command->callback([&app, folder, manual, &exit_status] {
    const Pages pages = *manual ? manual_pages(app) : all_reference_pages(app);
    io::make_folder(*folder);
    for (const auto& [name, text] : pages) {
      write_whole_file(*folder / name, text);
      fmt::print("{}\n", (*folder / name).string());
    }
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
