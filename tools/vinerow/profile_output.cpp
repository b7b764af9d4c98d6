#include "tools/vinerow/profile_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "engine/core/whole_file.h"
#include "tools/terminal/heap_count.h"

namespace vinerow::tools {
namespace {

std::int64_t wall_ns() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

}  // namespace

run::RunProfile make_profile() {
  return {wall_ns, counts_heap() ? heap_count : nullptr};
}

std::string profile_table(const run::RunProfile& profile) {
  constexpr std::size_t kShown = 20;
  const std::vector<run::RunProfile::Row> rows = profile.rows();
  const std::size_t shown = std::min(kShown, rows.size());
  std::size_t part_width = 4, phase_width = 5;
  double total_s = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    total_s += rows[i].time_s;
    if (i >= shown) continue;
    part_width = std::max(part_width, rows[i].part.size());
    phase_width = std::max(phase_width, rows[i].phase.size());
  }
  std::string out = fmt::format("profile of {:.2f} s\n", total_s);
  out += fmt::format("{:>7}  {:>8}  {:{}}  {:{}}  {:8}  {:>9}  {:>10}  {:>11}  {:>11}\n", "share",
                     "time, s", "part", part_width, "phase", phase_width, "stage", "calls",
                     "us a call", "longest, us", "allocations");
  for (std::size_t i = 0; i < shown; ++i) {
    const run::RunProfile::Row& row = rows[i];
    out += fmt::format("{:5.1f} %  {:8.3f}  {:{}}  {:{}}  {:8}  {:9}  {:10.2f}  {:11.1f}  {:>11}\n",
                       total_s > 0.0 ? 100.0 * row.time_s / total_s : 0.0, row.time_s, row.part,
                       part_width, row.phase, phase_width, row.stage, row.calls,
                       1e6 * row.time_s / static_cast<double>(row.calls), 1e6 * row.longest_s,
                       profile.counts_allocations() ? std::to_string(row.allocations) : "-");
  }
  if (rows.size() > shown) {
    out += fmt::format("and {} more rows in profile.csv\n", rows.size() - shown);
  }
  out += fmt::format("tasks of the same instant on two cores would save {:.2f} s at most\n",
                     profile.two_cores_save_s());
  return out;
}

void write_profile(const run::RunProfile& profile, const std::filesystem::path& folder) {
  write_whole_file(folder / "profile.csv", profile.csv());
  write_whole_file(folder / "profile.json", profile.trace_json());
}

}  // namespace vinerow::tools
