#include "controllers/autopilot/ardupilot/running_lockstep.h"

#include "engine/core/whole_file.h"

namespace vinerow::controllers {

LockstepLink::GaveUp RunningLockstep::gave_up() {
  return [this] { return process_ ? process_->ending() : std::string(); };
}

void RunningLockstep::record(Time now, mavlink::UdpAddress from, mavlink::UdpAddress to,
                             std::span<const std::uint8_t> bytes) {
  if (recorder_) recorder_->add(now, from, to, bytes);
}

Result<ServoPacket> RunningLockstep::begin(Time now) {
  link_.emplace(options_.own, who_);
  if (options_.mavlink) mavlink_.emplace(*options_.mavlink, who_);
  if (!options_.record.empty()) {
    std::filesystem::create_directories(options_.record.parent_path());
    recorder_.emplace(options_.record);
  }
  if (!options_.command.empty()) {
    std::filesystem::create_directories(options_.folder);
    write_whole_file(options_.folder / kParameterFile, options_.parameters);
    process_ = std::make_unique<ChildProcess>(options_.command, options_.folder, who_);
  }
  auto packet = link_->wait_for_first(options_.start_limit, gave_up());
  if (packet) record(now, theirs(), options_.own, link_->last_packet());
  return packet;
}

void RunningLockstep::send_state(Time now, std::string_view line) {
  record(now, options_.own, theirs(),
         {reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
  link_->answer(line);
}

Result<ServoPacket> RunningLockstep::wait_for_outputs(Time now) {
  auto packet = link_->wait_for_next(options_.answer_limit, gave_up());
  if (packet) record(now, theirs(), options_.own, link_->last_packet());
  return packet;
}

std::span<const std::uint8_t> RunningLockstep::next_message(Time now) {
  if (!mavlink_) return {};
  const auto datagram = mavlink_->receive(std::chrono::milliseconds(0));
  if (!datagram) return {};
  mavlink_peer_ = datagram->from;
  record(now, theirs(), *options_.mavlink, datagram->bytes);
  return datagram->bytes;
}

void RunningLockstep::send_message(Time now, std::span<const std::uint8_t> bytes) {
  if (!mavlink_peer_) return;
  record(now, *options_.mavlink, theirs(), bytes);
  mavlink_->send(bytes, *mavlink_peer_);
}

}  // namespace vinerow::controllers
