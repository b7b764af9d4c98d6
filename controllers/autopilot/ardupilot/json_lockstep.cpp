#include "controllers/autopilot/ardupilot/json_lockstep.h"

namespace vinerow::controllers {

Result<Bytes> JsonLockstep::recorded(Time now, const Result<ServoPacket>& packet) {
  if (!packet) return Failure{packet.reason()};
  record_outputs(now, link_->last_packet());
  return link_->last_packet();
}

Result<Bytes> JsonLockstep::begin(Time now, const BootState& /*boot_state*/) {
  link_.emplace(options().own, who());
  start();
  return recorded(now, link_->wait_for_first(options().start_limit, [this] { return ending(); }));
}

void JsonLockstep::send_state(Time now, const FirmwareState& state) {
  record_state(now, state.bytes);
  link_->answer({reinterpret_cast<const char*>(state.bytes.data()), state.bytes.size()});
}

Result<Bytes> JsonLockstep::wait_for_outputs(Time now) {
  return recorded(now, link_->wait_for_next(options().answer_limit, [this] { return ending(); }));
}

}  // namespace vinerow::controllers
