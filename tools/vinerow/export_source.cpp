#include "tools/vinerow/export_source.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::tools {
namespace {

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

}  // namespace

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

void note_undecoded(const ExportArguments& arguments, const std::string& topic,
                    const TopicSource& source, std::uint64_t undecoded) {
  if (undecoded == 0) return;
  fmt::print(stderr,
             "vinerow: {}: {} messages of topic '{}' are not of type {} and were left out\n",
             arguments.log.string(), undecoded, topic, source.schema->name);
}

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

}  // namespace vinerow::tools
