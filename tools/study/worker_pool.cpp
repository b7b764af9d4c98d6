#include "tools/study/worker_pool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>

#include "engine/core/check.h"
#include "engine/core/program.h"
#include "engine/core/whole_file.h"

namespace vinerow::study {
namespace {

using Clock = std::chrono::steady_clock;

double resident_MB(pid_t process) {
  std::ifstream statm(fmt::format("/proc/{}/statm", process));
  double total = 0.0, resident = 0.0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace

struct WorkerPool::Worker {
  pid_t process = -1;  ///< -1: not started
  int to = -1, from = -1;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors{nullptr, &std::fclose};
  std::optional<std::size_t> cell;
  Clock::time_point since;
  std::string answer;  ///< part of a line read so far
};

WorkerPool::WorkerPool(std::vector<std::string> command, int count,
                       const scenario::CellBudget& budget)
    : command_(std::move(command)), budget_(budget) {
  VINEROW_DEMAND(count >= 1);
  for (int k = 0; k < count; ++k) workers_.push_back(std::make_unique<Worker>());
  // A dead worker is noticed on reading from it.
  std::signal(SIGPIPE, SIG_IGN);
}

WorkerPool::~WorkerPool() {
  for (const auto& worker : workers_) stop(*worker);
}

bool WorkerPool::has_free_slot() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const auto& w) { return !w->cell; });
}

bool WorkerPool::is_busy() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const auto& w) { return !!w->cell; });
}

void WorkerPool::start(Worker& worker) {
  std::vector<char*> words;
  for (std::string& word : command_) words.push_back(word.data());
  words.push_back(nullptr);
  int to[2], from[2];
  worker.errors.reset(std::tmpfile());
  if (!worker.errors || pipe2(to, O_CLOEXEC) != 0) throw_cannot_write("a worker's pipe", errno);
  if (pipe2(from, O_CLOEXEC) != 0) throw_cannot_write("a worker's pipe", errno);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw WriteError(fmt::format("no worker can be started: {}", strerror(errno)));
  if (child == 0) {
    // The driver handles Ctrl-C; the workers end if the driver is killed.
    std::signal(SIGINT, SIG_IGN);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    const rlimit no_core = {0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    dup2(to[0], STDIN_FILENO);
    dup2(from[1], STDOUT_FILENO);
    dup2(fileno(worker.errors.get()), STDERR_FILENO);
    execv("/proc/self/exe", words.data());
    _exit(127);
  }
  close(to[0]);
  close(from[1]);
  worker.process = child;
  worker.to = to[1];
  worker.from = from[0];
  worker.answer.clear();
}

void WorkerPool::stop(Worker& worker) {
  if (worker.process < 0) return;
  kill(worker.process, SIGKILL);
  waitpid(worker.process, nullptr, 0);
  close(worker.to);
  close(worker.from);
  worker.process = -1;
}

void WorkerPool::give(std::size_t cell, const std::string& identity) {
  const auto idle =
      std::find_if(workers_.begin(), workers_.end(), [](const auto& w) { return !w->cell; });
  VINEROW_DEMAND(idle != workers_.end());
  Worker& worker = **idle;
  if (worker.process < 0) start(worker);
  worker.cell = cell;
  worker.since = Clock::now();
  const std::string line = fmt::format("{} {}\n", cell, identity);
  // The line fits into the pipe; if the worker is dead, wait() notices.
  static_cast<void>(!write(worker.to, line.data(), line.size()));
}

EndedCell WorkerPool::end(Worker& worker, EndedCell::How how, std::string words) {
  const std::chrono::duration<double> wall = Clock::now() - worker.since;
  const EndedCell ended{*worker.cell, how, std::move(words), wall.count()};
  worker.cell.reset();
  return ended;
}

void WorkerPool::read_answer(Worker& worker, std::vector<EndedCell>& ended) {
  char bytes[4096];
  const ssize_t count = read(worker.from, bytes, sizeof bytes);
  if (count < 0 && errno == EINTR) return;
  if (count <= 0) {
    int status = 0;
    waitpid(worker.process, &status, 0);
    close(worker.to);
    close(worker.from);
    worker.process = -1;
    const std::string last =
        last_line_of(read_from_start(worker.errors.get())).substr(0, kLongestLine);
    const std::string how =
        WIFSIGNALED(status)
            ? fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
            : fmt::format("exit status {}", WEXITSTATUS(status));
    ended.push_back(
        end(worker, EndedCell::How::kCrashed,
            fmt::format("the program ended by {}{}{}", how, last.empty() ? "" : ": ", last)));
    return;
  }
  worker.answer.append(bytes, static_cast<std::size_t>(count));
  const std::size_t line_end = worker.answer.find('\n');
  if (line_end == std::string::npos) return;
  const std::string line = worker.answer.substr(0, line_end);
  worker.answer.erase(0, line_end + 1);
  ended.push_back(line == "stored" ? end(worker, EndedCell::How::kStored, "")
                                   : end(worker, EndedCell::How::kNotStored, line));
}

void WorkerPool::check_budget(Worker& worker, std::vector<EndedCell>& ended) {
  const std::chrono::duration<double> wall = Clock::now() - worker.since;
  if (budget_.time_s > 0.0 && wall.count() > budget_.time_s) {
    stop(worker);
    ended.push_back(end(worker, EndedCell::How::kOutOfTime,
                        fmt::format("took more than budget.time_s = {:g} s", budget_.time_s)));
    return;
  }
  if (budget_.memory_MB > 0.0 && resident_MB(worker.process) > budget_.memory_MB) {
    stop(worker);
    ended.push_back(
        end(worker, EndedCell::How::kOutOfMemory,
            fmt::format("took more than budget.memory_MB = {:g} MB", budget_.memory_MB)));
  }
}

std::vector<EndedCell> WorkerPool::wait(double longest_s) {
  std::vector<pollfd> polled;
  std::vector<Worker*> busy;
  for (const auto& worker : workers_) {
    if (!worker->cell) continue;
    busy.push_back(worker.get());
    polled.push_back({worker->from, POLLIN, 0});
  }
  std::vector<EndedCell> ended;
  if (busy.empty()) return ended;
  // The budget is checked ten times per second.
  const bool is_limited = budget_.time_s > 0.0 || budget_.memory_MB > 0.0;
  const int longest_ms =
      static_cast<int>(1e3 * (is_limited ? std::min(longest_s, 0.1) : longest_s));
  if (poll(polled.data(), polled.size(), longest_ms) < 0) return ended;
  for (std::size_t k = 0; k < busy.size(); ++k) {
    if (polled[k].revents != 0) {
      read_answer(*busy[k], ended);
    } else if (is_limited) {
      check_budget(*busy[k], ended);
    }
  }
  return ended;
}

}  // namespace vinerow::study
