#include "tests/fuzz/read_live_frames.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "engine/api/messages.h"
#include "engine/api/vehicle.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/live/command_codec.h"
#include "engine/live/foxglove_client.h"
#include "engine/live/message_json.h"
#include "engine/live/request_check.h"
#include "engine/record/cdr.h"
#include "engine/record/ros_schema.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/session.h"
#include "vehicles/register_vehicles.h"
#include "worlds/register_worlds.h"

namespace vinerow::fuzz {
namespace {

using live::LiveRun;
using live::RunControl;
using nlohmann::json;

constexpr int kFrameKinds = static_cast<int>(LiveFrame::kRequest) + 1;
constexpr std::size_t kLengthBytes = 2;
constexpr int kMostFrames = 64;
constexpr int kMostSlices = 24;  // of one input
// Long enough for a stack of calls that grows with the nesting of a text.
constexpr std::size_t kLongestText = 1 << 17;

constexpr const char* kScenario = R"(
vinerow: 1
name: fuzzed
duration_s: 0.4
world:
  type: vineyard
  row_count: 2
  row_length_m: 3
  headland_m: 8
  surroundings_m: 0
  terrain_cell_m: 4
  relief_m: 0
  waves_m: 0
  posts: false
  leaf_cards_per_m: 10
  plant_variants: 1
vehicles:
  rover:
    type: diff_drive_rover
    spawn: {alley: 0}
    controller: {type: command_taker}
)";
// Nobody waits for a command: the run goes on at once without it.
constexpr const char* kLockstep =
    "lockstep: {topic: rover/cmd_VelocityCommand, rate_Hz: 50, timeout_s: 1.0e-9, on_timeout: "
    "continue}\n";

std::string signal_of(const std::string& type) {
  return "cmd_" + type;
}

/// Takes commands of several types, and stands.
class CommandTaker final : public Controller {
 public:
  explicit CommandTaker(const ControllerContext& context) {
    for (const ActuatorSpec& actuator : context.vehicle_description->actuators) {
      values_.names.push_back(actuator.name);
      values_.values.push_back(0.0);
    }
  }
  void connect(Ports& ports) override {
    for_each_message_type([&]<class T>(T*) {
      if (is_taken(T::kType)) ports.read_from_outside<T>(signal_of(T::kType));
    });
    actuators_ = ports.write<NamedValues>("actuators");
  }
  void step(Time now) override { actuators_.write(now, values_); }

 private:
  NamedValues values_;
  SignalWriter<NamedValues> actuators_;
};

std::shared_ptr<const Registry> make_parts() {
  auto parts = std::make_shared<Registry>();
  worlds::register_worlds(*parts);
  vehicles::register_vehicles(*parts);
  PartSpec spec;
  spec.name = "command_taker";
  spec.description = "Takes commands of several types from outside.";
  spec.default_rate_Hz = 100.0;
  for_each_message_type([&]<class T>(T*) {
    if (is_taken(T::kType)) spec.reads.push_back(signal_of(T::kType));
  });
  spec.writes = {"actuators"};
  parts->add_controller(spec, [](const ParameterSet&, const ControllerContext& context) {
    return std::make_unique<CommandTaker>(context);
  });
  return parts;
}

/// A type of message with the types of ROS that carry it, and their definitions.
struct CommandType {
  std::string message_type;
  std::vector<std::string> ros_types;
  std::vector<record::RosSchema> schemas;
};

const std::vector<CommandType>& all_command_types() {
  static const std::vector<CommandType> types = [] {
    std::vector<CommandType> all;
    for_each_message_type([&]<class T>(T*) {
      CommandType type{T::kType, live::command_types(T::kType), {}};
      for (const std::string& ros_type : type.ros_types) {
        type.schemas.push_back(
            record::RosSchema::parse(ros_type, live::command_definition(T::kType, ros_type)));
      }
      all.push_back(std::move(type));
    });
    return all;
  }();
  return types;
}

std::span<const std::uint8_t> view_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  VINEROW_DEMAND(bytes.size() >= at + sizeof value);
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

bool has_null(const json& value) {
  return value.is_null() ||
         (value.is_structured() && std::any_of(value.begin(), value.end(), has_null));
}

/// A scenario's session, which inputs share until one of them moves it.
struct Stage {
  explicit Stage(const std::string& more)
      : scenario(scenario::parse_scenario(kScenario + more, ".", *parts())),
        session(scenario, parts()) {}
  static std::shared_ptr<const Registry> parts() {
    static const std::shared_ptr<const Registry> registry = make_parts();
    return registry;
  }
  scenario::Scenario scenario;
  Session session;
  std::unique_ptr<LiveRun> run;
  bool has_begun = false;
};

/// One input.
class Play {
 public:
  Play(Stage& stage, std::uint8_t flags) : stage_(stage), has_two_clients_(flags & kTwoClients) {
    if (!stage.run || (stage.has_begun && (flags & kNotBegun))) {
      live::ControlOptions options{.speed = 0.0, .paused = true};
      if (!stage.scenario.lockstep.signal.empty()) options.lockstep = stage.scenario.lockstep;
      stage.session.reset();
      stage.run = std::make_unique<LiveRun>(options, nullptr);
      stage.has_begun = false;
    }
    if (!(flags & kNotBegun)) begin();
    control().set_speed(0.0);
    flags& kNotPaused ? control().resume() : control().pause();
    for (const char* name : {"client 1", "client 2"}) {
      if (!clients_.empty() && !has_two_clients_) break;
      clients_.push_back(
          std::make_shared<live::FoxgloveClient>(*stage.run, name, "session", [] {}));
      clients_.back()->greet();
    }
  }

