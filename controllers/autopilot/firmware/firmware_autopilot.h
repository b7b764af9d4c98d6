#pragma once
/// A vehicle's firmware in lock-step with the run: its states, its outputs, its MAVLink.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "controllers/autopilot/firmware/dialect.h"
#include "controllers/autopilot/firmware/firmware_params.h"
#include "controllers/autopilot/firmware/running_lockstep.h"
#include "controllers/autopilot/mavlink/firmware_link.h"
#include "engine/api/may_fail.h"
#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// What every autopilot reads and writes.
PartSpec firmware_spec(const char* name, const char* description);

/// Mission, parameters, commands and limits of the scenario for the firmware's MAVLink. Firmware
/// that was started with the parameters gets them again: names that it does not know come out.
/// @throws ConfigError if the mission or the file of parameters has a mistake
FirmwareLinkOptions firmware_link_options(const FirmwareParams& params);

/// Parameters of the scenario: those of the file, replaced by those of the list.
/// @throws ConfigError if the file has a mistake
std::vector<FirmwareParameter> user_parameters(const FirmwareParams& params);

/// Options of a lock-step that do not depend on the firmware: addresses, limits, the recording.
/// @param protocol, port  of the outputs
/// @throws ConfigError if the address or the name of the recording is wrong, or another autopilot
/// of the run has one of the ports
RunningLockstepOptions running_options(const FirmwareParams& params, Protocol protocol, int port,
                                       int mavlink_port, const AutopilotContext& context,
                                       const std::string& who);

/// Path of a program: a name alone is looked for in the folder that an environment variable names.
std::string find_program(const std::string& name, const char* variable);

class FirmwareAutopilot final : public Autopilot, public MayFail {
 public:
  /// @param link  absent: without MAVLink
  FirmwareAutopilot(double finish_at_s, std::optional<FirmwareLinkOptions> link,
                    std::unique_ptr<Lockstep> lockstep, std::unique_ptr<Dialect> dialect,
                    const AutopilotContext& context, const std::string& type);

  void connect(Ports& ports) override;
  void step(Time now) override;
  void finish_step(Time now) override;
  bool finished() const override;
  std::string_view failure() const override { return failure_; }

 private:
  [[noreturn]] void fail(Time now, const std::string& reason) const;
  void begin(Time now);
  void check(Time now, const std::string& fault) const;
  void listen(Time now);
  void wait_for_sensor(Time now, std::string_view sensor);

  double finish_at_s_;
  std::string who_, part_;
  Duration period_;
  std::unique_ptr<Lockstep> lockstep_;
  std::unique_ptr<Dialect> dialect_;
  NamedValues actuators_;
  std::optional<FirmwareLink> link_;
  std::string failure_;
  Time now_;
  std::optional<Time> first_step_;
  bool has_begun_ = false, is_waiting_ = false, has_complained_ = false;
  std::uint64_t steps_ = 0;

  SignalWriter<NamedValues> actuators_writer_, outputs_writer_;
  SignalWriter<Event> event_;
};

}  // namespace vinerow::controllers
