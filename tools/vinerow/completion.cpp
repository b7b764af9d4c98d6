#include "tools/vinerow/completion.h"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "engine/core/suggest.h"
#include "tools/study/shell_word.h"

namespace vinerow::tools {
namespace {

/// Option of a command, as completion scripts need it.
struct CompletedOption {
  std::vector<std::string> names;  ///< "--out", "-o"
  std::string words;
  bool takes_value = false;
  std::vector<std::string> choices;  ///< allowed values; empty: any value
};

struct CompletedCommand {
  std::string name, words;  ///< name of an action: "study run"
  std::vector<CompletedOption> options;
  std::vector<std::string> choices;  ///< allowed values of its arguments
  std::string shipped;               ///< folder of installed files for its argument: "scenarios"
  std::vector<std::string> actions;  ///< "run", "resume" of "study": its first argument
};

/// Allowed values of an option: "bash", "zsh" for "TEXT:{bash,zsh}"; empty if the parser has no
/// list.
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find(":{"), close = type.rfind('}');
  std::vector<std::string> choices;
  if (open == std::string::npos || close == std::string::npos || close <= open + 2) return choices;
  std::string rest = type.substr(open + 2, close - open - 2);
  for (std::size_t at = 0; at <= rest.size();) {
    const std::size_t comma = std::min(rest.find(',', at), rest.size());
    choices.push_back(rest.substr(at, comma - at));
    at = comma + 1;
  }
  return choices;
}

std::vector<CompletedOption> options_of(const CLI::App& app) {
  std::vector<CompletedOption> options;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) continue;
    CompletedOption one;
    for (const std::string& name : option->get_lnames()) one.names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) one.names.push_back("-" + name);
    one.words = option->get_description();
    one.takes_value = option->get_items_expected_max() > 0;
    one.choices = choices_of(*option);
    options.push_back(std::move(one));
  }
  return options;
}

CompletedCommand command_of(const CLI::App& command, const std::string& name,
                            const std::vector<CompletedOption>& common) {
  static const std::map<std::string, std::string> kShipped = {
      {"scenario", "scenarios"}, {"study", "studies"}, {"vehicle", "vehicles"}};
  CompletedCommand one{name, command.get_description(), options_of(command), {}, {}, {}};
  one.options.insert(one.options.end(), common.begin(), common.end());
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    one.choices = choices_of(*option);
    const auto shipped = kShipped.find(option->get_name(true));
    if (shipped != kShipped.end()) one.shipped = shipped->second;
  }
  return one;
}

/// All commands, each followed by its actions.
std::vector<CompletedCommand> commands_of(const CLI::App& app,
                                          const std::vector<std::string>& parts) {
  std::vector<CompletedCommand> commands;
  // Options of the program itself may also follow a command.
  std::vector<CompletedOption> common;
  for (CompletedOption& option : options_of(app)) {
    if (option.takes_value) common.push_back(std::move(option));
  }
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    const std::string name = command->get_name();
    CompletedCommand one = command_of(*command, name, common);
    if (name == "list") one.choices = parts;
    std::vector<CompletedCommand> actions;
    for (const CLI::App* action : command->get_subcommands(nullptr)) {
      one.actions.push_back(action->get_name());
      actions.push_back(command_of(*action, name + " " + action->get_name(), common));
    }
    commands.push_back(std::move(one));
    for (CompletedCommand& action : actions) commands.push_back(std::move(action));
  }
  return commands;
}

bool is_action(const CompletedCommand& command) {
  return command.name.find(' ') != std::string::npos;
}

std::string names_of(const std::vector<CompletedOption>& options) {
  std::string names;
  for (const CompletedOption& option : options) {
    for (const std::string& name : option.names) names += (names.empty() ? "" : " ") + name;
  }
  return names;
}

std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

