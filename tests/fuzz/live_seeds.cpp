#include "tests/fuzz/live_seeds.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "engine/api/messages.h"
#include "engine/live/command_codec.h"
#include "engine/live/message_json.h"
#include "engine/live/services.h"
#include "engine/record/ros_mapping.h"
#include "tests/fuzz/read_live_frames.h"

namespace vinerow::fuzz {
namespace {

using nlohmann::json;

std::string text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string number(std::uint32_t value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  return {bytes, sizeof value};
}

/// Input that is built frame by frame.
class Input {
 public:
  explicit Input(int flags) { bytes_ += static_cast<char>(flags); }

  Input& add(LiveFrame kind, std::string_view payload) {
    add_frame(bytes_, kind, payload);
    return *this;
  }
  Input& text(std::string_view text) { return add(LiveFrame::kText, text); }
  Input& go_on() { return add(LiveFrame::kGoOn, ""); }
  Input& tick() { return add(LiveFrame::kClient, std::string(1, '\0')); }
  Input& publish(std::uint32_t channel, const std::string& bytes) {
    return add(LiveFrame::kBinary, '\1' + number(channel) + bytes);
  }
  Input& call(std::uint32_t service, const std::string& encoding, const std::string& request) {
    const auto length = static_cast<std::uint32_t>(encoding.size());
    return add(LiveFrame::kBinary,
               '\2' + number(service) + number(++call_) + number(length) + encoding + request);
  }
  Input& advertise(std::uint32_t id, const std::string& message_type, const std::string& encoding,
                   const std::string& ros_type) {
    return text(fmt::format(
        R"({{"op":"advertise","channels":[{{"id":{},"topic":"/rover/cmd_{}","encoding":"{}","schemaName":"{}"}}]}})",
        id, message_type, encoding, ros_type));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::uint32_t call_ = 0;
};

const std::string kVelocity = "VelocityCommand", kTwist = "geometry_msgs/msg/Twist",
                  kTwistStamped = "geometry_msgs/msg/TwistStamped";

std::string twist(double v_mps) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  for (const double value : {v_mps, 0.0, 0.0, 0.0, 0.0, -0.25}) out.add(value);
  return text_of(buffer.view());
}

std::string request_of(std::size_t service, const json& fields) {
  const live::ServiceType& type = live::service_types()[service - 1];
  return text_of(
      live::cdr_from_json(fields, record::RosSchema::parse(type.type + "_Request", type.request)));
}

void add_clients(std::vector<LiveSeed>& seeds) {
  std::string subscribe;
  for (int channel = 1; channel <= 12; ++channel) {
    subscribe += fmt::format(R"({}{{"id":{},"channelId":{}}})", channel == 1 ? "" : ",",
                             channel + 20, channel);
  }
  seeds.push_back({"subscribe",
                   Input(0)
                       .text(fmt::format(R"({{"op":"subscribe","subscriptions":[{}]}})", subscribe))
                       .go_on()
                       .call(4, "json", R"({"steps":30})")
                       .go_on()
                       .text(R"({"op":"unsubscribe","subscriptionIds":[22]})")
                       .tick()
                       .go_on()
                       .bytes(),
                   0, 1});
  seeds.push_back(
      {"parameters",
       Input(kTwoClients)
           .text(R"({"op":"subscribeParameterUpdates","parameterNames":["speed","paused"]})")
           .text(R"({"op":"getParameters","parameterNames":[],"id":"all"})")
           .text(R"({"op":"setParameters","parameters":[{"name":"speed","value":2.5}],"id":"a"})")
           .tick()
           .text(R"({"op":"setParameters","parameters":[{"name":"paused","value":false}]})")
           .tick()
           .text(R"({"op":"unsubscribeParameterUpdates","parameterNames":["speed"]})")
           .bytes()});
  seeds.push_back({"drive_cdr", Input(kNotPaused)
                                    .advertise(1, kVelocity, "cdr", kTwist)
                                    .publish(1, twist(0.5))
                                    .go_on()
                                    .publish(1, twist(0.75))
                                    .go_on()
                                    .text(R"({"op":"unadvertise","channelIds":[1]})")
                                    .bytes()});
  seeds.push_back({"drive_json", Input(kNotPaused)
                                     .advertise(1, kVelocity, "json", "geometry_msgs/Twist")
                                     .publish(1, R"({"linear":{"x":0.5},"angular":{"z":-1e-1}})")
                                     .go_on()
                                     .bytes()});
  seeds.push_back(
      {"lockstep",
       Input(kInLockstep | kNotPaused)
           .advertise(1, kVelocity, "json", kTwistStamped)
           .publish(
               1, R"({"header":{"stamp":{"sec":0,"nanosec":20000000}},"twist":{"linear":{"x":1}}})")
           .publish(1, R"({"header":{"stamp":{"secs":0,"nsecs":40000000}}})")
           .go_on()
           .go_on()
           .bytes()});
  // The second client wants a signal that the first one commands.
  seeds.push_back({"two_owners",
                   Input(kTwoClients | kNotPaused)
                       .advertise(1, kVelocity, "cdr", kTwist)
                       .advertise(1, kVelocity, "cdr", kTwist)
                       .publish(1, twist(0.5))
                       .publish(1, twist(0.5))
                       .go_on()
                       .bytes(),
                   1});
  seeds.push_back({"before_the_run",
                   Input(kNotBegun)
                       .text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]})")
                       .call(4, "json", "{}")
                       .go_on()
                       .go_on()
                       .bytes(),
                   1, 1});
  const std::string zero(1, '\0');
  seeds.push_back({"nested",
                   Input(0)
                       .add(LiveFrame::kLongText,
                            R"({"op":"setParameters","parameters":[{"name":"speed","value":)" +
                                zero + '[' + zero + zero + ']' + zero + "}]}")
                       .bytes(),
                   1});
}

