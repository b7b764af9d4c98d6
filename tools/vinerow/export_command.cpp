#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/record/mcap_reader.h"
#include "tools/export/cloud_message.h"
#include "tools/export/message_table.h"
#include "tools/export/picture_files.h"
#include "tools/export/scan_files.h"
#include "tools/export/table_files.h"
#include "tools/vinerow/export_clouds.h"
#include "tools/vinerow/export_source.h"
#include "tools/vinerow/export_tables.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

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

/// A format of files.
struct OutFormat {
  const char* ending;
  const char* option;  ///< ".las" is chosen by the ending alone
  bool ExportArguments::*is_wanted;
};
constexpr OutFormat kFormats[] = {{".csv", "--csv", &ExportArguments::csv},
                                  {".npz", "--npz", &ExportArguments::npz},
                                  {".pcd", "--pcd", &ExportArguments::pcd},
                                  {".ply", "--ply", &ExportArguments::ply},
                                  {".las", "", &ExportArguments::las}};

/// Derives the format from -o. @returns whether -o names one file
bool read_out(ExportArguments& arguments) {
  const std::string ending = lower_extension(arguments.out);
  const bool to_stdout = arguments.out == "-";
  bool one_file = to_stdout;
  for (const OutFormat& format : kFormats) one_file = one_file || ending == format.ending;
  for (const OutFormat& wanted : kFormats) {
    if (!(arguments.*wanted.is_wanted)) continue;
    if (to_stdout && wanted.ending != std::string(".csv")) {
      throw ConfigError(
          fmt::format("export: {} cannot be printed to the terminal, -o must be a file or a folder",
                      wanted.option));
    }
    if (one_file && !to_stdout && ending != wanted.ending) {
      throw ConfigError(
          fmt::format("export: -o is a {} file, with {} it must be a folder or a {} file", ending,
                      wanted.option, wanted.ending));
    }
  }
  // A folder of such a name is hardly what is meant.
  static const std::set<std::string> kOthers = {".h5",  ".jpg",  ".json",    ".laz",
                                                ".mat", ".npy",  ".png",     ".tsv",
                                                ".txt", ".xlsx", ".parquet", ".xyz"};
  if (kOthers.contains(ending) && !std::filesystem::is_directory(arguments.out)) {
    throw ConfigError(
        fmt::format("export: -o '{}' must be a file .csv, .npz, .pcd, .ply or .las, - for the "
                    "terminal, or a folder",
                    arguments.out.string()));
  }
  bool has_format = false;
  for (const OutFormat& format : kFormats) {
    if (ending == format.ending) arguments.*format.is_wanted = true;
    has_format = has_format || arguments.*format.is_wanted;
  }
  if (!has_format) arguments.csv = true;
  const bool is_map_cloud = one_file && (arguments.pcd || arguments.ply || arguments.las);
  if (!arguments.poses.empty() && !is_map_cloud) {
    throw ConfigError(
        "export: --poses moves clouds into one file, -o must be a .pcd, .ply or .las file");
  }
  if (!arguments.crs.empty() && !arguments.las) {
    throw ConfigError("export: --crs is that of a LAS file, -o must be a .las file");
  }
  return one_file;
}

