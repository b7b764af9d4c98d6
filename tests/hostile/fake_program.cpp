/// What can be wrong with a program that reads a damaged file, as a word: for hostile_test.py.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <unistd.h>
#include <vector>

int served_main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "abort") std::abort();
  if (what == "hang") pause();
  if (what == "large") {
    std::vector<char> most(300u << 20u);
    std::memset(most.data(), 1, most.size());
    return most[most.size() / 2] == 1 ? 0 : 4;
  }
  if (what == "refuse") std::fputs("vinerow: no such thing\n", stderr);
  if (what == "refuse" || what == "refuse_silently") return 2;
  if (what == "folder") return access("here", R_OK) == 0 ? 0 : 4;
  return what == "words" && argc == 3 && std::string(argv[2]) == "two words" ? 0 : 5;
}

#ifdef FAKE_OWN_MAIN
int main(int argc, char** argv) { return served_main(argc, argv); }
#endif