void add_services(std::vector<LiveSeed>& seeds) {
  const std::vector<std::pair<std::uint32_t, json>> calls = {
      {1, json::object()},
      {2, json::object()},
      {3, {{"state", {{"state", 1}}}}},
      {3, {{"state", {{"state", 2}}}}},
      {4, {{"steps", 5}}},
      {5, {{"scope", 0}}},
      {6, {{"filters", {{"filter", "r.*|[a-z]{2,3}"}}}}},
      {7, {{"entity", "rover"}}},
      {3, {{"state", {{"state", 3}}}}}};
  for (const char* encoding : {"json", "cdr"}) {
    Input input(0);
    Input direct(0);
    for (const auto& [service, fields] : calls) {
      const std::string cdr = request_of(service, fields);
      input.call(service, encoding, encoding[0] == 'j' ? fields.dump() : cdr).go_on().tick();
      direct.add(LiveFrame::kCdrRequest, static_cast<char>(service - 1) + cdr).go_on();
    }
    seeds.push_back(
        {std::string("services_") + encoding, input.bytes(), 0, static_cast<int>(calls.size())});
    if (encoding[0] == 'c') seeds.push_back({"services_direct", direct.bytes()});
  }
}

/// A command of every type, as the log has it, and its JSON; from a client if the run takes it.
void add_commands(std::vector<LiveSeed>& seeds) {
  int index = 0;
  for_each_message_type([&]<class T>(T*) {
    using Mapping = record::RosMapping<T>;
    record::ByteBuffer buffer;
    record::CdrWriter out(buffer);
    const record::FrameNames frames = record::FrameNames::of_signal("rover/x");
    const T value{};
    if constexpr (requires { &Mapping::write_exact; }) {
      Mapping::write_exact(out, {frames, Time{9}}, value);
    } else {
      Mapping::write(out, {frames, Time{9}}, value);
    }
    const std::vector<std::string> types = live::command_types(T::kType);
    const std::string cdr = text_of(buffer.view());
    std::string payload;
    payload += static_cast<char>(index++);
    payload += static_cast<char>(types.size() - 1);
    const json fields = live::json_from_cdr(
        buffer.view(),
        record::RosSchema::parse(types.back(), live::command_definition(T::kType, types.back())));
    Input input(kNotPaused);
    input.add(LiveFrame::kCdrCommand, payload + cdr)
        .add(LiveFrame::kJsonCommand, payload + fields.dump());
    if (is_taken(T::kType)) {
      input.advertise(1, T::kType, "cdr", types.back()).publish(1, cdr).go_on();
    }
    seeds.push_back({std::string("command_") + T::kType, input.bytes()});
  });
  const std::string joints =
      R"({"name":["wheel_fl_speed_radps","steer_rad"],"position":[0,0.25],"velocity":[3.5,0]})";
  seeds.push_back({"joints", Input(kNotPaused)
                                 .advertise(1, "NamedValues", "json", "sensor_msgs/msg/JointState")
                                 .publish(1, joints)
                                 .bytes()});
}

}  // namespace

std::vector<LiveSeed> live_seeds() {
  std::vector<LiveSeed> seeds;
  add_clients(seeds);
  add_services(seeds);
  add_commands(seeds);
  for (const char* request :
       {"/live.js?token=s%26c+ret&x=1\nhttp://localhost:8765\nfoxglove.sdk.v1, chat\ns&c ret",
        "/%\nhttps://app.foxglove.dev\nchat ,foxglove.websocket.v1\na", "/?&&=\nfile://\n,\n"}) {
    seeds.push_back({fmt::format("request_{}", seeds.size()),
                     Input(0).add(LiveFrame::kRequest, request).bytes()});
  }
  return seeds;
}

}  // namespace vinerow::fuzz
