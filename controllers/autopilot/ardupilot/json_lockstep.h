#pragma once
/// Lock-step with an ArduPilot that runs, by its JSON interface.

#include <optional>
#include <string>
#include <utility>

#include "controllers/autopilot/ardupilot/lockstep_link.h"
#include "controllers/autopilot/firmware/running_lockstep.h"

namespace vinerow::controllers {

class JsonLockstep final : public RunningLockstep {
 public:
  using RunningLockstep::RunningLockstep;

  /// @throws ConfigError if a port is taken or the program cannot be started
  Result<Bytes> begin(Time now, const BootState& boot_state) override;
  void send_state(Time now, const FirmwareState& state) override;
  Result<Bytes> wait_for_outputs(Time now) override;

 private:
  Result<Bytes> recorded(Time now, const Result<ServoPacket>& packet);

  std::optional<LockstepLink> link_;
};

}  // namespace vinerow::controllers
