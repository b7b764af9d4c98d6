#pragma once
/// Lock-step with a PX4 that runs: it connects by TCP, and its outputs carry the stamp of the state
/// that they answer.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "controllers/autopilot/firmware/running_lockstep.h"
#include "engine/mavlink/frame.h"
#include "engine/mavlink/messages.h"
#include "engine/mavlink/tcp_server.h"

namespace vinerow::controllers {

class HilLockstep final : public RunningLockstep {
 public:
  using RunningLockstep::RunningLockstep;

  /// PX4 boots while its clock moves: it gets states in its own pace until it has sent outputs and,
  /// if MAVLink is used, something there. After the first outputs each state waits for its answer.
  /// The returned outputs have the stamp of the last of these states.
  Result<Bytes> begin(Time now, const BootState& boot_state) override;
  void send_state(Time now, const FirmwareState& state) override;
  Result<Bytes> wait_for_outputs(Time now) override;

 private:
  /// @returns true once outputs with this stamp or a later one have come
  bool receive(std::uint64_t stamp_us, std::chrono::milliseconds limit);
  /// @returns a reason to give up; empty: wait
  std::string gone();
  Result<Bytes> wait_for(std::uint64_t stamp_us);
  Result<Bytes> boot(const BootState& boot_state);

  std::optional<mavlink::TcpServer> server_;
  mavlink::FrameReader reader_;
  mavlink::FrameWriter writer_{mavlink::Sender{1, 1}};
  std::optional<mavlink::HilActuatorControls> controls_;  ///< the last ones
  std::uint64_t stamp_us_ = 0;                            ///< of the last state
};

}  // namespace vinerow::controllers
