#pragma once
/// Profile of a run: its computing time by part, stage and phase, and a trace of its spans.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/core/profile.h"
#include "engine/core/time.h"

namespace vinerow::run {

class RunProfile final : public ProfileSink {
 public:
  using Clock = std::int64_t (*)();       ///< wall time since an arbitrary moment, ns
  using HeapCount = std::uint64_t (*)();  ///< heap allocations of this thread so far
  /// Begins with work that no span names. @param heap  may be null: allocations are not counted
  RunProfile(Clock clock, HeapCount heap);

  void begin(std::string_view name, std::string_view stage) override;
  void end() override;
  void set_phase(std::string_view owner, std::string_view phase) override;

  /// Marks a stretch of simulated time in the trace.
  void begin_slice(Time from);
  void end_slice(Time to);

  struct Row {
    std::string part, phase, stage;
    std::uint64_t calls = 0;
    double time_s = 0.0;     ///< without the spans within it
    double longest_s = 0.0;  ///< of one call, with the spans within it
    std::uint64_t allocations = 0;
  };
  /// So far, by falling time; the sum of their times is total_s().
  std::vector<Row> rows() const;
  double total_s() const;
  /// Bound of what tasks of one instant would save side by side (Scheduler::two_cores_save_s()).
  void set_two_cores_save_s(double save_s) { two_cores_save_s_ = save_s; }
  double two_cores_save_s() const { return two_cores_save_s_; }
  bool counts_allocations() const { return heap_ != nullptr; }

  /// Trace Event Format, which Perfetto and speedscope open. It has the slices, the phases and the
  /// longest spans, up to a number that a browser can show.
  std::string trace_json() const;
  /// The rows as a table with a heading.
  std::string csv() const;

 private:
  struct Cell {
    int name, phase, stage;
    std::uint64_t calls = 0;
    std::int64_t self_ns = 0, longest_ns = 0;
    std::uint64_t allocations = 0;
  };
  struct Name {
    std::string text;
    int owner;
    std::vector<int> cells;  ///< of this name
  };
  struct Frame {
    int cell;
    std::int64_t start_ns, within_ns;
    std::uint64_t allocations, allocations_within;
  };
  struct Span {
    int cell, depth;
    std::int64_t start_ns, length_ns;
  };
  struct Stretch {
    std::string name;
    std::int64_t start_ns, length_ns;
    double simulated_s;
    std::uint64_t allocations;
  };
  /// The cell that a name last had, by the address of its text: finding it by the text itself would
  /// take longer than many a span.
  struct Recent {
    const char* name = nullptr;
    int phase_changes = -1;
    int cell = -1;
  };
  /// Texts by number, in the order in which they came.
  struct Words {
    std::vector<std::string> texts;
    std::unordered_map<std::string, int> numbers;
    int of(std::string_view text);
  };

  std::uint64_t heap_count() const { return heap_ ? heap_() : 0; }
  /// Stage of a span: its own, or that of the span around it.
  std::string_view stage_of(std::string_view stage) const;
  int cell_of(std::string_view name, std::string_view stage);
  int find_cell(std::string_view name, std::string_view stage);
  void keep(const Span& span);
  void close_phase(std::int64_t now_ns);

  Clock clock_;
  HeapCount heap_;
  std::int64_t start_ns_;
  Words name_numbers_, stages_, phases_, owners_;
  std::vector<Name> names_;
  std::vector<Cell> cells_;
  std::vector<int> phase_of_owner_;  ///< -1: that of everything else
  int phase_ = 0;                    ///< of everything else
  int phase_changes_ = 0;
  std::array<Recent, 1024> recent_;
  std::vector<Frame> open_;
  std::vector<Span> spans_;
  std::int64_t shortest_kept_ns_ = 0;
  std::vector<Stretch> slices_, past_phases_;
  std::int64_t slice_start_ns_ = 0, phase_start_ns_ = 0;
  Time slice_from_;
  std::uint64_t slice_allocations_ = 0;
  double two_cores_save_s_ = 0.0;
};

}  // namespace vinerow::run
