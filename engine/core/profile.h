#pragma once
/// Spans of computing time, for the profile of a run (`vinerow run --profile`).
///
/// Code names its work with a span, which lasts from construction to destruction:
///
///   const ProfileSpan span("search for rows");
///
/// A span changes no result. It costs a few nanoseconds unless this thread records a profile.

#include <string_view>

namespace vinerow {

/// Receives the spans of a thread.
class ProfileSink {
 public:
  virtual ~ProfileSink() = default;
  /// @param name   of a part, "rover.controller", or of other work, "trees of rays"
  /// @param stage  of a run, "control"; empty: that of the enclosing span
  virtual void begin(std::string_view name, std::string_view stage) = 0;
  /// Ends the last span that began.
  virtual void end() = 0;
  /// From now on, work of the owner belongs to this phase of a mission.
  /// @param owner  vehicle, the first word of its parts' names; empty: everything else
  virtual void set_phase(std::string_view owner, std::string_view phase) = 0;
};

/// Sends the spans of this thread to a sink while it lives. @param sink  outlives it; may be null
class ProfileRecording {
 public:
  explicit ProfileRecording(ProfileSink* sink);
  ~ProfileRecording();
  ProfileRecording(const ProfileRecording&) = delete;
  ProfileRecording& operator=(const ProfileRecording&) = delete;

 private:
  ProfileSink* before_;
};

class ProfileSpan {
 public:
  /// Parameters as ProfileSink::begin().
  explicit ProfileSpan(std::string_view name, std::string_view stage = {});
  ~ProfileSpan();
  ProfileSpan(const ProfileSpan&) = delete;
  ProfileSpan& operator=(const ProfileSpan&) = delete;

 private:
  ProfileSink* sink_;
};

/// Passes the phase to the sink of this thread, if there is one. Parameters as
/// ProfileSink::set_phase().
void set_profile_phase(std::string_view owner, std::string_view phase);

}  // namespace vinerow
