#pragma once
/// A run with peers: its control, its messages, its services and its parameters, for servers of any
/// protocol.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/live/entities.h"
#include "engine/live/message_hub.h"
#include "engine/live/run_control.h"
#include "engine/live/services.h"
#include "engine/run/run_driver.h"

namespace vinerow::live {

/// A server's view of changes. Called from the run's thread, on_status() from any; must return at
/// once.
class RunListener {
 public:
  virtual ~RunListener() = default;
  /// The run begins, also after a restart: the hub's channels are new. Observers may be added.
  virtual void on_begin(Simulation& /*simulation*/) {}
  virtual void on_end() {}
  virtual void on_status(RunControl::Level, const std::string& /*sentence*/) {}
};

/// A signal that peers may write.
struct CommandPort {
  std::string signal;                  ///< "rover/cmd_vel"; its topic is "/rover/cmd_vel"
  std::string message_type;            ///< "VelocityCommand"
  std::vector<std::string> ros_types;  ///< accepted, the preferred one first
};

class LiveRun final : public run::RunDriver {
 public:
  /// @param say  receives sentences for people besides the listeners; may be empty
  LiveRun(ControlOptions options, RunControl::Notify say);
  ~LiveRun() override;

  RunControl& control() { return control_; }
  Services& services() { return services_; }
  const Entities& entities() const { return entities_; }

  /// @param built  called in the run's thread when the run is built for the first time
  void on_built(std::function<void(const Simulation&)> built) { built_ = std::move(built); }
  /// Sends a sentence to people and listeners. From any thread.
  void say(RunControl::Level level, const std::string& sentence);

  /// Listeners outlive their registration, and are not removed while the run goes on.
  void add_listener(RunListener* listener);
  void remove_listener(RunListener* listener);

  /// Messages of the present run; null before it begins. A restart makes a new hub.
  std::shared_ptr<MessageHub> hub() const;
  std::vector<CommandPort> command_ports() const;

  /// Names and values of all parameters: those of the run ("speed", "paused", "seed", ...) and the
  /// scenario's ("scenario.rover.controller.lookahead_m").
  nlohmann::json parameters() const;
  /// Parameters that change during a run; a part of parameters().
  nlohmann::json changing_parameters() const;
  /// @returns "" or the reason why the value is refused
  std::string set_parameter(const std::string& name, const nlohmann::json& value);

  /// Decodes a command of a peer and gives it to the run.
  /// @param topic  with or without the first slash
  /// @param encoding  "cdr" or "json"
  /// @returns "" or the reason why it is refused
  std::string publish(const std::string& topic, const std::string& ros_type,
                      const std::string& encoding, std::span<const std::uint8_t> bytes,
                      const std::string& peer, Answer refused = {});
  /// Whether a topic takes commands of a type. @returns "" or the reason why not
  std::string check_publisher(const std::string& topic, const std::string& ros_type,
                              const std::string& encoding) const;

  void begin(Session& session) override;
  Next next(Session& session, Time slice_end) override;
  void end(Session& session) override;

 private:
  /// A copy: listeners are called without a lock, because they ask this object.
  std::vector<RunListener*> listeners() const;
  CommandPort find_port(const std::string& topic) const;

  const RunControl::Notify say_;
  std::function<void(const Simulation&)> built_;
  RunControl control_;
  Entities entities_;
  Services services_;
  mutable std::mutex mutex_;
  std::vector<RunListener*> listeners_;
  std::shared_ptr<MessageHub> hub_;
  std::vector<CommandPort> ports_;
  std::shared_ptr<const nlohmann::json> fixed_;  ///< parameters that do not change during a run
};

}  // namespace vinerow::live
