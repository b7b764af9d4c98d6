#include "engine/live/ros2_bridge.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/core/error.h"
#include "engine/live/command_codec.h"
#include "engine/live/ros2_topics.h"
#include "engine/ros2/node.h"
#include "engine/ros2/type_hash.h"
#include "engine/sim/simulation.h"

namespace vinerow::live {
namespace {

using std::chrono::milliseconds;

// Subscriptions are counted this often.
constexpr milliseconds kCountEvery{10};

/// Identity of a DDS writer as the name of a peer.
std::string peer_name(const ros2::Guid& guid) {
  std::string text = "ROS 2 publisher ";
  for (const std::uint8_t byte : guid) text += fmt::format("{:02x}", byte);
  return text;
}

class Bridge final : public Ros2Bridge, public RunListener {
 public:
  Bridge(LiveRun& run, const Ros2Options& options)
      : run_(run),
        options_(options),
        node_({.name = "vinerow",
               .name_space = "/",
               .domain_id = options.domain,
               .network = options.network,
               .humble = options.distribution == "humble"}),
        topics_(node_, options.distribution == "humble", options.localisation, options.out) {
    for (const ServiceType& type : service_types()) {
      const ros2::ServiceTypeHashes hashes = ros2::service_type_hashes(type.type, srv_text(type));
      services_.push_back(
          node_.create_service("~/" + type.name, type.type, hashes.request, hashes.response));
    }
    if (options_.holds_start) run_.control().hold_start();
    run_.add_listener(this);
    thread_ = std::thread([this] { work(); });
  }

  ~Bridge() override {
    run_.remove_listener(this);
    ends_ = true;
    node_.wake();
    thread_.join();
  }

  void on_begin(Simulation& simulation) override {
    const std::lock_guard lock(mutex_);
    topics_.begin(simulation);
    simulation.add_observer(&topics_);
    for (const CommandPort& port : run_.command_ports()) subscribe(port);
  }

 private:
  struct Command {
    std::string topic;
    std::string type;
    std::unique_ptr<ros2::Subscription> subscription;
    std::string last_refusal;
  };

  struct Response {
    std::size_t service = 0;
    ros2::Request request;
    std::vector<std::uint8_t> cdr;
  };

  static std::string srv_text(const ServiceType& type) {
    return type.request + "---\n" + type.response;
  }

  /// Nodes send one type on a topic: stamped commands in lock-step, otherwise what Nav2 and teleop
  /// programs send.
  void subscribe(const CommandPort& port) {
    const std::string topic = "/" + port.signal;
    if (commands_.contains(topic)) return;
    const auto fits = [&](const std::string& type) {
      return !options_.is_lockstep || has_header(type);
    };
    const std::string type = *std::ranges::find_if(port.ros_types, fits);
    const std::string definition = command_definition(port.message_type, type);
    commands_[topic] = {topic, type,
                        node_.create_subscription(topic, type, ros2::kDefaultQos,
                                                  ros2::message_type_hash(type, definition)),
                        ""};
  }

  void work() {
    auto counted = std::chrono::steady_clock::now();
    while (!ends_) {
      node_.wait(kCountEvery);
      const std::lock_guard lock(mutex_);
      take_commands();
      take_requests();
      send_responses();
      const auto now = std::chrono::steady_clock::now();
      if (now - counted < kCountEvery) continue;
      counted = now;
      topics_.count_subscribers();
      if (options_.holds_start && is_peer_ready()) run_.control().release_start();
    }
  }

  /// The commanding node publishes its topic and reads one of ours.
  bool is_peer_ready() {
    if (!topics_.has_subscribers()) return false;
    for (const auto& [topic, command] : commands_) {
      if (command.subscription->publisher_count() > 0) return true;
    }
    return false;
  }

  void take_commands() {
    ros2::Message message;
    for (auto& [topic, command] : commands_) {
      while (command.subscription->take(message)) {
        const std::string refusal = run_.publish(command.topic, command.type, "cdr", message.cdr,
                                                 peer_name(message.writer), say_refusal());
        // Nodes cannot know that the run is over.
        const bool is_over = run_.control().snapshot().state == RunState::kOver;
        if (!refusal.empty() && refusal != command.last_refusal && !is_over) {
          run_.say(RunControl::Level::kError, refusal);
        }
        command.last_refusal = refusal;
      }
    }
  }

  Answer say_refusal() {
    return [this](const std::string& reason) { run_.say(RunControl::Level::kError, reason); };
  }

  void take_requests() {
    ros2::Request request;
    for (std::size_t i = 0; i < services_.size(); ++i) {
      while (services_[i]->take(request)) {
        try {
          run_.services().call_cdr(i, request.cdr,
                                   [this, i, request](const std::vector<std::uint8_t>& response) {
                                     answer({i, request, response});
                                   });
        } catch (const ConfigError& error) {
          run_.say(RunControl::Level::kError,
                   fmt::format("service {}: {}", service_types()[i].name, error.what()));
        }
      }
    }
  }

  /// From the run's thread: sending may wait for the client's reader, so the own thread does it.
  void answer(Response response) {
    {
      const std::lock_guard lock(responses_mutex_);
      responses_.push_back(std::move(response));
    }
    node_.wake();
  }

  void send_responses() {
    std::vector<Response> responses;
    {
      const std::lock_guard lock(responses_mutex_);
      responses.swap(responses_);
    }
    for (const Response& each : responses) services_[each.service]->reply(each.request, each.cdr);
  }

  LiveRun& run_;
  const Ros2Options options_;
  ros2::Node node_;
  std::mutex mutex_;
  Ros2Topics topics_;
  std::vector<std::unique_ptr<ros2::Service>> services_;
  std::map<std::string, Command> commands_;  ///< by topic
  std::mutex responses_mutex_;
  std::vector<Response> responses_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace

bool has_ros2() {
  return true;
}

std::unique_ptr<Ros2Bridge> make_ros2_bridge(LiveRun& run, const Ros2Options& options) {
  return std::make_unique<Bridge>(run, options);
}

}  // namespace vinerow::live
