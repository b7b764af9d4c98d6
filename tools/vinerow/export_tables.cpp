#include "tools/vinerow/export_tables.h"

#include <map>
#include <set>
#include <utility>

namespace vinerow::tools {

ExportTables::ExportTables(record::McapReader& log, const ExportArguments& arguments,
                           std::vector<WantedTable> wanted)
    : log_(log),
      arguments_(arguments),
      wanted_(std::move(wanted)),
      expected_bytes_(wanted_.size(), 0.0) {}

MessageTable ExportTables::next() {
  if (filled_.empty()) read();
  Filled filled = std::move(filled_.front());
  filled_.pop_front();
  const WantedTable& wanted = wanted_[taken_++];
  note_undecoded(arguments_, wanted.topic, wanted.source, filled.undecoded);
  return std::move(filled.table);
}

void ExportTables::read() {
  std::map<std::uint16_t, std::size_t> place_of;  // by channel
  std::set<std::uint16_t> channels;
  double expected = 0.0;
  for (std::size_t i = taken_; i < wanted_.size(); ++i) {
    expected += expected_bytes_[i];
    if (i > taken_ && expected > static_cast<double>(kMostBytes)) break;
    const record::McapSchema& schema = *wanted_[i].source.schema;
    filled_.push_back(
        {MessageTable(record::RosSchema::parse(schema.name, schema.data), arguments_.long_form)});
    for (const std::uint16_t channel : wanted_[i].source.channels) {
      place_of[channel] = i - taken_;
      channels.insert(channel);
    }
  }
  std::size_t bytes = 0;
  log_.for_each_message(channels, [&](const record::McapMessage& message) {
    const std::size_t place = place_of.at(message.channel);
    if (place >= filled_.size()) return;
    Filled& filled = filled_[place];
    bytes -= filled.table.bytes();
    ++filled.messages;
    filled.undecoded += add_message(message, arguments_, filled.table) ? 0 : 1;
    bytes += filled.table.bytes();
    while (bytes > kMostBytes && filled_.size() > 1) {
      bytes -= filled_.back().table.bytes();
      drop_last();
    }
  });
}

void ExportTables::drop_last() {
  const std::size_t i = taken_ + filled_.size() - 1;
  const Filled& last = filled_.back();
  std::uint64_t messages = 0;
  for (const std::uint16_t channel : wanted_[i].source.channels) {
    messages += log_.channels().at(channel).messages;
  }
  if (last.messages > 0) {
    expected_bytes_[i] = static_cast<double>(last.table.bytes()) * static_cast<double>(messages) /
                         static_cast<double>(last.messages);
  }
  filled_.pop_back();
}

}  // namespace vinerow::tools
