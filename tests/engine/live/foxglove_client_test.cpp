/// Foxglove's protocol without a socket. Its official client is the judge in tests/npm.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "engine/live/foxglove_client.h"
#include "tests/engine/live/live_support.h"

namespace vinerow::live::foxglove_client_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// A client of a run that is paused.
class FoxgloveClientTest : public ::testing::Test {
 protected:
  FoxgloveClientTest() : run_(test::remote_rover(), {.speed = 0.0, .paused = true}) {
    run_.await_state(RunState::kPaused);
    client_ = std::make_shared<FoxgloveClient>(*run_.live, "client 1", "session", [] {});
  }
  ~FoxgloveClientTest() override { client_->leave(); }

  struct Frames {
    std::vector<json> texts;
    std::vector<std::string> binaries;
    /// The last text with an operation; null if there is none.
    json last(const std::string& op) const {
      json found;
      for (const json& text : texts) {
        if (text["op"] == op) found = text;
      }
      return found;
    }
  };
  Frames take() {
    Frames frames;
    while (const auto frame = client_->outbox().take()) {
      std::string bytes = frame->head;
      if (frame->body) bytes.append(frame->body->begin(), frame->body->end());
      if (frame->is_binary) {
        frames.binaries.push_back(std::move(bytes));
      } else {
        frames.texts.push_back(json::parse(bytes));
      }
    }
    return frames;
  }
  void send(const json& message) { client_->on_text(message.dump()); }
  /// Text of the status message that an input causes.
  std::string status_of(const std::string& text) {
    take();
    client_->on_text(text);
    const json status = take().last("status");
    return status.is_null() ? "" : status["message"].get<std::string>();
  }
  void send_binary(std::uint8_t op, const std::vector<std::uint32_t>& numbers,
                   const std::string& rest) {
    std::vector<std::uint8_t> bytes = {op};
    for (const std::uint32_t number : numbers) {
      bytes.resize(bytes.size() + 4);
      std::memcpy(bytes.data() + bytes.size() - 4, &number, 4);
    }
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    client_->on_binary(bytes);
  }
  /// Calls a service by name with a JSON request; waits for the response.
  json call(const std::string& name, const json& request) {
    std::uint32_t id = 0;
    for (std::size_t i = 0; i < service_types().size(); ++i) {
      if (service_types()[i].name == name) id = static_cast<std::uint32_t>(i + 1);
    }
    send_binary(2, {id, 77, 4}, "json" + request.dump());
    for (int i = 0; i < 20'000; ++i) {
      const Frames frames = take();
      for (const std::string& bytes : frames.binaries) {
        if (bytes[0] == 3) return json::parse(bytes.substr(1 + 4 + 4 + 4 + 4));
      }
      if (!frames.last("serviceCallFailure").is_null()) return frames.last("serviceCallFailure");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return "no response";
  }
  std::uint16_t channel(const std::string& topic) {
    for (const Channel& each : run_.live->hub()->channels()) {
      if (each.topic == topic) return each.id;
    }
    return 0;
  }

  test::BackgroundRun run_;
  std::shared_ptr<FoxgloveClient> client_;
};

TEST_F(FoxgloveClientTest, GreetsWithWhatTheServerCanDo) {
  client_->greet();
  const Frames frames = take();
  ASSERT_EQ(frames.texts.size(), 3);
  EXPECT_EQ(frames.texts[0]["op"], "serverInfo");
  EXPECT_EQ(frames.texts[0]["sessionId"], "session-0");
  const json channels = frames.last("advertise")["channels"];
  ASSERT_EQ(channels.size(), run_.live->hub()->channels().size());
  EXPECT_EQ(channels[0]["schemaEncoding"], "ros2msg");
  const json services = frames.last("advertiseServices")["services"];
  EXPECT_EQ(services[3]["name"], "/run/step_simulation");
  EXPECT_EQ(services[3]["request"]["schema"], "uint64 steps 1\n");
}

TEST_F(FoxgloveClientTest, SendsTheMessagesOfASubscription) {
  client_->greet();
  take();
  send({{"op", "subscribe"},
        {"subscriptions", {{{"id", 9}, {"channelId", channel("/rover/imu")}}}}});
  EXPECT_EQ(call("step_simulation", {{"steps", 100}})["result"]["result"], 1);
  send({{"op", "unsubscribe"}, {"subscriptionIds", {9}}});
  take();
  send({{"op", "subscribe"},
        {"subscriptions", {{{"id", 3}, {"channelId", channel("/rover/imu")}}}}});
  std::promise<std::string> done;
  run_.control().step(100, [&](const std::string& reason) { done.set_value(reason); });
  EXPECT_EQ(done.get_future().get(), "");
  const Frames frames = take();
  ASSERT_EQ(frames.binaries.size(), 10) << "100 Hz over 0.1 s";
  std::uint32_t id = 0;
  std::uint64_t time = 0;
  std::memcpy(&id, frames.binaries[0].data() + 1, 4);
  std::memcpy(&time, frames.binaries[0].data() + 5, 8);
  EXPECT_EQ(frames.binaries[0][0], 1);
  EXPECT_EQ(id, 3);
  EXPECT_EQ(time, 100'000'000);
}

TEST_F(FoxgloveClientTest, ALateSubscriberReceivesWhatIsWrittenOnce) {
  client_->greet();
  take();
  send({{"op", "subscribe"},
        {"subscriptions", {{{"id", 1}, {"channelId", channel("/run/scene")}}}}});
  EXPECT_EQ(take().binaries.size(), 1);
}

TEST_F(FoxgloveClientTest, AnswersServices) {
  client_->greet();
  EXPECT_EQ(call("get_simulation_state", json::object())["state"]["state"], 2);
  EXPECT_EQ(call("get_entities", json::object())["entities"], json::array({"rover"}));
  EXPECT_EQ(call("get_entities", {{"filters", {{"filter", "r.*"}}}})["entities"].size(), 1);
  EXPECT_EQ(call("get_entities", {{"filters", {{"filter", "x"}}}})["entities"].size(), 0);
  EXPECT_EQ(call("get_entities", {{"filters", {{"filter", "("}}}})["result"]["result"], 4);
  EXPECT_EQ(call("step_simulation", json::object())["result"]["result"], 1) << "one step";
  EXPECT_EQ(run_.control().snapshot().steps, 1);
  const json state = call("get_entity_state", {{"entity", "rover"}});
  EXPECT_EQ(state["result"]["result"], 1);
  EXPECT_EQ(state["state"]["header"]["frame_id"], "map");
  EXPECT_NE(state["state"]["pose"]["position"]["x"], 0.0);
  const json unknown = call("get_entity_state", {{"entity", "rovr"}})["result"];
  EXPECT_EQ(unknown["result"], 2);
  EXPECT_EQ(unknown["error_message"], "no entity 'rovr'; did you mean 'rover'? (known: rover)");
  EXPECT_EQ(call("set_simulation_state", {{"state", {{"state", 2}}}})["result"]["result"], 101);
  EXPECT_EQ(call("set_simulation_state", {{"state", {{"state", 9}}}})["result"]["result"], 0);
  EXPECT_EQ(call("reset_simulation", {{"scope", 1}})["result"]["result"], 0);
  EXPECT_EQ(call("reset_simulation", json::object())["result"]["result"], 1);
  EXPECT_EQ(run_.control().snapshot().restarts, 1);
  EXPECT_EQ(call("get_simulator_features", json::object())["features"]["features"].size(), 9);
  EXPECT_EQ(call("set_simulation_state", {{"state", {{"state", 1}}}})["result"]["result"], 1);
  run_.await_state(RunState::kOver);
  EXPECT_EQ(call("set_simulation_state", {{"state", {{"state", 2}}}})["result"]["result"], 103);
}

TEST_F(FoxgloveClientTest, SaysWhyAServiceCallFails) {
  client_->greet();
  EXPECT_EQ(call("step_simulation", {{"stepz", 5}})["message"],
            "simulation_interfaces/srv/StepSimulation_Request has no field 'stepz'; did you mean "
            "'steps'? (fields: steps)");
  send_binary(2, {99, 1, 4}, "json{}");
  EXPECT_EQ(take().last("serviceCallFailure")["message"], "there is no service 99");
  send_binary(2, {1, 1, 3}, "xml{}");
  EXPECT_EQ(take().last("serviceCallFailure")["message"],
            "encoding 'xml' is not supported: cdr or json");
  send_binary(2, {4, 1, 3}, "cdr12");
  EXPECT_THAT(take().last("serviceCallFailure")["message"].get<std::string>(),
              HasSubstr("the bytes hold no"));
}

TEST_F(FoxgloveClientTest, PublishesCommands) {
  client_->greet();
  send({{"op", "advertise"},
        {"channels",
         {{{"id", 5},
           {"topic", "/rover/cmd_vel"},
           {"encoding", "json"},
           {"schemaName", "geometry_msgs/msg/Twist"}}}}});
  EXPECT_TRUE(take().last("status").is_null());
  send_binary(1, {5}, R"({"linear": {"x": 0.75}})");
  EXPECT_TRUE(take().last("status").is_null());
  EXPECT_EQ(call("step_simulation", {{"steps", 50}})["result"]["result"], 1);
  EXPECT_EQ(run_.control().submit(test::velocity("another", Time{}, 0.1)),
            "'rover/cmd_vel' is commanded by client 1; another peer can take over 1 s after its "
            "last command");
}

TEST_F(FoxgloveClientTest, SaysOnceWhyACommandIsRefused) {
  client_->greet();
  const json channels = {{{"id", 5},
                          {"topic", "/rover/cmd_vel"},
                          {"encoding", "json"},
                          {"schemaName", "geometry_msgs/msg/Twist"}}};
  send({{"op", "advertise"}, {"channels", channels}});
  take();
  for (int i = 0; i < 5; ++i) send_binary(1, {5}, R"({"linear": {"x": "fast"}})");
  const Frames frames = take();
  ASSERT_EQ(frames.texts.size(), 1);
  EXPECT_EQ(frames.texts[0]["message"],
            "topic '/rover/cmd_vel': linear.x = \"fast\", must be a number");
  EXPECT_EQ(frames.texts[0]["level"], 2);
}

TEST_F(FoxgloveClientTest, GetsAndSetsParameters) {
  client_->greet();
  take();
  send({{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", "a"}});
  const json all = take().last("parameterValues");
  EXPECT_EQ(all["id"], "a");
  std::map<std::string, json> values;
  for (const json& each : all["parameters"]) values[each["name"]] = each["value"];
  EXPECT_EQ(values["paused"], true);
  EXPECT_EQ(values["scenario"], "remote_rover");
  EXPECT_EQ(values["scenario.vehicles.rover.controller.timeout_s"], 0.3);
  EXPECT_EQ(values["command_topics"],
            json::parse(R"([{"topic": "/rover/cmd_vel", "type": "geometry_msgs/msg/Twist"}])"));
  send({{"op", "setParameters"}, {"parameters", {{{"name", "speed"}, {"value", 3}}}}, {"id", "b"}});
  EXPECT_EQ(take().last("parameterValues")["parameters"][0]["value"], 3.0);
  EXPECT_EQ(run_.control().snapshot().speed, 3.0);
}

TEST_F(FoxgloveClientTest, SendsParametersThatChange) {
  client_->greet();
  send({{"op", "subscribeParameterUpdates"}, {"parameterNames", {"paused"}}});
  client_->tick();
  take();
  client_->tick();
  EXPECT_TRUE(take().last("parameterValues").is_null());
  run_.control().resume();
  client_->tick();
  EXPECT_EQ(take().last("parameterValues")["parameters"][0]["value"], false);
}

TEST_F(FoxgloveClientTest, NamesWhatIsWrong) {
  client_->greet();
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"{", "a text message is no JSON object"},
      {"[1]", "a text message is no JSON object"},
      {R"({"op": "dance"})", "operation 'dance' is not supported"},
      {R"({"op": 5})", "a text message is malformed: type must be string, but is number"},
      {R"({})", "a text message is malformed: key 'op' not found"},
      {R"({"op": "subscribe"})", "a text message is malformed: key 'subscriptions' not found"},
      {R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 999}]})",
       "subscription 1: there is no channel 999"},
      {R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 65537}]})",
       "subscription 1: there is no channel 65537"},
      {R"({"op": "unsubscribe", "subscriptionIds": [4]})", "there is no subscription 4"},
      {R"({"op": "setParameters", "parameters": [{"name": "speed", "value": "fast"}]})",
       "speed = \"fast\", must be a number"},
      {R"({"op": "setParameters", "parameters": [{"name": "seed", "value": 3}]})",
       "'seed' cannot be changed during a run; those that can: speed, paused"},
      {R"({"op": "setParameters", "parameters": [{"name": "speeed", "value": 3}]})",
       "no parameter 'speeed'; did you mean 'speed'?"},
      {R"({"op": "advertise", "channels": [{"id": 1, "topic": "/rover/cmd_val", "encoding": "json", "schemaName": "x"}]})",
       "no topic '/rover/cmd_val' takes commands; did you mean '/rover/cmd_vel'? (there are: "
       "/rover/cmd_vel)"},
      {R"({"op": "advertise", "channels": [{"id": 1, "topic": "/rover/cmd_vel", "encoding": "json", "schemaName": "std_msgs/msg/String"}]})",
       "'rover/cmd_vel' takes geometry_msgs/msg/Twist, geometry_msgs/msg/TwistStamped, not "
       "'std_msgs/msg/String'"},
      {R"({"op": "advertise", "channels": [{"id": 1, "topic": "/rover/cmd_vel", "encoding": "ros1", "schemaName": "geometry_msgs/Twist"}]})",
       "topic '/rover/cmd_vel': encoding 'ros1' is not supported: cdr or json"}};
  for (const auto& [text, sentence] : wrong) EXPECT_EQ(status_of(text), sentence) << text;
  client_->on_binary({});
  EXPECT_EQ(take().last("status")["message"], "a binary frame is empty");
  send_binary(9, {}, "");
  EXPECT_EQ(take().last("status")["message"], "binary operation 9 is not supported");
  send_binary(1, {}, "ab");
  EXPECT_EQ(take().last("status")["message"], "a binary frame is too short");
  send_binary(1, {44}, "");
  EXPECT_EQ(take().last("status")["message"], "channel 44 of this client is not advertised");
}

