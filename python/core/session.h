#pragma once
/// vinerow.Session in C++: a session, and the checks that Python needs around it.

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>

#include "engine/sim/session.h"
#include "python/core/guard.h"
#include "python/core/scenario.h"

namespace vinerow::python {

class PythonSession {
 public:
  explicit PythonSession(Session session) : session_(std::move(session)) {}

  /// The only access to the session: checks that it is open, belongs to this process, and is not in
  /// use by another thread. Releases the session in its destructor.
  class Use {
   public:
    /// @throws UsageError
    explicit Use(PythonSession& owner);
    Session* operator->() const { return &*owner_.session_; }
    Session& operator*() const { return *owner_.session_; }

   private:
    PythonSession& owner_;
    Guard::Use hold_;
  };

  /// Processes every instant up to and including `until`, without the interpreter's lock. Ctrl-C
  /// ends it between two instants.
  void step(Time until);
  /// Processes the instants of the next `duration`. @throws UsageError if it is shorter than a step
  void step_for(Duration duration);
  void reset(std::optional<std::uint64_t> seed);
  std::shared_ptr<PythonSession> twin();
  void close();
  bool closed() const { return !session_; }

  /// Grows with each reset and with closing: signals notice with it that their run is over.
  std::uint64_t run_number() const { return run_number_; }

 private:
  void step(Use& use, Time until);

  std::optional<Session> session_;
  std::uint64_t run_number_ = 0;
  Guard guard_{{"the session belongs to the process that opened it; open sessions after the fork",
                "the session is in use by another thread; give each thread its own (twin())"}};
};

void bind_session(pybind11::module_& module);

}  // namespace vinerow::python
