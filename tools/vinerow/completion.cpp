#include "tools/vinerow/completion.h"

#include <fmt/format.h>

#include <vector>

#include "engine/core/suggest.h"

namespace vinerow::tools {
namespace {

/// One option of a command, as shells want it.
struct CompletedOption {
  std::vector<std::string> names;  ///< "--out", "-o"
  std::string words;
  bool takes_value = false;
  std::vector<std::string> choices;  ///< of its value; empty: anything
};

struct CompletedCommand {
  std::string name, words;
  std::vector<CompletedOption> options;
  std::vector<std::string> choices;  ///< of its arguments
};

/// "bash", "zsh" of "TEXT:{bash,zsh}", where the parser says which values there are.
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

std::vector<CompletedCommand> commands_of(const CLI::App& app) {
  std::vector<CompletedCommand> commands;
  // Those of the program itself may stand behind a command too.
  std::vector<CompletedOption> common;
  for (CompletedOption& option : options_of(app)) {
    if (option.takes_value) common.push_back(std::move(option));
  }
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    CompletedCommand one{command->get_name(), command->get_description(), options_of(*command), {}};
    one.options.insert(one.options.end(), common.begin(), common.end());
    for (const CLI::Option* option : command->get_options()) {
      if (option->get_positional()) one.choices = choices_of(*option);
    }
    commands.push_back(std::move(one));
  }
  return commands;
}

std::string names_of(const std::vector<CompletedOption>& options) {
  std::string names;
  for (const CompletedOption& option : options) {
    for (const std::string& name : option.names) names += (names.empty() ? "" : " ") + name;
  }
  return names;
}

/// Between single quotes of a POSIX shell.
std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

/// A description inside zsh's option[description]:message:action.
std::string zsh_words(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string commands, options_by_command, values;
  for (const CompletedCommand& command : commands_of(app)) {
    commands += command.name + " ";
    options_by_command += fmt::format("    {}) options={} words={} ;;\n", command.name,
                                      shell_quoted(names_of(command.options)),
                                      shell_quoted(join(command.choices, " ")));
    for (const CompletedOption& option : command.options) {
      if (!option.takes_value) continue;
      for (const std::string& name : option.names) {
        values += fmt::format("    '{} {}') valued=1 words={} ;;\n", command.name, name,
                              shell_quoted(join(option.choices, " ")));
      }
    }
  }
  return fmt::format(R"script(# Completion of vinerow for bash, made by 'vinerow completion bash'.
_vinerow() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}"
  local command='' options='' words='' valued='' i
  for ((i = 1; i < COMP_CWORD; i++)); do
    if [[ "${{COMP_WORDS[i]}}" != -* ]]; then command="${{COMP_WORDS[i]}}"; break; fi
  done
  if [[ -z "$command" ]]; then
    COMPREPLY=($(compgen -W {} -- "$current"))
    return
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
    local IFS=$'\n'
    COMPREPLY=($(compgen -f -- "$current"))
  fi
}}
complete -F _vinerow vinerow
)script",
                     shell_quoted(commands + names_of(options_of(app))), options_by_command,
                     values);
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CompletedCommand& command : commands_of(app)) {
    commands +=
        fmt::format("    {}\n", shell_quoted(fmt::format("{}:{}", command.name, command.words)));
    cases += fmt::format("    {})\n      _arguments", command.name);
    for (const CompletedOption& option : command.options) {
      for (const std::string& name : option.names) {
        std::string spec = fmt::format("*{}[{}]", name, zsh_words(option.words));
        if (!option.choices.empty()) {
          spec += fmt::format(":value:({})", join(option.choices, " "));
        } else if (option.takes_value) {
          spec += ":value:_files";
        }
        cases += " \\\n        " + shell_quoted(spec);
      }
    }
    const std::string argument = command.choices.empty()
                                     ? "*:file:_files"
                                     : fmt::format("*:value:({})", join(command.choices, " "));
    cases += " \\\n        " + shell_quoted(argument) + " ;;\n";
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
  case "$command" in
{}  esac
}}
compdef _vinerow vinerow
)script",
                     commands, cases);
}

std::string fish_completion(const CLI::App& app) {
  std::string script =
      "# Completion of vinerow for fish, made by 'vinerow completion fish'.\n"
      "complete -c vinerow -n __fish_use_subcommand -f\n";
  for (const CompletedCommand& command : commands_of(app)) {
    script += fmt::format("complete -c vinerow -n __fish_use_subcommand -a {} -d {}\n",
                          command.name, fish_quoted(command.words));
    const std::string here = fish_quoted("__fish_seen_subcommand_from " + command.name);
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