// Damaged frames: tests/fuzz.

/// A recursion over the levels would overflow the stack of the server's thread.
TEST_F(FoxgloveClientTest, RefusesJsonThatIsNestedDeeply) {
  client_->greet();
  const auto nested = [](std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
  };
  const std::string sentence = "the JSON text is nested deeper than 64 levels";
  EXPECT_EQ(status_of(R"({"op": "setParameters", "parameters": [{"name": "speed", "value": )" +
                      nested(1'000'000) + "}]}"),
            sentence);
  send_binary(2, {3, 1, 4}, "json" + nested(1'000'000));
  EXPECT_EQ(take().last("serviceCallFailure")["message"], sentence);
  send({{"op", "advertise"},
        {"channels",
         {{{"id", 5},
           {"topic", "/rover/cmd_vel"},
           {"encoding", "json"},
           {"schemaName", "geometry_msgs/msg/Twist"}}}}});
  take();
  send_binary(1, {5}, nested(1'000'000));
  EXPECT_EQ(take().last("status")["message"], "topic '/rover/cmd_vel': " + sentence);
}

TEST_F(FoxgloveClientTest, KeepsNoLongNames) {
  client_->greet();
  const std::string name(1001, 'x');
  EXPECT_EQ(
      status_of(
          R"({"op": "advertise", "channels": [{"id": 5, "topic": "/rover/cmd_vel", "encoding": "cdr", "schemaName": ")" +
          name + "\"}]}"),
      "channel 5 has a name of 1001 bytes, must be at most 1000");
  send_binary(1, {5}, "");
  EXPECT_EQ(take().last("status")["message"], "channel 5 of this client is not advertised");
}

/// The usual search of the library would take hours.
TEST_F(FoxgloveClientTest, FiltersEntitiesInBoundedTime) {
  client_->greet();
  EXPECT_EQ(call("get_entities", {{"filters", {{"filter", "(x*|y*){60}z"}}}})["entities"].size(),
            0);
  EXPECT_EQ(
      call("get_entities", {{"filters", {{"filter", "(x*|y*){60}ro(v|w)er"}}}})["entities"].size(),
      1);
}

/// 2^60 steps of a millisecond are no 64-bit number of nanoseconds.
TEST_F(FoxgloveClientTest, StepsToTheEndOfTheRun) {
  client_->greet();
  EXPECT_EQ(call("step_simulation", {{"steps", std::uint64_t{1} << 60}})["result"]["error_message"],
            "the run ended before the last step");
}

}  // namespace
}  // namespace vinerow::live::foxglove_client_test
