#pragma once
/// `vinerow export`: tables of many topics in few passes over the log.

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "tools/export/message_table.h"
#include "tools/vinerow/export_source.h"

namespace vinerow::tools {

struct WantedTable {
  std::string topic;
  TopicSource source;
};

/// Each pass decompresses the whole log. It fills the tables of the topics that are left, as many
/// as are expected to fit into kMostBytes. While they take more, it drops the last one for a later
/// pass, and expects of it what its first messages took.
class ExportTables {
 public:
  /// Of the tables that are kept at the same time, if they are several.
  static constexpr std::size_t kMostBytes = 128'000'000;

  /// @param log, arguments  outlive this object
  ExportTables(record::McapReader& log, const ExportArguments& arguments,
               std::vector<WantedTable> wanted);

  /// The tables in the order of `wanted`. @pre called at most once for each of them
  MessageTable next();

 private:
  struct Filled {
    MessageTable table;
    std::uint64_t messages = 0, undecoded = 0;
  };
  void read();
  void drop_last();

  record::McapReader& log_;
  const ExportArguments& arguments_;
  std::vector<WantedTable> wanted_;
  std::vector<double> expected_bytes_;  ///< of each wanted table; 0: not known
  std::size_t taken_ = 0;
  std::deque<Filled> filled_;  ///< of wanted_[taken_] and the following
};

}  // namespace vinerow::tools
