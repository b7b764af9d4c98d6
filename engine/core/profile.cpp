#include "engine/core/profile.h"

namespace vinerow {
namespace {

thread_local ProfileSink* profile_sink = nullptr;

}  // namespace

ProfileRecording::ProfileRecording(ProfileSink* sink) : before_(profile_sink) {
  profile_sink = sink;
}

ProfileRecording::~ProfileRecording() {
  profile_sink = before_;
}

ProfileSpan::ProfileSpan(std::string_view name, std::string_view stage) : sink_(profile_sink) {
  if (sink_) sink_->begin(name, stage);
}

ProfileSpan::~ProfileSpan() {
  if (sink_) sink_->end();
}

void set_profile_phase(std::string_view owner, std::string_view phase) {
  if (profile_sink) profile_sink->set_phase(owner, phase);
}

}  // namespace vinerow
