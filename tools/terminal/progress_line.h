#pragma once
/// How far a command is: on a terminal a bar that redraws itself, elsewhere a line each 10 %.

#include <string>
#include <string_view>

namespace vinerow::tools {

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  /// Ends a bar that stands.
  ~ProgressLine() { end(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param stage  "simulating"; another one than before begins a bar of its own
  /// @param share  done of it, 0 to 1  @param detail  "12.5 s, 40 x real time"
  void show(std::string_view stage, double share, const std::string& detail);
  /// Counted things: "pictures 3 of 20".
  void count(std::string_view stage, int done, int total);
  /// Ends the bar, so that something else can be printed below it.
  void end();

 private:
  bool quiet_;
  bool terminal_;
  bool stands_ = false;  ///< a bar is on the terminal's last line
  std::string stage_;
  double next_share_ = 0.0;
};

}  // namespace vinerow::tools
