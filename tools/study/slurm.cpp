#include "tools/study/slurm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/program.h"
#include "tools/study/numbers.h"

namespace vinerow::study::slurm {
namespace {

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, '|');) fields.push_back(field);
  return fields;
}

/// Path with '%' escaped, which would start a pattern in the name of a log.
std::string without_patterns(const std::string& path) {
  std::string escaped;
  for (const char c : path) escaped += c == '%' ? std::string("%%") : std::string(1, c);
  return escaped;
}

}  // namespace

void demand_commands() {
  for (const char* command : {"sbatch", "squeue", "scancel"}) {
    if (!has_program(command)) {
      throw ConfigError(
          fmt::format("this machine has no Slurm ('{}' is not in PATH); without "
                      "'--runner slurm' the study runs locally",
                      command));
    }
  }
}

std::size_t max_tasks() {
  constexpr std::size_t kDefault = 1001;
  if (!has_program("scontrol")) return kDefault;
  std::istringstream lines(run_program({"scontrol", "show", "config"}).output);
  for (std::string name, equals, value, line; std::getline(lines, line);) {
    std::istringstream words(line);
    if (!(words >> name >> equals >> value) || name != "MaxArraySize") continue;
    const double number = number_in(value).value_or(0.0);
    return number >= 1.0 ? static_cast<std::size_t>(number) : kDefault;
  }
  return kDefault;
}

Submitted submit(const Submission& submission) {
  std::vector<std::string> words = {
      "sbatch",
      "--parsable",
      "--requeue",  // after the failure of a node
      fmt::format("--array=0-{}", submission.tasks - 1),
      "--job-name=" + submission.name,
      fmt::format("--output={}/%a.log", without_patterns(submission.logs.string())),
      "--open-mode=append"};
  if (submission.time_limit_s > 0.0) {
    words.push_back(fmt::format("--time={:.0f}", std::ceil(submission.time_limit_s / 60.0)));
  }
  words.insert(words.end(), submission.options.begin(), submission.options.end());
  words.push_back(submission.script.string());
  const ProgramOutput answer = run_program(words);
  // "12", or "12;cluster".
  const std::string job = answer.output.substr(0, answer.output.find_first_of(";\n"));
  if (answer.succeeded && !job.empty()) return {job, ""};
  return {"", answer.complaint.empty() ? "sbatch gave no reason" : answer.complaint};
}

bool is_end(const std::string& state) {
  constexpr std::array kEnds = {"BOOT_FAIL", "CANCELLED", "COMPLETED",     "DEADLINE", "FAILED",
                                "NODE_FAIL", "PREEMPTED", "OUT_OF_MEMORY", "TIMEOUT"};
  return std::find(kEnds.begin(), kEnds.end(), state) != kEnds.end();
}

bool Task::is_running() const {
  return state == "RUNNING" || state == "COMPLETING";
}

bool Task::has_ended() const {
  return is_end(state);
}

Queue queue_of(const std::vector<std::string>& names) {
  Queue queue;
  if (names.empty()) return queue;
  const ProgramOutput answer =
      run_program({"squeue", "--noheader", "--array", "--states=all",
                   fmt::format("--name={}", fmt::join(names, ",")), "--format=%F|%K|%T|%j|%r"});
  if (!answer.succeeded) {
    queue.complaint = answer.complaint.empty() ? "squeue failed" : answer.complaint;
    return queue;
  }
  std::istringstream lines(answer.output);
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() < 4) continue;
    const double index = number_in(fields[1]).value_or(-1.0);
    if (index < 0.0) continue;
    const std::string reason = fields.size() > 4 && fields[4] != "None" ? fields[4] : "";
    queue.tasks.push_back(
        {fields[0], fields[3], static_cast<std::size_t>(index), fields[2], reason});
  }
  return queue;
}

std::string state_in_accounting(const std::string& job, std::size_t index) {
  if (!has_program("sacct")) return "";
  const ProgramOutput answer =
      run_program({"sacct", "--noheader", "--parsable2", "--allocations",
                   fmt::format("--jobs={}_{}", job, index), "--format=State"});
  if (!answer.succeeded) return "";
  // "CANCELLED by 1000": the first word is the state. The last line belongs to the latest start.
  std::string state;
  std::istringstream lines(answer.output);
  for (std::string line; std::getline(lines, line);) {
    const std::string first = line.substr(0, line.find(' '));
    if (!first.empty()) state = first;
  }
  return state;
}

void cancel(const std::vector<std::string>& jobs) {
  if (jobs.empty()) return;
  std::vector<std::string> words = {"scancel"};
  words.insert(words.end(), jobs.begin(), jobs.end());
  static_cast<void>(run_program(words));  // jobs that have already ended are not an error
}

}  // namespace vinerow::study::slurm
