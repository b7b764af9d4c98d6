#include "engine/run/run_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/check.h"
#include "engine/io/files/csv.h"

namespace vinerow::run {
namespace {

/// Spans of a trace: 10 MB as text, which both viewers open within seconds.
constexpr std::size_t kMaxSpans = 100'000;
constexpr double kNsPerSecond = 1e9;

std::string quoted(std::string_view text) {
  return nlohmann::json(text).dump();
}

}  // namespace

int RunProfile::Words::of(std::string_view text) {
  const auto [found, is_new] =
      numbers.try_emplace(std::string(text), static_cast<int>(texts.size()));
  if (is_new) texts.emplace_back(text);
  return found->second;
}

RunProfile::RunProfile(Clock clock, HeapCount heap)
    : clock_(clock), heap_(heap), start_ns_(clock()), phase_start_ns_(start_ns_) {
  phase_ = phases_.of("all");
  begin("not in a span", "other");
  phase_ = phases_.of("set-up");
}

std::string_view RunProfile::stage_of(std::string_view stage) const {
  if (!stage.empty() || open_.empty()) return stage;
  const Cell& around = cells_[static_cast<std::size_t>(open_.back().cell)];
  return stages_.texts[static_cast<std::size_t>(around.stage)];
}

int RunProfile::cell_of(std::string_view name, std::string_view stage) {
  stage = stage_of(stage);
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(name.data());
  Recent& recent = recent_[(address >> 4 ^ address >> 14) % recent_.size()];
  if (recent.name == name.data() && recent.phase_changes == phase_changes_) {
    // Another text can have come to the same address.
    const Cell& cell = cells_[static_cast<std::size_t>(recent.cell)];
    if (names_[static_cast<std::size_t>(cell.name)].text == name &&
        stages_.texts[static_cast<std::size_t>(cell.stage)] == stage) {
      return recent.cell;
    }
  }
  const int cell = find_cell(name, stage);
  recent = {name.data(), phase_changes_, cell};
  return cell;
}

int RunProfile::find_cell(std::string_view name, std::string_view stage) {
  const auto number = static_cast<std::size_t>(name_numbers_.of(name));
  if (number == names_.size()) {
    const int owner = owners_.of(name.substr(0, name.find('.')));
    names_.push_back({std::string(name), owner, {}});
    phase_of_owner_.resize(owners_.texts.size(), -1);
  }
  Name& entry = names_[number];
  const int own_phase = phase_of_owner_[static_cast<std::size_t>(entry.owner)];
  const int phase = own_phase >= 0 ? own_phase : phase_;
  const int own_stage = stages_.of(stage);
  for (const int cell : entry.cells) {
    const Cell& known = cells_[static_cast<std::size_t>(cell)];
    if (known.phase == phase && known.stage == own_stage) return cell;
  }
  entry.cells.push_back(static_cast<int>(cells_.size()));
  Cell& cell = cells_.emplace_back();
  cell.name = static_cast<int>(number);
  cell.phase = phase;
  cell.stage = own_stage;
  return entry.cells.back();
}

void RunProfile::begin(std::string_view name, std::string_view stage) {
  const std::uint64_t before = heap_count();
  open_.push_back({cell_of(name, stage), 0, 0, 0, 0});
  Frame& frame = open_.back();
  frame.allocations = heap_count();
  // What the profile itself allocates belongs to nobody.
  if (open_.size() > 1) open_[open_.size() - 2].allocations_within += frame.allocations - before;
  frame.start_ns = clock_();
}

void RunProfile::end() {
  const std::int64_t now_ns = clock_();
  const std::uint64_t allocations_now = heap_count();
  VINEROW_DEMAND(open_.size() > 1);  // the first one never ends
  const Frame frame = open_.back();
  open_.pop_back();
  const std::int64_t length_ns = now_ns - frame.start_ns;
  const std::uint64_t allocations = allocations_now - frame.allocations;
  Cell& cell = cells_[static_cast<std::size_t>(frame.cell)];
  ++cell.calls;
  cell.self_ns += length_ns - frame.within_ns;
  cell.longest_ns = std::max(cell.longest_ns, length_ns);
  cell.allocations += allocations - frame.allocations_within;
  keep({frame.cell, static_cast<int>(open_.size()), frame.start_ns, length_ns});
  open_.back().within_ns += length_ns;
  open_.back().allocations_within += allocations + (heap_count() - allocations_now);
}

/// Keeps the longest spans: if there are too many, the shorter half goes.
void RunProfile::keep(const Span& span) {
  if (span.length_ns < shortest_kept_ns_) return;
  spans_.push_back(span);
  if (spans_.size() < 2 * kMaxSpans) return;
  std::vector<std::int64_t> lengths;
  for (const Span& kept : spans_) lengths.push_back(kept.length_ns);
  const auto middle = lengths.begin() + kMaxSpans;
  std::nth_element(lengths.begin(), middle, lengths.end());
  shortest_kept_ns_ = *middle + 1;
  std::erase_if(spans_, [&](const Span& kept) { return kept.length_ns < shortest_kept_ns_; });
}

void RunProfile::close_phase(std::int64_t now_ns) {
  past_phases_.push_back({phases_.texts[static_cast<std::size_t>(phase_)], phase_start_ns_,
                          now_ns - phase_start_ns_, 0.0, 0});
  phase_start_ns_ = now_ns;
}

void RunProfile::set_phase(std::string_view owner, std::string_view phase) {
  const int number = phases_.of(phase);
  ++phase_changes_;
  if (owner.empty()) {
    if (number == phase_) return;
    close_phase(clock_());
    phase_ = number;
    return;
  }
  const auto index = static_cast<std::size_t>(owners_.of(owner));
  phase_of_owner_.resize(owners_.texts.size(), -1);
  phase_of_owner_[index] = number;
}

void RunProfile::begin_slice(Time from) {
  slice_from_ = from;
  slice_start_ns_ = clock_();
  slice_allocations_ = heap_count();
}

void RunProfile::end_slice(Time to) {
  const std::uint64_t allocations = heap_count() - slice_allocations_;
  slices_.push_back({fmt::format("{:g} s", slice_from_.s()), slice_start_ns_,
                     clock_() - slice_start_ns_, (to - slice_from_).s(), allocations});
}

double RunProfile::total_s() const {
  return static_cast<double>(clock_() - start_ns_) / kNsPerSecond;
}

std::vector<RunProfile::Row> RunProfile::rows() const {
  std::vector<Cell> cells = cells_;
  // What is not over yet counts until now.
  const std::int64_t now_ns = clock_();
  const std::uint64_t allocations_now = heap_count();
  std::int64_t within_ns = 0;
  std::uint64_t allocations_within = 0;
  for (auto frame = open_.rbegin(); frame != open_.rend(); ++frame) {
    Cell& cell = cells[static_cast<std::size_t>(frame->cell)];
    const std::int64_t length_ns = now_ns - frame->start_ns;
    const std::uint64_t allocations = allocations_now - frame->allocations;
    ++cell.calls;
    cell.self_ns += length_ns - frame->within_ns - within_ns;
    cell.longest_ns = std::max(cell.longest_ns, length_ns);
    // The outermost one is no call.
    if (frame + 1 == open_.rend()) cell.longest_ns = cell.self_ns;
    cell.allocations += allocations - frame->allocations_within - allocations_within;
    within_ns = length_ns;
    allocations_within = allocations;
  }
  std::vector<Row> rows;
  for (const Cell& cell : cells) {
    Row& row = rows.emplace_back();
    row.part = names_[static_cast<std::size_t>(cell.name)].text;
    row.phase = phases_.texts[static_cast<std::size_t>(cell.phase)];
    row.stage = stages_.texts[static_cast<std::size_t>(cell.stage)];
    row.calls = cell.calls;
    row.time_s = static_cast<double>(cell.self_ns) / kNsPerSecond;
    row.longest_s = static_cast<double>(cell.longest_ns) / kNsPerSecond;
    row.allocations = cell.allocations;
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.time_s > b.time_s; });
  return rows;
}

