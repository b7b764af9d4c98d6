#pragma once
/// Checks of an object that only its own process and one thread at a time may use.

#include <unistd.h>

#include <atomic>

#include "python/core/usage_error.h"

namespace vinerow::python {

class Guard {
 public:
  /// Holds the guarded object until its end. @throws UsageError
  class Use {
   public:
    explicit Use(Guard& guard) : guard_(guard) {
      if (guard_.process_ != getpid()) {
        throw UsageError(
            "the environment belongs to the process that made it; make environments after the "
            "fork");
      }
      if (guard_.busy_.exchange(true, std::memory_order_acquire)) {
        throw UsageError("the environment is in use by another thread; give each thread its own");
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
  pid_t process_ = getpid();
  std::atomic<bool> busy_ = false;
};

}  // namespace vinerow::python
