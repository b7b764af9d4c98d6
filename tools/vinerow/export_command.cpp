#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/suggest.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/record/mcap_reader.h"
#include "tools/export/message_table.h"
#include "tools/export/picture_files.h"
#include "tools/export/table_files.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

struct ExportArguments {
  std::filesystem::path log, out;
  std::vector<std::string> topics;
  bool csv = false, npz = false, long_form = false;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
};

/// Topics of a log by name. A topic with several channels (several writers) is one entry.
std::map<std::string, std::vector<const record::McapChannel*>> topics_of(
    const record::McapReader& log) {
  std::map<std::string, std::vector<const record::McapChannel*>> topics;
  for (const auto& [id, channel] : log.channels()) topics[channel.topic].push_back(&channel);
  return topics;
}

/// Whether a channel only carries the fields that the standard type of another channel lacks.
bool is_exact_twin(const record::McapChannel& channel) {
  return std::any_of(channel.metadata.begin(), channel.metadata.end(),
                     [](const auto& entry) { return entry.first == "exact_of"; });
}

/// "nearest: /rover/follower, /rover/estimate; 'vinerow info x.mcap' lists all 152"
std::string topics_near(const std::string& wanted, std::vector<std::string> known,
                        const std::filesystem::path& log) {
  const std::size_t count = known.size();
  constexpr std::size_t kShown = 5;
  std::stable_sort(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return edit_distance(wanted, a) < edit_distance(wanted, b);
  });
  if (known.size() > kShown) known.resize(kShown);
  return fmt::format("nearest: {}; 'vinerow info {}' lists all {}", join(known), log.string(),
                     count);
}

struct ChosenTopic {
  std::string name;
  bool by_pattern = false;
};

std::vector<ChosenTopic> chosen_topics(const record::McapReader& log,
                                       const ExportArguments& arguments) {
  std::vector<std::string> known;
  std::vector<ChosenTopic> chosen;
  // Exact twins are exported only if named.
  std::vector<std::string> shown;
  for (const auto& [topic, channels] : topics_of(log)) {
    known.push_back(topic);
    if (!is_exact_twin(*channels.front())) shown.push_back(topic);
  }
  const auto choose = [&](const std::string& topic, bool by_pattern) {
    const bool again = std::any_of(chosen.begin(), chosen.end(),
                                   [&](const ChosenTopic& before) { return before.name == topic; });
    if (!again) chosen.push_back({topic, by_pattern});
  };
  for (const std::string& given : arguments.topics) {
    const std::string wanted =
        given.starts_with('/') || given.starts_with('*') ? given : "/" + given;
    if (std::find(known.begin(), known.end(), wanted) != known.end()) {
      choose(wanted, false);
      continue;
    }
    const std::size_t before = chosen.size();
    for (const std::string& topic : wanted.ends_with("/exact") ? known : shown) {
      if (fnmatch(wanted.c_str(), topic.c_str(), 0) == 0) choose(topic, true);
    }
    if (chosen.size() > before) continue;
    throw ConfigError(fmt::format("{}: no topic '{}' ({})", arguments.log.string(), given,
                                  topics_near(wanted, shown, arguments.log)));
  }
  return chosen;
}

struct TopicSource {
  std::set<std::uint16_t> channels;
  const record::McapSchema* schema = nullptr;
};

/// @throws ConfigError if its messages cannot be decoded, or are of two types
TopicSource source_of(const record::McapReader& log, const std::string& topic,
                      const ExportArguments& arguments) {
  const auto channels = topics_of(log).at(topic);
  TopicSource source;
  const record::McapSchema*& schema = source.schema;
  for (const record::McapChannel* channel : channels) {
    const auto found = log.schemas().find(channel->schema);
    if (channel->encoding != "cdr" || found == log.schemas().end() ||
        found->second.encoding != "ros2msg") {
      throw ConfigError(
          fmt::format("{}: topic '{}' has messages of encoding '{}', must be 'cdr' "
                      "with a definition of encoding 'ros2msg'",
                      arguments.log.string(), topic, channel->encoding));
    }
    if (schema && found->second.data != schema->data) {
      throw ConfigError(fmt::format("{}: topic '{}' has messages of two types, {} and {}",
                                    arguments.log.string(), topic, schema->name,
                                    found->second.name));
    }
    schema = &found->second;
    source.channels.insert(channel->id);
  }
  return source;
}