  void frame(LiveFrame kind, std::string_view payload) {
    live::FoxgloveClient& client =
        *clients_[has_two_clients_ ? static_cast<std::size_t>(tally_.frames) % 2 : 0];
    ++tally_.frames;
    switch (kind) {
      case LiveFrame::kText:
        client.on_text(payload);
        break;
      case LiveFrame::kLongText:
        client.on_text(long_text(payload));
        break;
      case LiveFrame::kBinary:
        binary(client, payload);
        break;
      case LiveFrame::kGoOn:
        go_on();
        break;
      case LiveFrame::kClient:
        act(client, payload);
        break;
      case LiveFrame::kCdrCommand:
      case LiveFrame::kJsonCommand:
        command(payload, kind == LiveFrame::kJsonCommand);
        break;
      case LiveFrame::kCdrRequest:
        request(payload);
        break;
      case LiveFrame::kRequest:
        http_request(payload);
        break;
    }
    drain();
  }

  /// Every call has its answer once the run has ended.
  LiveTally finish() {
    for (const auto& client : clients_) client->tick();
    if (is_moved_) {
      begin();
      stage_.run->end(stage_.session);
    }
    drain();
    VINEROW_DEMAND(open_calls_ == 0);
    for (const auto& client : clients_) client->leave();
    if (is_moved_) stage_.run = nullptr;
    return tally_;
  }

 private:
  RunControl& control() { return stage_.run->control(); }

  void begin() {
    if (std::exchange(stage_.has_begun, true)) return;
    stage_.run->begin(stage_.session);
    for (const auto& client : clients_) client->greet();
  }

  static std::string long_text(std::string_view payload) {
    std::array<std::string_view, 5> parts;
    for (std::string_view& part : parts) {
      part = payload.substr(0, payload.find('\0'));
      payload.remove_prefix(std::min(part.size() + 1, payload.size()));
    }
    const auto& [head, unit, middle, closing_unit, tail] = parts;
    const std::size_t count =
        kLongestText / std::max<std::size_t>(unit.size() + closing_unit.size(), 1);
    std::string text(head);
    for (std::size_t i = 0; i < count; ++i) text += unit;
    text += middle;
    for (std::size_t i = 0; i < count; ++i) text += closing_unit;
    text += tail;
    return text;
  }

  void binary(live::FoxgloveClient& client, std::string_view payload) {
    constexpr std::size_t kCallHead = 1 + 3 * sizeof(std::uint32_t);
    is_moved_ = true;
    if (!payload.empty() && payload[0] == 2 && payload.size() >= kCallHead &&
        payload.size() - kCallHead >= number_at(payload, kCallHead - sizeof(std::uint32_t))) {
      ++open_calls_;
    }
    client.on_binary(view_of(payload));
  }