std::string RunProfile::csv() const {
  std::string out = "part,phase,stage,calls,time_s,us_per_call,longest_us,allocations\n";
  for (const Row& row : rows()) {
    out += fmt::format("{},{},{},{},{},{:.3f},{:.3f},{}\n", io::csv_text(row.part),
                       io::csv_text(row.phase), io::csv_text(row.stage), row.calls,
                       io::csv_number(row.time_s),
                       1e6 * row.time_s / static_cast<double>(row.calls), 1e6 * row.longest_s,
                       counts_allocations() ? std::to_string(row.allocations) : "");
  }
  return out;
}

std::string RunProfile::trace_json() const {
  // One line an event. Times are microseconds from the start.
  std::string out = "{\"displayTimeUnit\": \"ns\", \"traceEvents\": [\n";
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  const auto name_track = [&out](int track, const char* name) {
    out += fmt::format(
        R"({{"ph": "M", "pid": 1, "tid": {}, "name": "thread_name", "args": {{"name": "{}"}}}},)"
        "\n",
        track, name);
  };
  enum Track { kWork = 1, kPhases, kSimulated };
  const auto add = [&](Track track, std::string_view name, std::string_view category,
                       std::int64_t start_ns, std::int64_t length_ns) {
    out += fmt::format(
        R"({{"ph": "X", "pid": 1, "tid": {}, "ts": {:.3f}, "dur": {:.3f}, "cat": {}, "name": {}}},)"
        "\n",
        static_cast<int>(track), us(start_ns - start_ns_), us(length_ns), quoted(category),
        quoted(name));
  };
  const auto count = [&](const char* name, std::int64_t at_ns, double value) {
    out += fmt::format(
        R"({{"ph": "C", "pid": 1, "ts": {:.3f}, "name": "{}", "args": {{"value": {:.6g}}}}},)"
        "\n",
        us(at_ns - start_ns_), name, value);
  };
  name_track(kWork, "work");
  name_track(kPhases, "phases");
  name_track(kSimulated, "simulated time");
  // By their start, an enclosing span before those within it: viewers need this order.
  std::vector<Span> spans = spans_;
  std::stable_sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) {
    if (a.start_ns != b.start_ns) return a.start_ns < b.start_ns;
    return a.length_ns != b.length_ns ? a.length_ns > b.length_ns : a.depth < b.depth;
  });
  for (const Span& span : spans) {
    const Cell& cell = cells_[static_cast<std::size_t>(span.cell)];
    add(kWork, names_[static_cast<std::size_t>(cell.name)].text,
        stages_.texts[static_cast<std::size_t>(cell.stage)], span.start_ns, span.length_ns);
  }
  for (const Stretch& phase : past_phases_) {
    add(kPhases, phase.name, "phase", phase.start_ns, phase.length_ns);
  }
  for (const Stretch& slice : slices_) {
    add(kSimulated, slice.name, "simulated time", slice.start_ns, slice.length_ns);
    if (slice.length_ns <= 0 || slice.simulated_s <= 0.0) continue;
    count("times real time", slice.start_ns,
          slice.simulated_s / (static_cast<double>(slice.length_ns) / kNsPerSecond));
    if (!heap_) continue;
    count("allocations per simulated second", slice.start_ns,
          static_cast<double>(slice.allocations) / slice.simulated_s);
  }
  const std::int64_t now_ns = clock_();
  add(kPhases, phases_.texts[static_cast<std::size_t>(phase_)], "phase", phase_start_ns_,
      now_ns - phase_start_ns_);
  out.resize(out.size() - 2);  // the last comma
  return out + "\n]}\n";
}

}  // namespace vinerow::run