/// Adds the messages between --from and --to. @param out  a table, or files of pictures
template <class Out>
void add_messages(record::McapReader& log, const std::string& topic, const TopicSource& source,
                  const ExportArguments& arguments, Out& out) {
  std::uint64_t undecoded = 0;
  log.for_each_message(source.channels, [&](const record::McapMessage& message) {
    const auto stamp_ns = static_cast<std::int64_t>(message.publish_time);
    const double stamp_s = static_cast<double>(stamp_ns) / 1e9;
    if (stamp_s < arguments.from_s || stamp_s > arguments.to_s) return;
    const auto logged_ns = static_cast<std::int64_t>(message.log_time);
    undecoded += out.add(stamp_ns, logged_ns, message.data) ? 0 : 1;
  });
  if (undecoded > 0) {
    fmt::print(stderr,
               "vinerow: {}: {} messages of topic '{}' are not of type {} and were left out\n",
               arguments.log.string(), undecoded, topic, source.schema->name);
  }
}

MessageTable table_of(record::McapReader& log, const std::string& topic, const TopicSource& source,
                      const ExportArguments& arguments) {
  MessageTable table(record::RosSchema::parse(source.schema->name, source.schema->data),
                     arguments.long_form);
  add_messages(log, topic, source, arguments, table);
  return table;
}

/// Unique file stem of a topic: "rover_follower" for "/rover/follower".
std::string file_stem(const std::string& topic, std::set<std::string>& taken) {
  std::string stem;
  for (const char c : topic.substr(topic.starts_with('/') ? 1 : 0)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    stem += plain || c == '-' ? c : '_';
  }
  constexpr std::size_t kLongest = 100;
  stem = stem.empty() ? "topic" : stem.substr(0, kLongest);
  std::string name = stem;
  for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", stem, i);
  return name;
}

/// Derives the format from -o. @returns whether -o names one file
bool read_out(ExportArguments& arguments) {
  const std::string ending = lower_extension(arguments.out);
  const bool to_stdout = arguments.out == "-";
  const bool one_file = to_stdout || ending == ".csv" || ending == ".npz";
  if (ending == ".csv" && arguments.npz) {
    throw ConfigError("export: -o is a .csv file, with --npz it must be a folder or a .npz file");
  }
  if (ending == ".npz" && arguments.csv) {
    throw ConfigError("export: -o is a .npz file, with --csv it must be a folder or a .csv file");
  }
  if (to_stdout && arguments.npz) {
    throw ConfigError(
        "export: --npz cannot be printed to the terminal, -o must be a file or a folder");
  }
  // A folder of such a name is hardly what is meant.
  static const std::set<std::string> kOthers = {".h5",  ".jpg", ".json",    ".las",  ".laz",
                                                ".mat", ".npy", ".parquet", ".pcd",  ".ply",
                                                ".png", ".tsv", ".txt",     ".xlsx", ".xyz"};
  if (kOthers.contains(ending) && !std::filesystem::is_directory(arguments.out)) {
    throw ConfigError(
        fmt::format("export: -o '{}' must be a file .csv or .npz, - for the terminal, or a folder",
                    arguments.out.string()));
  }
  if (ending == ".npz") arguments.npz = true;
  if (!arguments.npz) arguments.csv = true;
  return one_file;
}

void write_table(const MessageTable& table, const std::filesystem::path& file,
                 const std::string& bytes) {
  io::make_folder_of(file);
  write_whole_file(file, bytes);
  fmt::print("{}  {} rows\n", file.string(), table.rows().size());
}

