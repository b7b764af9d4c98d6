#include <fmt/format.h>

#include <algorithm>

#include "tools/vinerow/completion.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

std::vector<std::string> names_of_parts() {
  const Registry registry = make_registry({});
  std::vector<std::string> names;
  for (const PartKind kind : kAllPartKinds) {
    names.emplace_back(to_string(kind));
    for (const std::string& name : registry.names(kind)) names.push_back(name);
  }
  // Several kinds may have a part of the same name.
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

void add_completion_command(CLI::App& app, int& exit_status) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "completion", "print a script that makes a shell complete commands and options");
  command->add_option("shell", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([&app, shell, &exit_status] {
    const std::vector<std::string> parts = names_of_parts();
    fmt::print("{}", *shell == "bash"  ? bash_completion(app, parts)
                     : *shell == "zsh" ? zsh_completion(app, parts)
                                       : fish_completion(app, parts));
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
