#include <fmt/format.h>

#include "engine/record/log_reader.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {

void add_info_command(CLI::App& app, int& exit_status) {
  auto file = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("info", "summarise a log: topics, types, message counts");
  command->add_option("log", *file, "log.mcap of a run, complete or truncated, or its folder")
      ->required();
  command->callback([file, &exit_status] {
    const std::filesystem::path log = log_of(*file);
    const record::LogReader reader(log);
    const record::LogInfo& info = reader.info();
    fmt::print("{}: {}, {:.3f} to {:.3f} s, {} messages, {:.2f} MB\n", log.string(),
               info.complete ? "complete" : "cut off (no footer)", info.first.s(), info.last.s(),
               info.messages, static_cast<double>(info.bytes) * 1e-6);
    for (const auto& [key, value] : info.metadata) fmt::print("  {}: {}\n", key, value);
    const double span_s = (info.last - info.first).s();
    for (const record::ChannelInfo& channel : info.channels) {
      // Lossless twin of a channel whose standard type cannot hold all fields.
      if (channel.metadata.contains("exact_of")) continue;
      const double rate_Hz = channel.messages > 1 && span_s > 0.0
                                 ? static_cast<double>(channel.messages - 1) / span_s
                                 : 0.0;
      fmt::print("  {:<34} {:<36} {:>8} {:<8} {:>8.2f} Hz\n", channel.topic, channel.schema,
                 channel.messages, channel.messages == 1 ? "message" : "messages", rate_Hz);
    }
    for (const auto& [name, content] : info.attachments) {
      fmt::print("  attachment {} ({} bytes)\n", name, content.size());
    }
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
