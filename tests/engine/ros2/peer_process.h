#pragma once
/// A program of another process that is started, stopped and read by a test.

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <vector>

namespace vinerow::ros2 {

class PeerProcess {
 public:
  explicit PeerProcess(std::vector<std::string> command) {
    int to_peer[2], from_peer[2];
    if (pipe(to_peer) != 0 || pipe(from_peer) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      dup2(to_peer[0], STDIN_FILENO);
      dup2(from_peer[1], STDOUT_FILENO);
      for (const int end : {to_peer[0], to_peer[1], from_peer[0], from_peer[1]}) close(end);
      std::vector<char*> arguments;
      for (std::string& word : command) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    close(to_peer[0]);
    close(from_peer[1]);
    input_ = to_peer[1];
    output_ = from_peer[0];
  }
  ~PeerProcess() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    close(input_);
    close(output_);
  }
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  void signal(int number) const { kill(pid_, number); }

  /// Reads lines until one starts with `start`. @returns that line, or empty after `patience`
  std::string wait_for(const std::string& start,
                       std::chrono::milliseconds patience = std::chrono::seconds(10)) {
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
      for (std::size_t line_end; (line_end = text_.find('\n')) != std::string::npos;) {
        std::string line = text_.substr(0, line_end);
        text_.erase(0, line_end + 1);
        if (line.starts_with(start)) return line;
      }
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          end - std::chrono::steady_clock::now());
      pollfd output{output_, POLLIN, 0};
      if (left.count() <= 0 || poll(&output, 1, static_cast<int>(left.count())) <= 0) return {};
      char bytes[4096];
      const ssize_t size = read(output_, bytes, sizeof bytes);
      if (size <= 0) return {};
      text_.append(bytes, static_cast<std::size_t>(size));
    }
  }

 private:
  pid_t pid_ = -1;
  int input_ = -1, output_ = -1;
  std::string text_;
};

}  // namespace vinerow::ros2
