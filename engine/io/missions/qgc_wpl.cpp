#include "engine/io/missions/qgc_wpl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/missions/mission_item_check.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

constexpr const char* kFieldNames[] = {"index",       "current",     "frame",       "command",
                                       "parameter 1", "parameter 2", "parameter 3", "parameter 4",
                                       "latitude",    "longitude",   "altitude",    "autocontinue"};
constexpr std::size_t kFieldCount = 12;

/// Twelve numbers of a line; NaN is allowed for parameters.
std::array<double, kFieldCount> read_wpl_fields(const std::string& line, const std::string& where) {
  std::istringstream stream(line);
  std::array<double, kFieldCount> fields{};
  std::string word;
  std::size_t count = 0;
  for (; stream >> word; ++count) {
    if (count >= kFieldCount) continue;
    // A leading + is common in such files, but from_chars does not accept it.
    const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    const auto [at, error] = std::from_chars(begin, end, fields[count]);
    const bool is_parameter = count >= 4 && count < 11;
    const bool is_number = error == std::errc() && at == end && begin != end;
    if (!is_number || !(std::isfinite(fields[count]) || is_parameter)) {
      throw ConfigError(
          fmt::format("{}: {} = '{}' is not a number", where, kFieldNames[count], word));
    }
  }
  if (count != kFieldCount) {
    throw ConfigError(fmt::format(
        "{}: it has {} fields, must be 12 between tabs (index, current, frame, command, "
        "parameters 1 to 4, latitude, longitude, altitude, autocontinue)",
        where, count));
  }
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}, std::size_t{3}}) {
    if (fields[i] != std::round(fields[i]) || std::abs(fields[i]) > 1e6) {
      throw ConfigError(
          fmt::format("{}: {} = {} must be a whole number", where, kFieldNames[i], fields[i]));
    }
  }
  return fields;
}

bool is_home(const MissionItem& item) {
  return item.command == 16 && item.frame == 0 && has_place(item);
}

}  // namespace

MissionFile parse_qgc_wpl(const std::string& text, const std::filesystem::path& file) {
  std::istringstream stream(text);
  std::string line, head, format, version, rest;
  std::getline(stream, line);
  std::istringstream first(line);
  first >> head >> format >> version;
  if (head != "QGC" || format != "WPL" || version != "110" || first >> rest) {
    while (!line.empty() && line.back() == '\r') line.pop_back();
    throw ConfigError(fmt::format("mission file '{}' begins with '{}', must be 'QGC WPL 110'",
                                  file.string(), line.substr(0, 40)));
  }
  MissionFile mission;
  mission.file = file;
  mission.format = "QGC WPL 110";
  for (int number = 1; std::getline(stream, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = mission_place(file, number);
    const auto fields = read_wpl_fields(line, where);
    MissionItem item;
    item.number = number++;
    item.frame = static_cast<int>(fields[2]);
    item.command = static_cast<int>(fields[3]);
    std::copy(fields.begin() + 4, fields.begin() + 11, item.params.begin());
    item.auto_continue = fields[11] != 0.0;
    if (fields[0] != item.number - 1) {
      throw ConfigError(
          fmt::format("{}: its index is {}, must be {}", where, fields[0], item.number - 1));
    }
    check_mission_item(item, file);
    mission.items.push_back(item);
  }
  if (!mission.items.empty() && is_home(mission.items.front())) {
    mission.planned_home = place_of(mission.items.front());
    mission.items.erase(mission.items.begin());
  }
  return mission;
}

std::string format_qgc_wpl(const MissionFile& mission) {
  std::string text = "QGC WPL 110\n";
  int index = 0;
  const auto add = [&](const MissionItem& item) {
    text += fmt::format("{}\t{}\t{}\t{}", index, index == 0 ? 1 : 0, item.frame, item.command);
    for (std::size_t i = 0; i < item.params.size(); ++i) {
      // The text format has no value for "keep"; autopilots interpret 0 as that.
      const double value = std::isfinite(item.params[i]) ? item.params[i] : 0.0;
      const bool is_place = i == 4 || i == 5;
      text += is_place ? fmt::format("\t{:.9f}", value) : fmt::format("\t{:.6g}", value);
    }
    text += item.auto_continue ? "\t1\n" : "\t0\n";
    ++index;
  };
  MissionItem home;
  home.frame = 0;
  home.params = {0,
                 0,
                 0,
                 0,
                 deg_from_rad(mission.planned_home->latitude_rad),
                 deg_from_rad(mission.planned_home->longitude_rad),
                 mission.planned_home->altitude_m};
  add(home);
  for (const MissionItem& item : mission.items) add(item);
  return text;
}

void write_qgc_wpl(const MissionFile& mission, const std::filesystem::path& file) {
  write_whole_file(file, format_qgc_wpl(mission), "mission file");
}

}  // namespace vinerow::io
