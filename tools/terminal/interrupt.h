#pragma once
/// Handling of Ctrl-C: the first ends a command's work and keeps its results, the second ends the
/// program at once.

namespace vinerow::tools {

/// Starts watching for Ctrl-C.
void watch_for_interrupt();
/// Whether Ctrl-C was pressed since then.
bool is_interrupted();

}  // namespace vinerow::tools
