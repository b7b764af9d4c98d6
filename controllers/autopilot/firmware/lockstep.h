#pragma once
/// What steps together with the simulation: a firmware that runs, or the recording of one. It deals
/// in bytes; a Dialect knows what they mean.

#include <cstdint>
#include <functional>
#include <span>

#include "engine/core/result.h"
#include "engine/core/time.h"

namespace vinerow::controllers {

using Bytes = std::span<const std::uint8_t>;

/// What a firmware gets for an instant.
struct FirmwareState {
  Bytes bytes;                 ///< valid until the next state
  std::uint64_t stamp_us = 0;  ///< of the firmware's clock, if its outputs have stamps
};

class Lockstep {
 public:
  virtual ~Lockstep() = default;
  /// States before the first one, for firmware whose clock has to move while it boots: 1, 2, ...
  using BootState = std::function<FirmwareState(std::uint64_t number)>;

  /// The first outputs. @returns a failure as a sentence without subject, "sent nothing for 10 s"
  virtual Result<Bytes> begin(Time now, const BootState& boot_state) = 0;
  /// Gives the state of an instant. It stays valid until its outputs are there.
  virtual void send_state(Time now, const FirmwareState& state) = 0;
  /// Waits for the outputs for that state. @returns them, valid until the next state; or a failure
  virtual Result<Bytes> wait_for_outputs(Time now) = 0;

  /// A datagram of MAVLink that came before the last outputs; empty: no more. Valid until the next
  /// call. ArduPilot's datagrams lie in the receiver's queue before its outputs do, so what is read
  /// after the outputs does not depend on its pace. PX4's come at any time.
  virtual Bytes next_message(Time now) = 0;
  /// Sends MAVLink to the autopilot. Nothing is sent before its first message: its port is unknown.
  virtual void send_message(Time now, Bytes bytes) = 0;
};

}  // namespace vinerow::controllers
