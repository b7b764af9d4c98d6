#pragma once
/// vinerow.Session in C++: a session, and the checks that Python needs around it.

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "engine/sim/session.h"

namespace vinerow::python {

/// A loaded scenario with the parts that it needs. Immutable.
struct LoadedScenario {
  scenario::Scenario scenario;
  std::shared_ptr<const Registry> registry;
};

class PythonSession : public std::enable_shared_from_this<PythonSession> {
 public:
  PythonSession(std::shared_ptr<const LoadedScenario> loaded, SessionOptions options);
  PythonSession(std::shared_ptr<const LoadedScenario> loaded, Session session);

  /// The only access to the session: checks that it is open, belongs to this process, and is not in
  /// use by another thread. Releases the session in its destructor.
  class Use {
   public:
    explicit Use(PythonSession& owner);
    ~Use() { owner_.busy_.store(false, std::memory_order_release); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Session* operator->() const { return &*owner_.session_; }
    Session& operator*() const { return *owner_.session_; }

   private:
    PythonSession& owner_;
  };

  /// Steps without the interpreter's lock. Ctrl-C ends it between two instants.
  void step(Time until);
  void reset(std::optional<std::uint64_t> seed);
  std::shared_ptr<PythonSession> twin();
  void close();
  bool closed() const { return !session_; }

  const LoadedScenario& loaded() const { return *loaded_; }
  /// Number of resets so far: signals notice with it that their arrays belong to an earlier run.
  std::uint64_t run_number() const { return run_number_; }

 private:
  std::shared_ptr<const LoadedScenario> loaded_;
  std::optional<Session> session_;
  std::atomic<bool> busy_ = false;
  std::uint64_t run_number_ = 0;
  pid_t process_ = getpid();
};

void bind_session(pybind11::module_& module);

}  // namespace vinerow::python