void write_table(const MessageTable& table, const std::filesystem::path& file,
                 const std::string& bytes) {
  io::make_folder_of(file);
  write_whole_file(file, bytes);
  fmt::print("{}  {} rows\n", file.string(), table.rows().size());
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
  std::optional<CloudFormat> cloud_format;
  if (arguments.pcd) cloud_format = CloudFormat::kPcd;
  if (arguments.ply) cloud_format = CloudFormat::kPly;
  const bool to_clouds = cloud_format || arguments.las;
  const auto is_in_picture_files = [&](const std::string& type) {
    return is_picture_type(type) && arguments.csv;
  };
  // Everything is checked before the first file is written.
  std::vector<std::pair<ChosenTopic, TopicSource>> exported;
  std::vector<WantedTable> wanted_tables;
  for (const ChosenTopic& topic : topics) {
    TopicSource source = source_of(log, topic.name, arguments);
    const std::string& type = source.schema->name;
    if (to_clouds && !is_cloud_type(type)) {
      // A pattern exports every topic that can be exported.
      if (topic.by_pattern) continue;
      throw ConfigError(
          fmt::format("export: topic '{}' has no clouds, it is of type {}", topic.name, type));
    }
    if (one_file && is_in_picture_files(type)) {
      throw ConfigError(fmt::format(
          "export: topic '{}' has pictures, -o must be a folder for them or a .npz file",
          topic.name));
    }
    const bool needs_table = !to_clouds && (arguments.npz || !is_in_picture_files(type));
    if (needs_table) wanted_tables.push_back({topic.name, source});
    exported.emplace_back(topic, std::move(source));
  }
  if (exported.empty()) {
    throw ConfigError(fmt::format("{}: none of the topics has clouds", arguments.log.string()));
  }
  ExportTables tables(log, arguments, std::move(wanted_tables));
  std::set<std::string> taken;
  const auto export_one = [&](const std::string& topic, const TopicSource& source) {
    const std::string& type = source.schema->name;
    const std::string stem = file_stem(topic, taken);
    if (to_clouds && one_file) return write_map_cloud(log, topic, source, arguments);
    if (cloud_format) {
      ScanFiles clouds(folder / stem, *cloud_format);
      add_messages(log, topic, source, arguments, clouds);
      fmt::print("{}  {} clouds\n", (folder / stem).string(), clouds.finish());
      return;
    }
    // Pictures are files, not columns of bytes; arrays of them only where those are requested.
    const bool as_files = is_in_picture_files(type);
    if (as_files) {
      PictureFiles pictures(folder / stem);
      add_messages(log, topic, source, arguments, pictures);
      fmt::print("{}  {} pictures\n", (folder / stem).string(), pictures.finish());
      if (!arguments.npz) return;
    }
    const MessageTable table = tables.next();
    const auto file = [&](const char* ending) {
      return one_file ? arguments.out : folder / (stem + ending);
    };
    if (arguments.out == "-") {
      fmt::print("{}", csv_of(table, topic));
      return;
    }
    if (arguments.csv && !as_files) write_table(table, file(".csv"), csv_of(table, topic));
    if (arguments.npz)
      write_table(table, file(".npz"), npz_of(table, topic, is_picture_type(type)));
  };
  for (const auto& [topic, source] : exported) {
    try {
      export_one(topic.name, source);
    } catch (const TableTooLarge& error) {
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
      "export",
      "write topics of a log as tables: CSV, or arrays for NumPy; pictures and clouds as files");
  command->add_option("log", arguments->log, "log.mcap of a run, or the run's folder")->required();
  command
      ->add_option(
          "--topic", arguments->topics,
          "this topic, or all that match a pattern: '/rover/*' (may be given several times)")
      ->required()
      ->allow_extra_args(false);
  CLI::Option* const csv =
      command->add_flag("--csv", arguments->csv, "comma-separated (the default)");
  CLI::Option* const npz =
      command->add_flag("--npz", arguments->npz, "NumPy arrays, for numpy.load()");
  CLI::Option* const pcd = command->add_flag("--pcd", arguments->pcd,
                                             "each cloud as a PCD file, in the scanner's frame");
  CLI::Option* const ply = command->add_flag("--ply", arguments->ply,
                                             "each cloud as a PLY file, in the scanner's frame");
  for (CLI::Option* const cloud : {pcd, ply}) cloud->excludes(csv)->excludes(npz);
  pcd->excludes(ply);
  command->add_option(
      "-o,--out", arguments->out,
      "file .csv or .npz; .pcd, .ply or .las for all clouds of a topic in the "
      "frame of the map; - for the terminal; or a folder (default: export next to the log)");
  command->add_option("--poses", arguments->poses,
                      "topic of the poses that bring clouds into the frame of the map (default: "
                      "the true ones, /<vehicle>/truth)");
  command->add_option("--crs", arguments->crs,
                      "coordinates of a .las file, like EPSG:25832 (default: m east, north, up of "
                      "the world's origin)");
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
