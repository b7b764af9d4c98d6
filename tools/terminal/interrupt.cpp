#include "tools/terminal/interrupt.h"

#include <csignal>

#include "engine/sim/python_parts.h"

namespace vinerow::tools {
namespace {

volatile std::sig_atomic_t interrupt_seen = 0;

void note_interrupt(int) {
  interrupt_seen = 1;
  std::signal(SIGINT, SIG_DFL);
  interrupt_python_part();
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGINT, note_interrupt);
}

bool is_interrupted() {
  return interrupt_seen != 0;
}

}  // namespace vinerow::tools
