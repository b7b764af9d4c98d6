#include <fmt/format.h>

#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "tools/vinerow/parts_page.h"
#include "tools/vinerow/reference_pages.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {

void add_docs_command(CLI::App& app, int& exit_status) {
  auto folder = std::make_shared<std::filesystem::path>("docs/reference");
  CLI::App* command = app.add_subcommand(
      "docs", "write the reference pages: parts, metrics, signals, messages, command line");
  command->add_option("--out", *folder, "folder of the pages")->capture_default_str();
  command->callback([&app, folder, &exit_status] {
    const Registry registry = make_registry({});
    io::make_folder(*folder);
    const std::pair<const char*, std::string> pages[] = {
        {"parts.md", parts_page(registry)},     {"metrics.md", metrics_page(registry)},
        {"signals.md", signals_page(registry)}, {"messages.md", messages_page()},
        {"cli.md", command_line_page(app)},
    };
    for (const auto& [name, text] : pages) {
      write_whole_file(*folder / name, text);
      fmt::print("{}\n", (*folder / name).string());
    }
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
