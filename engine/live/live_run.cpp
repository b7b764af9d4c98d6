#include "engine/live/live_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/io/files/yaml.h"
#include "engine/live/command_codec.h"
#include "engine/live/message_json.h"
#include "engine/record/ros_definitions.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"

namespace vinerow::live {
namespace {

using nlohmann::json;

json json_of(const io::YamlNode& node) {
  return std::visit([](const auto& value) -> json { return value; }, io::scalar_value(node));
}

/// Adds every scalar of a resolved scenario by its path; lists of scalars as one value.
void flatten(const io::YamlNode& node, const std::string& path, json& out) {
  for (const io::YamlEntry& entry : node.entries) {
    flatten(entry.value, path.empty() ? entry.key : path + "." + entry.key, out);
  }
  const bool is_flat_list = node.is_list() && std::ranges::all_of(node.items, [](const auto& i) {
                              return i.is_scalar();
                            });
  if (is_flat_list) {
    json list = json::array();
    for (const io::YamlNode& item : node.items) list.push_back(json_of(item));
    out[path] = std::move(list);
  } else if (node.is_list()) {
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      flatten(node.items[i], fmt::format("{}[{}]", path, i), out);
    }
  } else if (node.is_scalar()) {
    out[path] = json_of(node);
  }
}

std::string signal_of(const std::string& topic) {
  return topic.starts_with('/') ? topic.substr(1) : topic;
}

}  // namespace

LiveRun::LiveRun(ControlOptions options, RunControl::Notify say)
    : say_(std::move(say)),
      control_(std::move(options),
               [this](RunControl::Level level, const std::string& sentence) {
                 this->say(level, sentence);
               }),
      services_(control_, entities_),
      fixed_(std::make_shared<const json>(json::object())) {}

LiveRun::~LiveRun() = default;

void LiveRun::add_listener(RunListener* listener) {
  const std::lock_guard lock(mutex_);
  listeners_.push_back(listener);
}

void LiveRun::remove_listener(RunListener* listener) {
  const std::lock_guard lock(mutex_);
  std::erase(listeners_, listener);
}

std::shared_ptr<MessageHub> LiveRun::hub() const {
  const std::lock_guard lock(mutex_);
  return hub_;
}

std::vector<CommandPort> LiveRun::command_ports() const {
  const std::lock_guard lock(mutex_);
  return ports_;
}

std::vector<RunListener*> LiveRun::listeners() const {
  const std::lock_guard lock(mutex_);
  return listeners_;
}

void LiveRun::say(RunControl::Level level, const std::string& sentence) {
  if (say_) say_(level, sentence);
  for (RunListener* listener : listeners()) listener->on_status(level, sentence);
}

json LiveRun::changing_parameters() const {
  const RunSnapshot run = control_.snapshot();
  return {{"speed", run.speed},
          {"paused", run.state == RunState::kPaused},
          {"over", run.state == RunState::kOver},
          {"real_time_factor", run.real_time_factor},
          {"time_s", run.now.nearest_s()}};
}

json LiveRun::parameters() const {
  std::shared_ptr<const json> fixed;
  {
    const std::lock_guard lock(mutex_);
    fixed = fixed_;
  }
  json all = *fixed;
  all.update(changing_parameters());
  return all;
}

std::string LiveRun::set_parameter(const std::string& name, const json& value) {
  if (name == "speed") {
    if (!value.is_number()) return fmt::format("speed = {}, must be a number", value.dump());
    return control_.set_speed(value.get<double>());
  }
  if (name == "paused") {
    if (!value.is_boolean()) return fmt::format("paused = {}, must be true or false", value.dump());
    value.get<bool>() ? control_.pause() : control_.resume();
    return "";
  }
  const json all = parameters();
  if (all.contains(name)) {
    return fmt::format("'{}' cannot be changed during a run; those that can: speed, paused", name);
  }
  std::vector<std::string> known;
  for (const auto& [key, unused] : all.items()) known.push_back(key);
  return fmt::format("no parameter '{}'{}", name, did_you_mean(name, known));
}

