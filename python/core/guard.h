#pragma once
/// Checks of an object that only its own process and one thread at a time may use.

#include <unistd.h>

#include <atomic>

#include "python/core/usage_error.h"

namespace vinerow::python {

class Guard {
 public:
  /// Sentences of the errors. Texts that live as long as the program.
  struct Sentences {
    const char* other_process;
    const char* other_thread;
  };
  explicit Guard(const Sentences& sentences) : sentences_(sentences) {}

  /// Holds the guarded object until its end. @throws UsageError
  class Use {
   public:
    explicit Use(Guard& guard) : guard_(guard) {
      if (!guard_.in_own_process()) throw UsageError(guard_.sentences_.other_process);
      if (guard_.busy_.exchange(true, std::memory_order_acquire)) {
        throw UsageError(guard_.sentences_.other_thread);
      }
    }
    ~Use() { guard_.busy_.store(false, std::memory_order_release); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Guard& guard_;
  };

  bool in_own_process() const { return process_ == getpid(); }

 private:
  Sentences sentences_;
  pid_t process_ = getpid();
  std::atomic<bool> busy_ = false;
};

}  // namespace vinerow::python
