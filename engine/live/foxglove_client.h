#pragma once
/// One client of a live run that speaks Foxglove's WebSocket protocol, without its socket.
///
/// Source: https://github.com/foxglove/ws-protocol, docs/spec.md, "Foxglove WebSocket protocol v1"
/// (subprotocols foxglove.websocket.v1 and foxglove.sdk.v1).

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "engine/live/live_run.h"
#include "engine/live/outbox.h"

namespace vinerow::live {

/// Names of the protocol, the preferred one first.
inline constexpr const char* kFoxgloveProtocols[] = {"foxglove.sdk.v1", "foxglove.websocket.v1"};

/// All functions but receive(), has_room() and miss() are called from the server's thread.
class FoxgloveClient final : public Subscriber,
                             public std::enable_shared_from_this<FoxgloveClient> {
 public:
  /// @param run  outlives this object. @param name  "client 3". @param session_id  of the server
  /// @param wake  Outbox's
  FoxgloveClient(LiveRun& run, std::string name, std::string session_id,
                 std::function<void()> wake);

  /// Greets the client: what the server can do, channels, services. Call again after a restart of
  /// the run: the client then finds other channels under the same ids.
  void greet();
  void on_text(std::string_view text);
  void on_binary(std::span<const std::uint8_t> bytes);
  /// Call about 20 times a second: simulated time, changed parameters, dropped messages.
  void tick();
  void send_status(RunControl::Level level, const std::string& sentence,
                   const std::string& id = "");
  /// Ends subscriptions and ownership of commands.
  void leave();

  Outbox& outbox() { return outbox_; }
  const std::string& name() const { return name_; }

  void receive(const Message& message) override;
  bool has_room() const override { return outbox_.has_room(); }
  void miss() override { outbox_.miss(); }

 private:
  struct ClientChannel {
    std::string topic, encoding, type;
    std::string last_refusal;
  };

  void send(const nlohmann::json& message);
  void handle(const nlohmann::json& message);
  void subscribe(const nlohmann::json& message);
  void unsubscribe(const nlohmann::json& message);
  void advertise(const nlohmann::json& message);
  void unadvertise(const nlohmann::json& message);
  void get_parameters(const nlohmann::json& message);
  void set_parameters(const nlohmann::json& message);
  void subscribe_parameters(const nlohmann::json& message, bool on);
  void publish(std::span<const std::uint8_t> bytes);
  void call_service(std::span<const std::uint8_t> bytes);
  void send_parameters(const nlohmann::json& values, const std::string& id);

  LiveRun& run_;
  const std::string name_;
  const std::string session_id_;
  Outbox outbox_;
  std::shared_ptr<MessageHub> hub_;                       ///< that the subscriptions belong to
  std::map<std::uint32_t, std::uint16_t> subscriptions_;  ///< id of the client's -> channel
  std::mutex ids_mutex_;
  std::map<std::uint16_t, std::uint32_t> ids_;       ///< channel -> id of the client's
  std::map<std::uint32_t, ClientChannel> channels_;  ///< that the client publishes
  std::set<std::string> watched_;                    ///< parameters; "" = all
  std::map<std::string, std::string> sent_values_;   ///< of watched parameters, as text
  std::int64_t sent_time_ns_ = -1;
};

}  // namespace vinerow::live
