/// Nodes of one process, over the loopback interface.

#include "engine/ros2/node.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdlib>
#include <future>

#include "engine/core/error.h"
#include "tests/engine/ros2/test_messages.h"

namespace vinerow::ros2::node_test {
namespace {

using namespace std::chrono_literals;

constexpr const char* kText = "std_msgs/msg/String";

TEST(Node, DeliversTheSameBytes) {
  Node node(test_options());
  const auto publisher = node.create_publisher("/text", kText, kDefaultQos, "");
  const auto subscription = node.create_subscription("/text", kText, kDefaultQos, "");
  const std::vector<std::uint8_t> sent = text_message("abc");
  EXPECT_TRUE(publisher->publish(sent));
  ASSERT_TRUE(node.wait(5s));
  Message message;
  ASSERT_TRUE(subscription->take(message));
  EXPECT_EQ(message.cdr, sent);
  EXPECT_EQ(message.writer, publisher->guid());
  EXPECT_GT(message.source_time_ns, 0);
  EXPECT_FALSE(subscription->take(message));
  EXPECT_FALSE(node.wait(0s));
}

// Nothing reads the bytes: neither damage, nor the other byte order, nor an unknown encapsulation
// matters. RTPS pads to 4 bytes.
TEST(Node, PassesDamagedMessagesOn) {
  Node node(test_options());
  const auto publisher = node.create_publisher("/text", kText, kDefaultQos, "");
  const auto subscription = node.create_subscription("/text", kText, kDefaultQos, "");
  const std::vector<std::vector<std::uint8_t>> messages = {
      {0, 1, 0, 0},
      {0, 0, 0, 0, 0, 0, 0, 2, 'a', 0},
      {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff},
      {0, 1, 0, 0, 0xff, 0xff, 0xff, 0x7f},
  };
  for (const auto& sent : messages) {
    EXPECT_TRUE(publisher->publish(sent));
    ASSERT_TRUE(node.wait(5s));
    Message message;
    ASSERT_TRUE(subscription->take(message));
    std::vector<std::uint8_t> padded = sent;
    padded.resize((sent.size() + 3) / 4 * 4);
    EXPECT_EQ(message.cdr, padded);
  }
  EXPECT_FALSE(publisher->publish(std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(publisher->dropped(), 1u);
}

TEST(Node, KeepsTheLastMessages) {
  Node node(test_options());
  const auto publisher = node.create_publisher("/text", kText, Qos{true, false, 3}, "");
  const auto subscription = node.create_subscription("/text", kText, Qos{true, false, 3}, "");
  for (char c = 'a'; c <= 'j'; ++c) publisher->publish(text_message(std::string(1, c)));
  std::string taken;
  for (Message message; subscription->take(message);) taken += static_cast<char>(message.cdr[8]);
  EXPECT_EQ(taken, "hij");
}

TEST(Node, GivesLatchedMessagesToLateSubscribers) {
  Node node(test_options());
  const auto publisher = node.create_publisher("/map", kText, kLatchedQos, "");
  publisher->publish(text_message("old"));
  publisher->publish(text_message("new"));
  const auto subscription = node.create_subscription("/map", kText, kLatchedQos, "");
  ASSERT_TRUE(node.wait(5s));
  Message message;
  ASSERT_TRUE(subscription->take(message));
  EXPECT_EQ(message.cdr, text_message("new"));
  EXPECT_FALSE(subscription->take(message));
}

TEST(Node, DeliversToAnotherNodeOfTheProcess) {
  Node one(test_options("one")), two(test_options("two"));
  const auto publisher = one.create_publisher("/text", kText, kDefaultQos, "");
  const auto subscription = two.create_subscription("/text", kText, kDefaultQos, "");
  ASSERT_TRUE(eventually([&] { return publisher->subscriber_count() == 1; }));
  ASSERT_TRUE(eventually([&] { return subscription->publisher_count() == 1; }));
  const std::vector<std::uint8_t> large = text_message(std::string(3'000'000, 'x'));
  EXPECT_TRUE(publisher->publish(large));
  ASSERT_TRUE(two.wait(5s));
  Message message;
  ASSERT_TRUE(subscription->take(message));
  EXPECT_EQ(message.cdr.size(), (large.size() + 3) / 4 * 4);
}

TEST(Node, WakesAWaitingThread) {
  Node node(test_options());
  auto waiting = std::async(std::launch::async, [&] { return node.wait(10s); });
  node.wake();
  ASSERT_EQ(waiting.wait_for(5s), std::future_status::ready);
  EXPECT_FALSE(waiting.get());
}

TEST(Node, KeepsTypesOfOneTopicApart) {
  Node node(test_options());
  const auto text = node.create_publisher("/text", kText, kDefaultQos, "");
  const auto number = node.create_subscription("/text", "std_msgs/msg/Int32", kDefaultQos, "");
  text->publish(text_message("abc"));
  EXPECT_FALSE(node.wait(50ms));
}

TEST(Node, OpensTheLastDomain) {
  NodeOptions options = test_options();
  options.domain_id = 232;
  EXPECT_NO_THROW(Node{options});
}

TEST(Node, EndpointsMayOutliveIt) {
  auto node = std::make_unique<Node>(test_options());
  const auto publisher = node->create_publisher("/text", kText, kDefaultQos, "");
  node.reset();
  EXPECT_TRUE(publisher->publish(text_message("abc")));
}

std::string error_of(const NodeOptions& options) {
  try {
    Node node(options);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Node, NamesWhatIsWrong) {
  NodeOptions options = test_options();
  for (const int domain : {-1, 233}) {
    options.domain_id = domain;
    EXPECT_EQ(error_of(options),
              "ROS domain id = " + std::to_string(domain) + ", must be from 0 to 232");
  }
  options = test_options("a b");
  EXPECT_EQ(error_of(options).substr(0, 15), "node name 'a b'");
  Node node(test_options());
  EXPECT_THROW(node.create_publisher("/a//b", kText, kDefaultQos, ""), ConfigError);
  EXPECT_THROW(node.create_publisher("/a", "String", kDefaultQos, ""), ConfigError);
  options = test_options();
  options.network = true;
  EXPECT_EQ(error_of(options), "DDS domain " + std::to_string(test_domain()) +
                                   " is open with another choice of network");
}

TEST(Node, ReportsAMissingInterface) {
  NodeOptions options = test_options();
  setenv("CYCLONEDDS_URI",
         "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"no_such\"/>"
         "</Interfaces></General></Domain></CycloneDDS>",
         1);
  const std::string error = error_of(options);
  unsetenv("CYCLONEDDS_URI");
  EXPECT_EQ(error, "DDS domain " + std::to_string(test_domain()) +
                       " does not start: no_such: does not match an available interface");
  EXPECT_EQ(error_of(options), "");  // the domain opens after a failed try
}

// No packet from or to the network (loopback_sockets.h).
TEST(Node, UsesTheLoopbackDeviceOnly) {
  Node node(test_options());
  int sockets = 0;
  for (int descriptor = 3; descriptor < 256; ++descriptor) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        address.sin_family != AF_INET) {
      continue;
    }
    char device[64] = {};
    size = sizeof device;
    EXPECT_EQ(getsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, device, &size), 0);
    EXPECT_STREQ(device, "lo") << "port " << ntohs(address.sin_port);
    ++sockets;
  }
  EXPECT_GE(sockets, 3);  // discovery, data, sending
}

}  // namespace
}  // namespace vinerow::ros2::node_test
