#include "engine/core/parallel.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

#include "engine/core/check.h"

namespace vinerow {
namespace {

/// Cores that loops of this thread may use.
thread_local std::size_t own_cores = std::max(1u, std::thread::hardware_concurrency());
thread_local std::size_t number_in_loop = 0;

/// A loop that threads work on.
class Loop {
 public:
  Loop(std::size_t count, std::size_t chunk, const ChunkBody& body)
      : body_(body), count_(count), chunk_(chunk), chunks_(count / chunk + (count % chunk != 0)) {
    threads_ = std::max<std::size_t>(1, std::min(chunks_, own_cores));
  }

  std::size_t threads() const { return threads_; }

  /// Of one thread: takes chunks until none is left.
  void work() {
    const std::size_t cores = own_cores, number = number_in_loop;
    if (threads_ > 1) own_cores = 1;
    number_in_loop = next_thread_++;
    for (std::size_t index; (index = next_++) < chunks_;) {
      try {
        body_(index, index * chunk_, std::min(count_, (index + 1) * chunk_));
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_ || index < failed_) {
          failed_ = index;
          error_ = std::current_exception();
        }
        next_ = chunks_;
      }
    }
    own_cores = cores;
    number_in_loop = number;
  }

  void throw_error() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const ChunkBody& body_;
  std::size_t count_, chunk_, chunks_, threads_;
  std::atomic<std::size_t> next_ = 0, next_thread_ = 0;
  std::mutex mutex_;
  std::size_t failed_ = 0;
  std::exception_ptr error_;
};

/// Threads that wait for loops: starting them takes as long as a small loop, and allocates memory.
class Team {
 public:
  /// The team of this process: a fork lacks its parent's threads. It is never destroyed, so
  /// that its threads need not end.
  static Team& get() {
    static std::atomic<Team*> team = nullptr;
    Team* found = team;
    if (found && found->process_ == getpid()) return *found;
    auto* const made = new Team;
    if (team.compare_exchange_strong(found, made)) return *made;
    delete made;
    return *found;
  }

  /// Works on a loop with all threads that it takes. @returns false if they work on another one:
  /// the cores are busy
  bool work(Loop& loop) {
    const std::unique_lock only(busy_, std::try_to_lock);
    if (!only) return false;
    grow(loop.threads() - 1);
    const std::size_t helpers = std::min(loop.threads() - 1, threads_);
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      to_come_ = to_leave_ = helpers;
    }
    for (std::size_t i = 0; i < helpers; ++i) wake_.notify_one();
    loop.work();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return to_leave_ == 0; });
    return true;
  }

 private:
  void grow(std::size_t threads) {
    try {
      for (; threads_ < threads; ++threads_) std::thread([this] { wait_for_loops(); }).detach();
    } catch (const std::system_error&) {
      // The system allows no more threads. The loop goes on with those that there are.
    }
  }

  void wait_for_loops() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return to_come_ > 0; });
      --to_come_;
      lock.unlock();
      loop_->work();
      lock.lock();
      if (--to_leave_ == 0) done_.notify_one();
    }
  }

  const pid_t process_ = getpid();
  std::mutex busy_;  ///< held while a loop is worked on
  std::size_t threads_ = 0;
  std::mutex mutex_;  ///< of what follows
  std::condition_variable wake_, done_;
  Loop* loop_ = nullptr;
  std::size_t to_come_ = 0, to_leave_ = 0;  ///< threads that have not begun, not ended
};

}  // namespace

ShareOfCores::ShareOfCores(std::size_t threads) : before_(own_cores) {
  VINEROW_DEMAND(threads >= 1);
  own_cores = std::max<std::size_t>(1, own_cores / threads);
}

ShareOfCores::~ShareOfCores() {
  own_cores = before_;
}

std::size_t most_threads() {
  return own_cores;
}

std::size_t thread_in_loop() {
  return number_in_loop;
}

void for_chunks(std::size_t count, std::size_t chunk, const ChunkBody& body) {
  VINEROW_DEMAND(chunk >= 1);
  Loop loop(count, chunk, body);
  if (loop.threads() == 1 || !Team::get().work(loop)) loop.work();
  loop.throw_error();
}

}  // namespace vinerow