/// Description, escaped for zsh's option[description]:message:action.
std::string zsh_words(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string bash_completion(const CLI::App& app, const std::vector<std::string>& parts) {
  std::string commands, with_actions, options_by_command, values;
  for (const CompletedCommand& command : commands_of(app, parts)) {
    if (!is_action(command)) commands += command.name + " ";
    if (!command.actions.empty()) with_actions += command.name + " ";
    const auto& words = command.actions.empty() ? command.choices : command.actions;
    options_by_command += fmt::format("    '{}') options={} words={} shipped='{}' ;;\n",
                                      command.name, study::shell_quoted(names_of(command.options)),
                                      study::shell_quoted(join(words, " ")), command.shipped);
    for (const CompletedOption& option : command.options) {
      if (!option.takes_value) continue;
      for (const std::string& name : option.names) {
        values += fmt::format("    '{} {}') valued=1 words={} ;;\n", command.name, name,
                              study::shell_quoted(join(option.choices, " ")));
      }
    }
  }
  return fmt::format(R"script(# Completion of vinerow for bash, made by 'vinerow completion bash'.
_vinerow() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}"
  local command='' options='' words='' shipped='' valued='' i
  for ((i = 1; i < COMP_CWORD; i++)); do
    if [[ "${{COMP_WORDS[i]}}" != -* ]]; then command="${{COMP_WORDS[i]}}"; break; fi
  done
  if [[ -z "$command" ]]; then
    COMPREPLY=($(compgen -W {} -- "$current"))
    return
  fi
  if [[ {} == *" $command "* ]]; then
    for ((i++; i < COMP_CWORD; i++)); do
      if [[ "${{COMP_WORDS[i]}}" != -* ]]; then command+=" ${{COMP_WORDS[i]}}"; break; fi
    done
  fi
  case "$command" in
{}    *) return ;;
  esac
  case "$command $before" in
{}  esac
  if [[ "$current" == -* && -z "$valued" ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  elif [[ -n "$words" ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  else
    compopt -o filenames 2>/dev/null
    local IFS=$'\n' folder
    COMPREPLY=($(compgen -f -- "$current"))
    if [[ -n "$shipped" && -z "$valued" && ! -e assets ]]; then
      folder="$(type -P vinerow)"
      folder="${{folder%/bin/*}}/share/vinerow"
      COMPREPLY+=($(cd "$folder" 2>/dev/null && compgen -G "assets/$shipped/*.yaml" \
        | while read -r i; do [[ "$i" == "$current"* ]] && printf '%s\n' "$i"; done))
    fi
  fi
}}
complete -F _vinerow vinerow
)script",
                     study::shell_quoted(commands + names_of(options_of(app))),
                     study::shell_quoted(" " + with_actions), options_by_command, values);
}

std::string zsh_completion(const CLI::App& app, const std::vector<std::string>& parts) {
  std::string commands, with_actions, cases;
  for (const CompletedCommand& command : commands_of(app, parts)) {
    if (!command.actions.empty()) with_actions += command.name + " ";
    if (!is_action(command)) {
      commands += fmt::format(
          "    {}\n", study::shell_quoted(fmt::format("{}:{}", command.name, command.words)));
    }
    cases += fmt::format("    {})\n      _arguments", study::shell_quoted(command.name));
    for (const CompletedOption& option : command.options) {
      for (const std::string& name : option.names) {
        std::string spec = fmt::format("*{}[{}]", name, zsh_words(option.words));
        if (!option.choices.empty()) {
          spec += fmt::format(":value:({})", join(option.choices, " "));
        } else if (option.takes_value) {
          spec += ":value:_files";
        }
        cases += " \\\n        " + study::shell_quoted(spec);
      }
    }
    const auto& words = command.actions.empty() ? command.choices : command.actions;
    const std::string argument =
        words.empty() ? "*:file:_files" : fmt::format("*:value:({})", join(words, " "));
    cases += " \\\n        " + study::shell_quoted(argument) + " ;;\n";
  }
  return fmt::format(R"script(#compdef vinerow
# Completion of vinerow for zsh, made by 'vinerow completion zsh'.
_vinerow() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command="$words[2]"
  shift words
  (( CURRENT-- ))
  if [[ {} == *" $command "* ]] && (( CURRENT > 2 )); then
    command="$command $words[2]"
    shift words
    (( CURRENT-- ))
  fi
  case "$command" in
{}  esac
}}
if [[ "$funcstack[1]" == _vinerow ]]; then
  _vinerow "$@"  # loaded by the completion of the first word
else
  compdef _vinerow vinerow
fi
)script",
                     commands, study::shell_quoted(" " + with_actions), cases);
}

std::string fish_completion(const CLI::App& app, const std::vector<std::string>& parts) {
  std::string script =
      "# Completion of vinerow for fish, made by 'vinerow completion fish'.\n"
      "complete -c vinerow -n __fish_use_subcommand -f\n";
  for (const CompletedCommand& command : commands_of(app, parts)) {
    std::string here = "__fish_seen_subcommand_from " + command.name;
    const std::size_t space = command.name.find(' ');
    if (!is_action(command)) {
      script += fmt::format("complete -c vinerow -n __fish_use_subcommand -a {} -d {}\n",
                            command.name, fish_quoted(command.words));
    } else {
      here = fmt::format("__fish_seen_subcommand_from {}; and __fish_seen_subcommand_from {}",
                         command.name.substr(0, space), command.name.substr(space + 1));
    }
    if (!command.actions.empty()) {
      here += "; and not __fish_seen_subcommand_from " + join(command.actions, " ");
      script += fmt::format("complete -c vinerow -n {} -f -a {}\n", fish_quoted(here),
                            fish_quoted(join(command.actions, " ")));
    }
    here = fish_quoted(here);
    if (!command.choices.empty()) {
      script += fmt::format("complete -c vinerow -n {} -f -a {}\n", here,
                            fish_quoted(join(command.choices, " ")));
    }
    for (const CompletedOption& option : command.options) {
      script += fmt::format("complete -c vinerow -n {}", here);
      for (const std::string& name : option.names) {
        script += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (option.takes_value) script += " -r";
      if (!option.choices.empty()) script += " -f -a " + fish_quoted(join(option.choices, " "));
      script += " -d " + fish_quoted(option.words) + "\n";
    }
  }
  return script;
}

}  // namespace vinerow::tools
