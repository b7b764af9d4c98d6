#pragma once
/// Ctrl-C ends a command's work so that what it has is stored; a second one ends the program at
/// once.

namespace vinerow::tools {

/// From now on Ctrl-C is noted.
void watch_for_interrupt();
/// Whether it was pressed since.
bool is_interrupted();

}  // namespace vinerow::tools