  void act(live::FoxgloveClient& client, std::string_view payload) {
    switch (payload.empty() ? 0 : payload[0] % 3) {
      case 0:
        return client.tick();
      case 1:
        return client.greet();
      default:
        return client.leave();
    }
  }

  void go_on() {
    is_moved_ = true;
    begin();
    Session& session = stage_.session;
    for (int i = 0; i < 3 && slices_ < kMostSlices && !is_over_; ++i, ++slices_) {
      control().release_start();  // wakes the run: it would wait for a client otherwise
      try {
        const auto next = stage_.run->next(session, session.now() + Duration{20'000'000});
        if (next.restart_seed) {
          session.reset(*next.restart_seed);
          stage_.has_begun = false;
          begin();
        } else {
          session.advance(next.until);
        }
        is_over_ = session.over();
      } catch (const SimulationError&) {
        is_over_ = true;
      }
      if (is_over_) stage_.run->end(session);
    }
  }

  void note_refusal(const std::string& reason) {
    ++tally_.refusals;
    tally_.refusal = reason;
  }

  void command(std::string_view payload, bool is_json) {
    if (payload.size() < 2) return;
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(payload[i]); };
    const CommandType& type = all_command_types()[byte(0) % all_command_types().size()];
    const std::size_t k = byte(1) % type.ros_types.size();
    payload.remove_prefix(2);
    std::vector<std::uint8_t> cdr(payload.begin(), payload.end());
    try {
      if (is_json) {
        const json given = live::parse_json(payload);
        if (given.is_discarded()) return;
        cdr = live::cdr_from_json(given, type.schemas[k]);
        VINEROW_DEMAND(
            live::cdr_from_json(live::json_from_cdr(cdr, type.schemas[k]), type.schemas[k]) == cdr);
      } else {
        const json value = live::json_from_cdr(cdr, type.schemas[k]);
        // What is not finite is null, and therefore not the same again.
        const json again =
            live::json_from_cdr(live::cdr_from_json(value, type.schemas[k]), type.schemas[k]);
        VINEROW_DEMAND(again == value || has_null(value));
      }
    } catch (const ConfigError& error) {
      note_refusal(error.what());
    }
    try {
      const OutsideCommand decoded = live::decode_command(
          "rover/" + signal_of(type.message_type), type.message_type, type.ros_types[k], cdr);
      decoded.value->has_nan();
    } catch (const ConfigError& error) {
      note_refusal(error.what());
    }
  }

  void request(std::string_view payload) {
    if (payload.empty()) return;
    is_moved_ = true;
    const std::size_t index = static_cast<std::uint8_t>(payload[0]) % live::service_types().size();
    // The answer may come after this object has gone, from the end of the run.
    auto answers = std::make_shared<int>(0);
    try {
      stage_.run->services().call_cdr(index, view_of(payload.substr(1)),
                                      [answers](const std::vector<std::uint8_t>& response) {
                                        VINEROW_DEMAND(++*answers == 1);
                                        VINEROW_DEMAND(response.size() > record::kCdrHeaderSize);
                                      });
    } catch (const ConfigError& error) {
      VINEROW_DEMAND(*answers == 0);
      note_refusal(error.what());
    }
  }

  void http_request(std::string_view payload) {
    std::array<std::string_view, 4> lines;
    for (std::string_view& line : lines) {
      const std::size_t end = std::min(payload.find('\n'), payload.size());
      line = payload.substr(0, end);
      payload.remove_prefix(std::min(end + 1, payload.size()));
    }
    const auto& [target, origin, protocols, secret] = lines;
    const live::Target split = live::split_target(target);
    VINEROW_DEMAND(split.path.size() + split.token.size() <= target.size());
    live::is_trusted_origin(origin);
    const std::string chosen = live::choose_protocol(protocols);
    VINEROW_DEMAND(chosen.empty() || protocols.find(chosen) != std::string_view::npos);
    const std::string encoded = live::percent_encoded(secret);
    VINEROW_DEMAND(live::split_target("/?token=" + encoded).token == secret);
    VINEROW_DEMAND(live::is_same_secret(split.token, secret) == (split.token == secret));
  }

