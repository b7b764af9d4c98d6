#include "engine/live/foxglove_client.h"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/live/message_json.h"

namespace vinerow::live {
namespace {

using nlohmann::json;

// Operation codes of binary frames.
constexpr char kMessageData = 1, kTime = 2, kServiceResponse = 3;
constexpr std::uint8_t kClientMessage = 1, kServiceRequest = 2;
// What one client may ask of the server.
constexpr std::size_t kMostSubscriptions = 10'000;
constexpr std::size_t kMostChannels = 100;
constexpr std::size_t kLongestName = 1000;  // names are kept, frames are not

/// Appends a little-endian number.
template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// Reader of a client's binary frame.
class FrameReader {
 public:
  explicit FrameReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint32_t number() {
    if (bytes_.size() < sizeof(std::uint32_t)) throw ConfigError("a binary frame is too short");
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return value;
  }
  std::string text() {
    const std::uint32_t size = number();
    if (bytes_.size() < size) throw ConfigError("a binary frame is too short");
    std::string value(reinterpret_cast<const char*>(bytes_.data()), size);
    bytes_ = bytes_.subspan(size);
    return value;
  }
  std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

bool is_picture(std::string_view type) {
  return type.ends_with("/CompressedImage") || type.ends_with("/Image");
}

json service_message(const std::string& type, const std::string& schema) {
  return {
      {"encoding", "cdr"}, {"schemaName", type}, {"schemaEncoding", "ros2msg"}, {"schema", schema}};
}

/// Text of a JSON message; bytes that are no UTF-8 become replacement characters.
std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

FoxgloveClient::FoxgloveClient(LiveRun& run, std::string name, std::string session_id,
                               std::function<void()> wake)
    : run_(run),
      name_(std::move(name)),
      session_id_(std::move(session_id)),
      outbox_(std::move(wake)) {}

void FoxgloveClient::send(const json& message) {
  outbox_.add(FrameKind::kAnswer, {false, text_of(message)});
}

void FoxgloveClient::send_status(RunControl::Level level, const std::string& sentence,
                                 const std::string& id) {
  json message = {{"op", "status"}, {"level", static_cast<int>(level)}, {"message", sentence}};
  if (!id.empty()) message["id"] = id;
  send(message);
}

void FoxgloveClient::greet() {
  leave();
  hub_ = run_.hub();
  const RunSnapshot run = run_.control().snapshot();
  send(
      {{"op", "serverInfo"},
       {"name", "Vinerow"},
       {"capabilities", {"time", "clientPublish", "parameters", "parametersSubscribe", "services"}},
       {"supportedEncodings", {"cdr", "json"}},
       {"metadata", {{"ROS_DISTRO", "humble"}}},
       {"sessionId", fmt::format("{}-{}", session_id_, run.restarts)}});
  json channels = json::array();
  if (hub_) {
    for (const Channel& channel : hub_->channels()) {
      channels.push_back({{"id", channel.id},
                          {"topic", channel.topic},
                          {"encoding", "cdr"},
                          {"schemaName", channel.type},
                          {"schema", channel.definition},
                          {"schemaEncoding", "ros2msg"}});
    }
  }
  send({{"op", "advertise"}, {"channels", std::move(channels)}});
  json services = json::array();
  for (std::size_t i = 0; i < service_types().size(); ++i) {
    const ServiceType& service = service_types()[i];
    services.push_back(
        {{"id", i + 1},
         {"name", "/run/" + service.name},
         {"type", service.type},
         {"request", service_message(service.type + "_Request", service.request)},
         {"response", service_message(service.type + "_Response", service.response)}});
  }
  send({{"op", "advertiseServices"}, {"services", std::move(services)}});
  sent_time_ns_ = -1;
}

void FoxgloveClient::leave() {
  if (hub_) hub_->unsubscribe_all(this);
  hub_ = nullptr;
  subscriptions_.clear();
  {
    const std::lock_guard lock(ids_mutex_);
    ids_.clear();
  }
  run_.control().release(name_);
}

void FoxgloveClient::receive(const Message& message) {
  const Channel* channel = hub_->find(message.channel);
  Frame frame{true, std::string(1, kMessageData), message.bytes};
  {
    const std::lock_guard lock(ids_mutex_);
    const auto id = ids_.find(message.channel);
    if (id == ids_.end()) return;
    put(frame.head, id->second);
  }
  put(frame.head, static_cast<std::uint64_t>(message.log_time_ns));
  outbox_.add(is_picture(channel->type) ? FrameKind::kPicture : FrameKind::kMessage,
              std::move(frame));
}

void FoxgloveClient::tick() {
  const RunSnapshot run = run_.control().snapshot();
  if (run.now.ns != sent_time_ns_ && hub_ && outbox_.has_room()) {
    sent_time_ns_ = run.now.ns;
    Frame frame{true, std::string(1, kTime)};
    put(frame.head, static_cast<std::uint64_t>(run.now.ns));
    outbox_.add(FrameKind::kMessage, std::move(frame));
  }
  if (const std::uint64_t dropped = outbox_.take_dropped()) {
    send_status(RunControl::Level::kWarning,
                fmt::format("{} messages were dropped, because this connection is slower than the "
                            "run",
                            dropped),
                "dropped");
  }
  if (watched_.empty() || !outbox_.has_room()) return;
  json changed = json::object();
  const json values = run_.changing_parameters();
  for (const auto& [name, value] : values.items()) {
    if (!watched_.contains(name) && !watched_.contains("")) continue;
    std::string text = value.dump();
    std::string& sent = sent_values_[name];
    if (text == sent) continue;
    sent = std::move(text);
    changed[name] = value;
  }
  if (!changed.empty()) send_parameters(changed, "");
}

void FoxgloveClient::on_text(std::string_view text) {
  try {
    const json message = parse_json(text);
    if (!message.is_object()) throw ConfigError("a text message is no JSON object");
    handle(message);
  } catch (const ConfigError& error) {
    send_status(RunControl::Level::kError, error.what());
  } catch (const json::exception& error) {
    // A field that is missing or of another type; its text starts with "[json.exception...] ".
    const std::string_view words = error.what();
    send_status(RunControl::Level::kError,
                fmt::format("a text message is malformed: {}", words.substr(words.find(']') + 2)));
  }
}

void FoxgloveClient::handle(const json& message) {
  const std::string op = message.at("op");
  if (op == "subscribe") return subscribe(message);
  if (op == "unsubscribe") return unsubscribe(message);
  if (op == "advertise") return advertise(message);
  if (op == "unadvertise") return unadvertise(message);
  if (op == "getParameters") return get_parameters(message);
  if (op == "setParameters") return set_parameters(message);
  if (op == "subscribeParameterUpdates") return subscribe_parameters(message, true);
  if (op == "unsubscribeParameterUpdates") return subscribe_parameters(message, false);
  throw ConfigError(fmt::format("operation '{}' is not supported", op));
}

void FoxgloveClient::subscribe(const json& message) {
  if (!hub_) throw ConfigError("subscribe: the run has not begun");
  for (const json& each : message.at("subscriptions")) {
    const auto id = each.at("id").get<std::uint32_t>();
    const auto number = each.at("channelId").get<std::uint64_t>();
    const Channel* channel = number <= hub_->channels().size()
                                 ? hub_->find(static_cast<std::uint16_t>(number))
                                 : nullptr;
    const auto refuse = [&](const std::string& reason) {
      send_status(RunControl::Level::kError, fmt::format("subscription {}: {}", id, reason));
    };
    if (!channel) {
      refuse(fmt::format("there is no channel {}", number));
    } else if (subscriptions_.contains(id)) {
      refuse("this id is in use");
    } else if (subscriptions_.size() >= kMostSubscriptions) {
      refuse(fmt::format("more than {} subscriptions", kMostSubscriptions));
    } else {
      {
        const std::lock_guard lock(ids_mutex_);
        if (!ids_.emplace(channel->id, id).second) {
          send_status(
              RunControl::Level::kError,
              fmt::format("subscription {}: '{}' is subscribed to already", id, channel->topic));
          continue;
        }
      }
      subscriptions_.emplace(id, channel->id);
      hub_->subscribe(channel->id, shared_from_this());
    }
  }
}

void FoxgloveClient::unsubscribe(const json& message) {
  for (const json& each : message.at("subscriptionIds")) {
    const auto id = each.get<std::uint32_t>();
    const auto found = subscriptions_.find(id);
    if (found == subscriptions_.end()) {
      send_status(RunControl::Level::kWarning, fmt::format("there is no subscription {}", id));
      continue;
    }
    hub_->unsubscribe(found->second, this);
    {
      const std::lock_guard lock(ids_mutex_);
      ids_.erase(found->second);
    }
    subscriptions_.erase(found);
  }
}

void FoxgloveClient::advertise(const json& message) {
  for (const json& each : message.at("channels")) {
    const auto id = each.at("id").get<std::uint32_t>();
    ClientChannel channel{each.at("topic"), each.at("encoding"), each.at("schemaName"), ""};
    for (const std::string& name : {channel.topic, channel.encoding, channel.type}) {
      if (name.size() <= kLongestName) continue;
      throw ConfigError(fmt::format("channel {} has a name of {} bytes, must be at most {}", id,
                                    name.size(), kLongestName));
    }
    if (channels_.size() >= kMostChannels) {
      throw ConfigError(fmt::format("more than {} channels of one client", kMostChannels));
    }
    const std::string refusal = run_.check_publisher(channel.topic, channel.type, channel.encoding);
    if (!refusal.empty()) send_status(RunControl::Level::kError, refusal, "publish");
    channels_.insert_or_assign(id, std::move(channel));
  }
}

void FoxgloveClient::unadvertise(const json& message) {
  for (const json& each : message.at("channelIds")) channels_.erase(each.get<std::uint32_t>());
  if (channels_.empty()) run_.control().release(name_);
}

void FoxgloveClient::send_parameters(const json& values, const std::string& id) {
  json list = json::array();
  for (const auto& [name, value] : values.items()) {
    json entry = {{"name", name}, {"value", value}};
    if (value.is_number_float()) entry["type"] = "float64";
    list.push_back(std::move(entry));
  }
  json message = {{"op", "parameterValues"}, {"parameters", std::move(list)}};
  if (!id.empty()) message["id"] = id;
  send(message);
}

void FoxgloveClient::get_parameters(const json& message) {
  json all = run_.parameters();
  const json& names = message.at("parameterNames");
  json chosen = names.empty() ? all : json::object();
  for (const json& name : names) {
    if (all.contains(name.get<std::string>()))
      chosen[name.get<std::string>()] = all[name.get<std::string>()];
  }
  send_parameters(chosen, message.value("id", ""));
}

void FoxgloveClient::set_parameters(const json& message) {
  json names = json::array();
  for (const json& each : message.at("parameters")) {
    const std::string name = each.at("name");
    const std::string refusal = run_.set_parameter(name, each.value("value", json()));
    if (!refusal.empty()) send_status(RunControl::Level::kError, refusal, "parameter");
    names.push_back(name);
  }
  // The answer holds the values that are in force.
  if (message.contains("id")) get_parameters({{"parameterNames", names}, {"id", message["id"]}});
}

void FoxgloveClient::subscribe_parameters(const json& message, bool on) {
  const json& names = message.at("parameterNames");
  if (names.empty() && !on) watched_.clear();
  if (names.empty() && on) watched_.insert("");
  json values = json::object();
  const json all = run_.parameters();
  for (const json& each : names) {
    const std::string name = each;
    if (on && all.contains(name)) watched_.insert(name);
    if (!on) watched_.erase(name);
    if (all.contains(name)) values[name] = all[name];
  }
  if (on) send_parameters(names.empty() ? all : values, "");
}

void FoxgloveClient::on_binary(std::span<const std::uint8_t> bytes) {
  try {
    if (bytes.empty()) throw ConfigError("a binary frame is empty");
    if (bytes[0] == kClientMessage) return publish(bytes.subspan(1));
    if (bytes[0] == kServiceRequest) return call_service(bytes.subspan(1));
    throw ConfigError(fmt::format("binary operation {} is not supported", bytes[0]));
  } catch (const ConfigError& error) {
    send_status(RunControl::Level::kError, error.what());
  }
}

void FoxgloveClient::publish(std::span<const std::uint8_t> bytes) {
  FrameReader in(bytes);
  const std::uint32_t id = in.number();
  const auto found = channels_.find(id);
  if (found == channels_.end()) {
    throw ConfigError(fmt::format("channel {} of this client is not advertised", id));
  }
  ClientChannel& channel = found->second;
  const std::weak_ptr<FoxgloveClient> self = weak_from_this();
  const std::string refusal =
      run_.publish(channel.topic, channel.type, channel.encoding, in.rest(), name_,
                   [self](const std::string& reason) {
                     if (const auto client = self.lock()) {
                       client->send_status(RunControl::Level::kError, reason, "publish");
                     }
                   });
  // A joystick repeats its mistake 50 times a second; the client hears of it once.
  if (refusal != channel.last_refusal && !refusal.empty()) {
    send_status(RunControl::Level::kError, refusal, "publish");
  }
  channel.last_refusal = refusal;
}

void FoxgloveClient::call_service(std::span<const std::uint8_t> bytes) {
  FrameReader in(bytes);
  const std::uint32_t service = in.number(), call = in.number();
  const std::string encoding = in.text();
  const auto fail = [&](const std::string& reason) {
    send({{"op", "serviceCallFailure"},
          {"serviceId", service},
          {"callId", call},
          {"message", reason}});
  };
  if (service < 1 || service > service_types().size()) {
    return fail(fmt::format("there is no service {}", service));
  }
  const std::weak_ptr<FoxgloveClient> self = weak_from_this();
  const auto respond = [self, service, call, encoding](std::string_view response) {
    const auto client = self.lock();
    if (!client) return;
    Frame frame{true, std::string(1, kServiceResponse)};
    put(frame.head, service);
    put(frame.head, call);
    put(frame.head, static_cast<std::uint32_t>(encoding.size()));
    frame.head += encoding;
    frame.head += response;
    client->outbox_.add(FrameKind::kAnswer, std::move(frame));
  };
  try {
    if (encoding == "json") {
      const auto rest = in.rest();
      const json request = parse_json({reinterpret_cast<const char*>(rest.data()), rest.size()});
      if (request.is_discarded()) return fail("the request is no JSON");
      run_.services().call(service - 1, request,
                           [respond](const json& response) { respond(text_of(response)); });
    } else if (encoding == "cdr") {
      run_.services().call_cdr(service - 1, in.rest(),
                               [respond](const std::vector<std::uint8_t>& r) {
                                 respond({reinterpret_cast<const char*>(r.data()), r.size()});
                               });
    } else {
      fail(fmt::format("encoding '{}' is not supported: cdr or json", encoding));
    }
  } catch (const ConfigError& error) {
    fail(error.what());
  }
}

}  // namespace vinerow::live
