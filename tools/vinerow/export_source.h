#pragma once
/// Choice of a log's topics and messages for `vinerow export`.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "engine/record/mcap_reader.h"

namespace vinerow::tools {

struct ExportArguments {
  std::filesystem::path log, out;
  std::vector<std::string> topics;
  bool csv = false, npz = false, pcd = false, ply = false, las = false, long_form = false;
  std::string poses;  ///< topic, for clouds in the frame of the map
  std::string crs;    ///< of the LAS file; "": the frame of the map
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
};

struct ChosenTopic {
  std::string name;
  bool by_pattern = false;
};

/// @throws ConfigError if a wanted topic is not there
std::vector<ChosenTopic> chosen_topics(const record::McapReader& log,
                                       const ExportArguments& arguments);

struct TopicSource {
  std::set<std::uint16_t> channels;
  const record::McapSchema* schema = nullptr;
};

/// @throws ConfigError if its messages cannot be decoded, or are of two types
TopicSource source_of(const record::McapReader& log, const std::string& topic,
                      const ExportArguments& arguments);

/// @throws ConfigError if no message can be between --from and --to
void check_span(const record::McapReader& log, const ExportArguments& arguments);

/// Adds the message if it is between --from and --to. @returns false if it cannot be decoded
/// @param out  has add(stamp_ns, logged_ns, bytes)
template <class Out>
bool add_message(const record::McapMessage& message, const ExportArguments& arguments, Out& out) {
  const auto stamp_ns = static_cast<std::int64_t>(message.publish_time);
  const double stamp_s = static_cast<double>(stamp_ns) / 1e9;
  if (stamp_s < arguments.from_s || stamp_s > arguments.to_s) return true;
  return out.add(stamp_ns, static_cast<std::int64_t>(message.log_time), message.data);
}

/// Prints how many messages could not be decoded, if any.
void note_undecoded(const ExportArguments& arguments, const std::string& topic,
                    const TopicSource& source, std::uint64_t undecoded);

/// Adds all messages of a topic. @param out  as add_message()
template <class Out>
void add_messages(record::McapReader& log, const std::string& topic, const TopicSource& source,
                  const ExportArguments& arguments, Out& out) {
  std::uint64_t undecoded = 0;
  log.for_each_message(source.channels, [&](const record::McapMessage& message) {
    undecoded += add_message(message, arguments, out) ? 0 : 1;
  });
  note_undecoded(arguments, topic, source, undecoded);
}

}  // namespace vinerow::tools
