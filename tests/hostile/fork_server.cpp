/// The command as often as wanted for one start: linking and a sanitizer's own start cost more than most damaged files.
///
/// A line of stdin is a folder and the words of the command, with tabs between them. The answer is the id of the process that runs
/// them there (it leads a process group, so that it can be killed), and at its end "<wait status> <seconds of processor> <peak in kB>".
/// Its stderr is the file VINEROW_FORK_ERRORS, emptied before.
/// VINEROW_FORK_BYTES limits its addresses.

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

/// main() of the program that is served, under another name.
int served_main(int argc, char** argv);

namespace {

constexpr int kCannotStart = 125;

void limit(decltype(RLIMIT_CORE) what, rlim_t most) {
  const rlimit both = {most, most};
  if (setrlimit(what, &both) != 0) _exit(kCannotStart);
}

void redirect(const char* file, int mode, int to) {
  const int opened = open(file, mode, 0600);
  if (opened < 0 || dup2(opened, to) < 0) _exit(kCannotStart);
  close(opened);
}

[[noreturn]] void serve(std::vector<std::string> words, const char* errors) {
  setsid();
  redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  redirect("/dev/null", O_WRONLY, STDOUT_FILENO);
  redirect(errors, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  if (chdir(words[0].c_str()) != 0) _exit(kCannotStart);
  limit(RLIMIT_CORE, 0);
  if (const char* bytes = std::getenv("VINEROW_FORK_BYTES")) limit(RLIMIT_AS, std::strtoull(bytes, nullptr, 10));
  words[0] = "vinerow";
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::exit(served_main(static_cast<int>(words.size()), arguments.data()));
}

double seconds_of(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

}  // namespace

int main() {
  const char* errors = std::getenv("VINEROW_FORK_ERRORS");
  if (errors == nullptr) return 2;
  std::string line;
  while (std::getline(std::cin, line)) {
    std::vector<std::string> words;
    std::istringstream parts(line);
    for (std::string word; std::getline(parts, word, '\t');) words.push_back(word);
    if (words.size() < 2) return 2;
    const pid_t child = fork();
    if (child == 0) serve(words, errors);
    if (child < 0) return 3;
    std::printf("%d\n", child);
    std::fflush(stdout);
    int status = 0;
    rusage used = {};
    if (wait4(child, &status, 0, &used) != child) return 3;
    std::printf("%d %.6f %ld\n", status, seconds_of(used.ru_utime) + seconds_of(used.ru_stime), used.ru_maxrss);
    std::fflush(stdout);
  }
  return 0;
}