/// @throws ConfigError if no message can be between --from and --to
void check_span(const record::McapReader& log, const ExportArguments& arguments) {
  if (std::isnan(arguments.from_s) || std::isnan(arguments.to_s)) {
    throw ConfigError("export: --from and --to must be times in s");
  }
  if (arguments.from_s > arguments.to_s) {
    throw ConfigError(
        fmt::format("export: --from {} s is after --to {} s", arguments.from_s, arguments.to_s));
  }
  // A message is never logged before it is published, so this is the latest possible time.
  const double end_s = static_cast<double>(log.end_time()) / 1e9;
  if (arguments.from_s > end_s) {
    throw ConfigError(fmt::format("export: --from {} s is after the end of '{}' at {} s",
                                  arguments.from_s, arguments.log.string(), end_s));
  }
}

void export_topics(ExportArguments arguments) {
  const bool one_file = read_out(arguments);
  arguments.log = log_of(arguments.log);
  record::McapReader log(arguments.log);
  check_span(log, arguments);
  const std::vector<ChosenTopic> topics = chosen_topics(log, arguments);
  if (one_file && topics.size() > 1) {
    throw ConfigError(fmt::format("export: -o '{}' is one file for {} topics, must be a folder",
                                  arguments.out.string(), topics.size()));
  }
  const std::filesystem::path folder =
      arguments.out.empty() ? arguments.log.parent_path() / "export" : arguments.out;
  std::set<std::string> taken;
  const auto export_one = [&](const std::string& topic) {
    const TopicSource source = source_of(log, topic, arguments);
    const std::string stem = file_stem(topic, taken);
    // Pictures are files, unless arrays are requested.
    if (is_picture_type(source.schema->name) && !arguments.npz) {
      if (one_file) {
        throw ConfigError(fmt::format(
            "export: topic '{}' has pictures, -o must be a folder for them or a .npz file", topic));
      }
      PictureFiles pictures(folder / stem);
      add_messages(log, topic, source, arguments, pictures);
      fmt::print("{}  {} pictures\n", (folder / stem).string(), pictures.finish());
      return;
    }
    const MessageTable table = table_of(log, topic, source, arguments);
    const auto file = [&](const char* ending) {
      return one_file ? arguments.out : folder / (stem + ending);
    };
    if (arguments.out == "-") return fmt::print("{}", csv_of(table, topic));
    if (arguments.csv) write_table(table, file(".csv"), csv_of(table, topic));
    if (arguments.npz) write_table(table, file(".npz"), npz_of(table, topic));
  };
  for (const ChosenTopic& topic : topics) {
    try {
      export_one(topic.name);
    } catch (const TableTooLarge& error) {
      // A pattern exports every topic that can be exported.
      if (!topic.by_pattern) throw;
      fmt::print(stderr, "vinerow: left out {}\n", error.what());
    }
  }
  if (!log.complete()) {
    fmt::print(stderr, "vinerow: '{}' is cut off: what was written before is exported\n",
               arguments.log.string());
  }
  for (const std::string& warning : log.warnings()) {
    fmt::print(stderr, "vinerow: {}\n", warning);
  }
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand(
      "export", "write topics of a log as tables: CSV, or arrays for NumPy; pictures as files");
  command->add_option("log", arguments->log, "log.mcap of a run, or the run's folder")->required();
  command
      ->add_option(
          "--topic", arguments->topics,
          "this topic, or all that match a pattern: '/rover/*' (may be given several times)")
      ->required()
      ->allow_extra_args(false);
  command->add_flag("--csv", arguments->csv, "comma-separated (the default)");
  command->add_flag("--npz", arguments->npz, "NumPy arrays, for numpy.load()");
  command->add_option("-o,--out", arguments->out,
                      "file .csv or .npz, - for the terminal, or a folder (default: export next to "
                      "the log)");
  command->add_option("--from", arguments->from_s, "only messages from this simulated time on, s");
  command->add_option("--to", arguments->to_s, "only messages up to this simulated time, s");
  command->add_flag("--long", arguments->long_form,
                    "one table row per element of a message's sequences, also of numbers");
  command->callback([arguments, &exit_status] {
    export_topics(*arguments);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
