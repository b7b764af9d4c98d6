#include "tools/study/cost_meter.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace vinerow::study {
namespace {

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_MB() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024.0 / 1e6;
  }
  return 0.0;
}

}  // namespace

CostMeter::CostMeter() : start_(std::chrono::steady_clock::now()), cpu_s_(cpu_s()) {
  std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets VmHWM
}

CellCost CostMeter::cost() const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
  return {wall.count(), cpu_s() - cpu_s_, peak_MB(), host_name()};
}

std::string host_name() {
  char name[256] = "";
  static_cast<void>(gethostname(name, sizeof name - 1));
  return name;
}

}  // namespace vinerow::study
