#pragma once
/// What a firmware means by its bytes: which state it gets, and what its outputs do.

#include <cstdint>
#include <string>
#include <string_view>

#include "controllers/autopilot/firmware/lockstep.h"
#include "engine/api/messages/commands.h"
#include "engine/api/signal.h"

namespace vinerow::controllers {

class Dialect {
 public:
  virtual ~Dialect() = default;
  virtual void connect(Ports& ports) = 0;
  /// A sensor that the state needs and that has sent nothing yet; empty: none.
  virtual std::string_view missing_sensor() const = 0;
  /// See Lockstep::BootState.
  virtual FirmwareState boot_state(std::uint64_t number) = 0;
  /// @param outputs  the first ones. @returns what is wrong with them; empty: nothing
  virtual std::string begin(Time now, Bytes outputs) = 0;
  /// @returns the state of an instant, or a failure as Lockstep has them
  virtual Result<FirmwareState> write_state(Time now) = 0;
  /// Actuators with their names, all zero.
  virtual NamedValues make_actuators() const = 0;
  /// @returns what is wrong with the outputs; empty: nothing
  virtual std::string take_outputs(Bytes outputs, NamedValues& actuators) = 0;
  /// The outputs that were taken last, for the log.
  virtual const NamedValues& outputs() const = 0;
};

}  // namespace vinerow::controllers
