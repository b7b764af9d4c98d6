#pragma once
/// Progress display: a redrawn bar on a terminal, otherwise one line per 10 %.

#include <string>
#include <string_view>

namespace vinerow::tools {

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  /// Ends an open bar.
  ~ProgressLine() { end(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param stage  "simulating"; a new stage starts a new bar
  /// @param share  finished share of the stage, 0 to 1  @param detail  "12.5 s, 40 x real time"
  void show(std::string_view stage, double share, const std::string& detail);
  /// Shows a count: "drawing pictures 3 of 20".
  void count(std::string_view stage, int done, int total);
  /// Ends the bar, so that other text can be printed below it.
  void end();

 private:
  bool quiet_;
  bool terminal_;
  bool stands_ = false;  ///< a bar is on the terminal's last line
  std::string stage_;
  double next_share_ = 0.0;
};

}  // namespace vinerow::tools
