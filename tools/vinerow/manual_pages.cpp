#include "tools/vinerow/manual_pages.h"

#include <fmt/format.h>

#include <string_view>

#include "engine/run/summary.h"
#include "tools/vinerow/reference_pages.h"

namespace vinerow::tools {
namespace {

/// Text without commands of roff: "-" would become a hyphen that nobody can paste into a shell.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool starts_line = out.empty() || out.back() == '\n';
    if (starts_line && (c == '.' || c == '\'')) out += "\\&";
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '"':
        out += "\\(dq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string sentence(std::string_view description) {
  std::string text = roff(description);
  // A first word like camera_trigger is a name.
  const bool is_name = text.substr(0, text.find(' ')).find('_') != std::string::npos;
  if (!is_name && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text + (text.ends_with('.') ? "\n" : ".\n");
}

std::string title(const std::string& name) {
  std::string upper;
  for (const char c : name) upper += c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  return fmt::format(
      ".\\\" Written by 'vinerow docs --man'; do not edit it by hand.\n"
      ".TH {} 1 \"\" \"vinerow {}\" \"Vinerow manual\"\n",
      roff(upper), run::program_version());
}

std::string synopsis(const CLI::App& command, const std::string& words) {
  std::string line = fmt::format(".B {}\n[\\fIoptions\\fR]", roff(words));
  if (!command.get_subcommands(nullptr).empty()) return line + " \\fIcommand\\fR ...\n";
  for (const ShownOption& option : shown_options(command)) {
    if (!option.is_argument) continue;
    const std::string name = fmt::format("\\fI{}\\fR", roff(option.name));
    line += option.is_required ? " " + name : " [" + name + "]";
  }
  return line + "\n";
}

std::string option_list(const CLI::App& command) {
  std::string list;
  for (const ShownOption& option : shown_options(command)) {
    std::string tag = option.is_argument ? fmt::format("\\fI{}\\fR", roff(option.name))
                                         : fmt::format("\\fB{}\\fR", roff(option.name));
    if (!option.value.empty() && !option.is_argument) tag += " " + roff(option.value);
    list += fmt::format(".TP\n{}\n{}", tag, sentence(option.description));
    if (!option.default_value.empty()) {
      list += fmt::format("Default: {}.\n", roff(option.default_value));
    }
  }
  return list;
}

/// Sections of the help's footer: blocks "Title:" with indented lines, or "Title: text".
std::string footer_sections(std::string_view footer) {
  std::string sections;
  while (!footer.empty()) {
    const std::string_view block = footer.substr(0, footer.find("\n\n"));
    footer.remove_prefix(std::min(block.size() + 2, footer.size()));
    const std::size_t colon = block.find(':');
    if (colon == std::string_view::npos) continue;
    std::string_view rest = block.substr(colon + 1);
    while (rest.ends_with('\n')) rest.remove_suffix(1);
    if (rest.starts_with("\n")) {
      sections += fmt::format(".SH EXAMPLES\n.nf\n{}\n.fi\n", roff(rest.substr(1)));
    } else {
      sections += fmt::format(".SH EXIT STATUS\n{}", sentence(rest.substr(1)));
    }
  }
  return sections;
}

std::string page_of_command(const CLI::App& command) {
  const std::string name = command.get_name(), words = "vinerow " + name;
  std::string page = title("vinerow-" + name);
  page += fmt::format(".SH NAME\nvinerow\\-{} \\- {}\n.SH SYNOPSIS\n", name,
                      roff(command.get_description()));
  const auto actions = command.get_subcommands(nullptr);
  page += synopsis(command, words);
  if (const std::string list = option_list(command); !list.empty()) page += ".SH OPTIONS\n" + list;
  if (!actions.empty()) page += ".SH COMMANDS\n";
  for (const CLI::App* action : actions) {
    const std::string action_words = words + " " + action->get_name();
    page +=
        fmt::format(".SS {}\n{}.PP\n{}{}", roff(action_words), sentence(action->get_description()),
                    synopsis(*action, action_words), option_list(*action));
  }
  return page + footer_sections(command.get_footer()) + ".SH SEE ALSO\n.BR vinerow (1)\n";
}

std::string page_of_program(const CLI::App& app) {
  // "Vinerow: simulation of ..."
  const std::string description = app.get_description();
  const std::string does = description.substr(description.find(": ") + 2);
  std::string page = title("vinerow") + fmt::format(".SH NAME\nvinerow \\- {}\n", roff(does));
  page += ".SH SYNOPSIS\n" + synopsis(app, "vinerow") + ".SH OPTIONS\n" + option_list(app);
  page += ".SH COMMANDS\n";
  std::string group;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_group() != group) {
      group = command->get_group();
      page += fmt::format(".SS {}\n", roff(group));
    }
    page += fmt::format(".TP\n.BR vinerow\\-{} (1)\n{}", command->get_name(),
                        sentence(command->get_description()));
  }
  page += footer_sections(app.get_footer());
  page +=
      ".SH FILES\n.TP\n.I share/vinerow/assets\nScenarios, studies, vehicles and sensors.\n"
      "A path that starts with\n.I assets/\nand does not exist in the current folder is searched "
      "there.\n.TP\n.I share/doc/vinerow/docs\nDocumentation;\n.I docs/index.md\nlists its "
      "pages.\n";
  return page;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> manual_pages(const CLI::App& app) {
  std::vector<std::pair<std::string, std::string>> pages = {{"vinerow.1", page_of_program(app)}};
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    pages.emplace_back("vinerow-" + command->get_name() + ".1", page_of_command(*command));
  }
  return pages;
}

}  // namespace vinerow::tools
