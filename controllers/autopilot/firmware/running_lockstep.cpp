#include "controllers/autopilot/firmware/running_lockstep.h"

#include <fmt/format.h>

#include "engine/core/whole_file.h"

namespace vinerow::controllers {

void RunningLockstep::start() {
  if (options_.mavlink) mavlink_.emplace(*options_.mavlink, who_);
  if (!options_.record.empty()) {
    std::filesystem::create_directories(options_.record.parent_path());
    recorder_.emplace(options_.record);
  }
  if (options_.command.empty()) return;
  std::filesystem::create_directories(options_.folder);
  for (const auto& [name, text] : options_.files) write_whole_file(options_.folder / name, text);
  process_ =
      std::make_unique<ChildProcess>(options_.command, options_.environment, options_.folder, who_);
}

bool RunningLockstep::has_heard() const {
  return !mavlink_ || mavlink_->has_datagram();
}

void RunningLockstep::record(Time now, mavlink::UdpAddress from, mavlink::UdpAddress to,
                             Bytes bytes) {
  if (recorder_) recorder_->add(now, from, to, bytes);
}

Bytes RunningLockstep::next_message(Time now) {
  if (!mavlink_) return {};
  const auto datagram = mavlink_->receive(std::chrono::milliseconds(0));
  if (!datagram) return {};
  mavlink_peer_ = datagram->from;
  record(now, theirs(), *options_.mavlink, datagram->bytes);
  return datagram->bytes;
}

void RunningLockstep::send_message(Time now, Bytes bytes) {
  if (!mavlink_peer_) return;
  record(now, *options_.mavlink, theirs(), bytes);
  mavlink_->send(bytes, *mavlink_peer_);
}

std::string seconds_text(std::chrono::milliseconds time) {
  return fmt::format("{:g} s", std::chrono::duration<double>(time).count());
}

}  // namespace vinerow::controllers
