#include "tools/terminal/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace vinerow::tools {

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(std::string_view stage, double share, const std::string& detail) {
  if (quiet_) return;
  if (stage_ != stage) {
    end();
    stage_ = stage;
    next_share_ = 0.0;
  }
  share = std::clamp(share, 0.0, 1.0);
  if (terminal_) {
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(share * kWidth);
    // Clear to the end of the line: the previous text may have been longer.
    fmt::print(stderr, "\r[{:=<{}}{: <{}}] {} {}\x1b[K", "", filled, "", kWidth - filled, stage,
               detail);
    std::fflush(stderr);
    stands_ = true;
  } else if (share >= next_share_ - 1e-9) {
    fmt::print(stderr, "{} {:3.0f} %  {}\n", stage, 100.0 * share, detail);
    while (next_share_ <= share + 1e-9) next_share_ += 0.1;
  }
}

void ProgressLine::count(std::string_view stage, int done, int total) {
  if (total > 0) {
    show(stage, static_cast<double>(done) / total, fmt::format("{} of {}", done, total));
  }
}

void ProgressLine::end() {
  if (stands_) fmt::print(stderr, "\n");
  stands_ = false;
}

}  // namespace vinerow::tools
