#include "tools/terminal/progress_line.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace vinerow::tools {
namespace {

/// Characters that fit on a line of the terminal. One less than its columns: at the last one some
/// terminals begin the next line.
int line_width() {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return (is_known ? size.ws_col : 80) - 1;
}

/// "[====      ] text" in at most `width` characters: a shorter bar first, then a shorter text.
std::string draw_bar(double share, const std::string& text, int width) {
  constexpr int kLongest = 30, kShortest = 5, kFrame = 3;
  const int room = width - kFrame - static_cast<int>(text.size());
  const int length = std::clamp(room, kShortest, kLongest);
  const int filled = static_cast<int>(share * length);
  const std::string line =
      fmt::format("[{:=<{}}{: <{}}] {}", "", filled, "", length - filled, text);
  return line.substr(0, static_cast<std::size_t>(std::max(width, 0)));
}

}  // namespace

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
    // Clear to the end of the line: the previous text may have been longer.
    fmt::print(stderr, "\r{}\x1b[K",
               draw_bar(share, fmt::format("{} {}", stage, detail), line_width()));
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