CommandPort LiveRun::find_port(const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  const std::string signal = signal_of(topic);
  const auto port = std::ranges::find(ports_, signal, &CommandPort::signal);
  if (port != ports_.end()) return *port;
  std::vector<std::string> known;
  for (const CommandPort& each : ports_) known.push_back("/" + each.signal);
  throw ConfigError(
      known.empty()
          ? fmt::format("topic '{}': no part of this run takes commands from outside", topic)
          : fmt::format("no topic '{}' takes commands{} (there are: {})", topic,
                        did_you_mean(topic, known), join(known)));
}

std::string LiveRun::check_publisher(const std::string& topic, const std::string& ros_type,
                                     const std::string& encoding) const {
  try {
    const CommandPort port = find_port(topic);
    if (encoding != "cdr" && encoding != "json") {
      return fmt::format("topic '{}': encoding '{}' is not supported: cdr or json", topic,
                         encoding);
    }
    check_command_type(port.signal, port.message_type, ros_type);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::string LiveRun::publish(const std::string& topic, const std::string& ros_type,
                             const std::string& encoding, std::span<const std::uint8_t> bytes,
                             const std::string& peer, Answer refused) {
  try {
    const CommandPort port = find_port(topic);
    std::vector<std::uint8_t> encoded;
    if (encoding == "json") {
      const std::string type = check_command_type(port.signal, port.message_type, ros_type);
      const json value = parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      if (value.is_discarded()) return fmt::format("topic '{}': the bytes are no JSON", topic);
      encoded = cdr_from_json(
          value, record::RosSchema::parse(type, command_definition(port.message_type, type)));
      bytes = encoded;
    }
    return control_.submit({decode_command(port.signal, port.message_type, ros_type, bytes), peer,
                            std::move(refused)});
  } catch (const ConfigError& error) {
    return fmt::format("topic '{}': {}", topic, error.what());
  }
}

void LiveRun::begin(Session& session) {
  Simulation& simulation = session.simulation();
  const scenario::Scenario& scenario = session.scenario();
  auto hub = std::make_shared<MessageHub>(simulation);
  simulation.add_observer(hub.get());
  entities_.watch(simulation);
  simulation.add_observer(&entities_);

  std::vector<CommandPort> ports;
  json topics = json::array();
  for (const std::string& signal : simulation.outside_signals()) {
    const std::string type = simulation.bus().find(signal)->type();
    const std::vector<std::string> ros_types = command_types(type);
    if (ros_types.empty()) continue;  // a type of a plug-in
    ports.push_back({signal, type, ros_types});
    topics.push_back({{"topic", "/" + signal}, {"type", ros_types.front()}});
  }
  json fixed = {{"scenario", scenario.name},
                {"seed", scenario.seed},
                {"duration_s", scenario.duration_s},
                {"step_s", scenario.physics_step.nearest_s()},
                {"command_topics", std::move(topics)}};
  json values = json::object();
  flatten(io::parse_yaml(scenario.resolved_yaml, "scenario.resolved.yaml", "/"), "", values);
  for (auto& [key, value] : values.items()) fixed["scenario." + key] = value;

  {
    const std::lock_guard lock(mutex_);
    ports_ = std::move(ports);
    fixed_ = std::make_shared<const json>(std::move(fixed));
  }
  if (built_) std::exchange(built_, nullptr)(simulation);
  control_.begin(session);
  {
    // A client that sees the channels may send commands at once, so the control comes first.
    const std::lock_guard lock(mutex_);
    hub_ = std::move(hub);
  }
  for (RunListener* listener : listeners()) listener->on_begin(simulation);
}

run::RunDriver::Next LiveRun::next(Session& session, Time slice_end) {
  return control_.next(session, slice_end);
}

void LiveRun::end(Session& session) {
  control_.end(session);
  for (RunListener* listener : listeners()) listener->on_end();
}

}  // namespace vinerow::live