  /// Reads what the clients were sent.
  void drain() {
    for (const auto& client : clients_) {
      while (const auto frame = client->outbox().take()) {
        frame->is_binary ? check_binary(*frame) : check_text(frame->head);
      }
      VINEROW_DEMAND(!client->outbox().is_flooded());
    }
  }

  /// Whether a long text has not been checked just before.
  static bool is_new(const std::string& text) {
    constexpr std::size_t kLong = 1 << 12;
    static std::vector<std::string> last(4);
    if (text.size() < kLong) return true;
    if (std::find(last.begin(), last.end(), text) != last.end()) return false;
    std::rotate(last.begin(), last.begin() + 1, last.end());
    last.back() = text;
    return true;
  }

  void check_text(const std::string& text) {
    // Greetings take more time than all else, and nearly all are the same.
    if (!is_new(text)) return;
    const json message = json::parse(text);
    const std::string op = message.at("op");
    if (op == "serviceCallFailure") {
      --open_calls_;
      note_refusal(message.at("message"));
    }
    if (op == "status" && message.at("level") != 0) note_refusal(message.at("message"));
  }

  void check_binary(const live::Frame& frame) {
    VINEROW_DEMAND(!frame.head.empty());
    switch (frame.head[0]) {
      case 1:
        VINEROW_DEMAND(frame.head.size() == 13 && frame.body);
        ++tally_.messages;
        break;
      case 2:
        VINEROW_DEMAND(frame.head.size() == 9 && !frame.body);
        break;
      case 3:
        --open_calls_;
        check_response(frame.head);
        break;
      default:
        VINEROW_DEMAND(!"a binary frame of the server has an unknown operation");
    }
  }

  void check_response(const std::string& head) {
    const live::ServiceType& type = live::service_types().at(number_at(head, 1) - 1);
    const std::size_t length = number_at(head, 9);
    VINEROW_DEMAND(head.size() >= 13 + length);
    const std::string encoding = head.substr(13, length), rest = head.substr(13 + length);
    ++tally_.responses;
    const auto schema = record::RosSchema::parse(type.type + "_Response", type.response);
    const json response =
        encoding == "json" ? json::parse(rest) : live::json_from_cdr(view_of(rest), schema);
    live::cdr_from_json(response, schema);
  }

  Stage& stage_;
  const bool has_two_clients_;
  LiveTally tally_;
  std::vector<std::shared_ptr<live::FoxgloveClient>> clients_;
  int slices_ = 0;
  int open_calls_ = 0;
  bool is_moved_ = false;  ///< the next input needs another run
  bool is_over_ = false;
};

}  // namespace

bool is_taken(std::string_view type) {
  return type == VelocityCommand::kType || type == NamedValues::kType ||
         type == LocalCommand::kType || type == ReferenceTrajectory::kType;
}

void add_frame(std::string& input, LiveFrame kind, std::string_view payload) {
  input += static_cast<char>(kind);
  input += static_cast<char>(payload.size() & 0xff);
  input += static_cast<char>(payload.size() >> 8);
  input += payload;
}

LiveTally read_live_frames(std::span<const std::uint8_t> bytes) {
  static Stage plain(""), in_lockstep(kLockstep);
  if (bytes.empty()) return {};
  const std::uint8_t flags = bytes[0];
  Play play(flags & kInLockstep ? in_lockstep : plain, flags);
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()) + 1, bytes.size() - 1);
  for (int i = 0; i < kMostFrames && rest.size() > kLengthBytes; ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(rest[k]); };
    const auto kind = static_cast<LiveFrame>(byte(0) % kFrameKinds);
    const std::size_t length = byte(1) + 256u * byte(2);
    rest.remove_prefix(1 + kLengthBytes);
    const std::string_view payload = rest.substr(0, length);
    rest.remove_prefix(payload.size());
    play.frame(kind, payload);
  }
  return play.finish();
}

}  // namespace vinerow::fuzz
