/// An independent judge: a DDS participant of Fast DDS, as ROS 2 nodes have by default, with the
/// message layouts written by hand. Shares no code with the simulator.
///
/// fast_dds_peer DOMAIN echo [big]   answers every Imu on rt/rover/imu with a TwistStamped on
///                                   rt/rover/cmd_vel (linear.x = angular velocity z, stamp copied;
///                                   "big": in big-endian bytes)
/// fast_dds_peer DOMAIN listen       reads rt/rover/imu reliably, prints "imu <seconds>"
/// fast_dds_peer DOMAIN latched      reads rt/map reliably and transient local, prints "map ..."
/// fast_dds_peer DOMAIN call         calls rq/rover/enableRequest (SetBool) as a client of
///                                   rmw_cyclonedds_cpp does, prints "reply <client> <count> ..."
/// fast_dds_peer DOMAIN state        calls rq/vinerow/get_simulation_stateRequest likewise, prints
///                                   "state <state> <result>"
/// fast_dds_peer DOMAIN drive <us>   drives straight on in lock-step at 20 Hz: answers each
///                                   Odometry on rt/rover/truth with the command for 50 ms later,
///                                   after a delay; prints "drove <commands>" every 100 commands
/// All print discovered writers ("writer <topic> <type> <user data>") and nodes ("node <full name>
/// <readers> <writers>"). They end when standard input does.

#include <fastcdr/Cdr.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

using Bytes = std::vector<char>;

/// Samples are the bytes of the message with encapsulation header.
class RawType : public dds::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1 << 16;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = bytes[1] == 0 ? CDR_BE : CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const char* first = reinterpret_cast<const char*>(payload->data);
    static_cast<Bytes*>(data)->assign(first, first + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

class OnMessage : public dds::DataReaderListener {
 public:
  explicit OnMessage(std::function<void(Bytes&)> handle) : handle_(std::move(handle)) {}
  void on_data_available(dds::DataReader* reader) override {
    Bytes bytes;
    dds::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) handle_(bytes);
    }
  }

 private:
  std::function<void(Bytes&)> handle_;
};

class PrintDiscovery : public dds::DomainParticipantListener {
 public:
  void on_participant_discovery(dds::DomainParticipant*,
                                rtps::ParticipantDiscoveryInfo&& info) override {
    const auto& data = info.info.m_userData;
    std::printf("participant %.*s\n", static_cast<int>(data.size()),
                reinterpret_cast<const char*>(data.data()));
    std::fflush(stdout);
  }
  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& info) override {
    const auto& data = info.info.m_qos.m_userData;
    std::printf("writer %s %s %.*s\n", info.info.topicName().c_str(), info.info.typeName().c_str(),
                static_cast<int>(data.size()), reinterpret_cast<const char*>(data.data()));
    std::fflush(stdout);
  }
};

struct Quality {
  bool reliable;
  bool transient_local;
};

class Peer {
 public:
  explicit Peer(int domain) {
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<std::uint32_t>(domain), dds::PARTICIPANT_QOS_DEFAULT, &discovery_,
        dds::StatusMask::none());
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }

  dds::DataReader* read(const std::string& topic, const std::string& type, Quality quality,
                        std::function<void(Bytes&)> handle, const std::string& user_data = "") {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind =
        quality.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind = quality.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS
                                                    : dds::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 10;
    qos.user_data().assign(user_data.begin(), user_data.end());
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return subscriber_->create_datareader(make_topic(topic, type), qos,
                                          new OnMessage(std::move(handle)));
  }

  dds::DataWriter* write(const std::string& topic, const std::string& type,
                         const std::string& user_data) {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.user_data().assign(user_data.begin(), user_data.end());
    return publisher_->create_datawriter(make_topic(topic, type), qos);
  }

 private:
  dds::Topic* make_topic(const std::string& topic, const std::string& type) {
    dds::TypeSupport support(new RawType(type));
    support.register_type(participant_);
    return participant_->create_topic(topic, type, dds::TOPIC_QOS_DEFAULT);
  }

  PrintDiscovery discovery_;
  dds::DomainParticipant* participant_;
  dds::Publisher* publisher_;
  dds::Subscriber* subscriber_;
};

/// A message under construction, with its encapsulation header.
class Message {
 public:
  explicit Message(bool big_endian = false)
      : cdr_(buffer_, big_endian ? Cdr::BIG_ENDIANNESS : Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR) {
    cdr_.serialize_encapsulation();
  }
  template <class T>
  Message& add(const T& value) {
    cdr_ << value;
    return *this;
  }
  Bytes bytes() const {
    return {buffer_.getBuffer(), buffer_.getBuffer() + cdr_.getSerializedDataLength()};
  }

 private:
  FastBuffer buffer_;
  Cdr cdr_;
};

struct Stamp {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

template <class... T>
void read_into(Bytes& bytes, T&... values) {
  FastBuffer buffer(bytes.data(), bytes.size());
  Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  cdr.read_encapsulation();
  (void)(cdr >> ... >> values);
}

constexpr const char* kImu = "sensor_msgs::msg::dds_::Imu_";
constexpr const char* kTwist = "geometry_msgs::msg::dds_::TwistStamped_";
constexpr const char* kOdometry = "nav_msgs::msg::dds_::Odometry_";
constexpr const char* kInfo = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

void print_nodes(Bytes& bytes) {
  FastBuffer buffer(bytes.data(), bytes.size());
  Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  cdr.read_encapsulation();
  std::array<std::uint8_t, 16> gid{};
  std::uint32_t nodes = 0;
  cdr >> gid >> nodes;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    std::string name_space, name;
    std::uint32_t readers = 0, writers = 0;
    cdr >> name_space >> name >> readers;
    for (std::uint32_t k = 0; k < readers; ++k) cdr >> gid;
    cdr >> writers;
    for (std::uint32_t k = 0; k < writers; ++k) cdr >> gid;
    std::printf("node %s%s%s %u %u\n", name_space.c_str(), name_space == "/" ? "" : "/",
                name.c_str(), readers, writers);
    std::fflush(stdout);
  }
}

void echo(Peer& peer, bool big_endian) {
  dds::DataWriter* const commands = peer.write("rt/rover/cmd_vel", kTwist, "");
  peer.read("rt/rover/imu", kImu, {false, false}, [commands, big_endian](Bytes& imu) {
    Stamp stamp;
    std::string frame;
    std::array<double, 4> orientation{};
    std::array<double, 9> covariance{};
    std::array<double, 3> rate{};
    read_into(imu, stamp.sec, stamp.nanosec, frame, orientation, covariance, rate);
    Message twist(big_endian);
    twist.add(stamp.sec).add(stamp.nanosec).add(frame).add(rate[2]);
    for (int i = 0; i < 5; ++i) twist.add(0.0);
    Bytes bytes = twist.bytes();
    commands->write(&bytes);
  });
}

/// Keeps the heading and the line of the first Odometry.
void drive(Peer& peer, int delay_us) {
  dds::DataWriter* const commands = peer.write("rt/rover/cmd_vel", kTwist, "");
  peer.read("rt/rover/truth", kOdometry, {true, false}, [commands, delay_us](Bytes& odometry) {
    static bool has_line = false;
    static double x0 = 0.0, y0 = 0.0, yaw0 = 0.0;
    static int count = 0;
    Stamp stamp;
    std::string frame, child;
    std::array<double, 3> p{};
    std::array<double, 4> q{};
    read_into(odometry, stamp.sec, stamp.nanosec, frame, child, p, q);
    const double yaw =
        std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
    if (!has_line) x0 = p[0], y0 = p[1], yaw0 = yaw, has_line = true;
    const double left = -(p[0] - x0) * std::sin(yaw0) + (p[1] - y0) * std::cos(yaw0);
    const double turn = std::remainder(yaw0 - yaw, 2 * 3.14159265358979) - 0.8 * left;
    constexpr std::uint32_t kPeriod = 50'000'000, kSecond = 1'000'000'000;
    const std::uint32_t next = stamp.nanosec + kPeriod;
    Message twist;
    twist.add(stamp.sec + static_cast<std::int32_t>(next / kSecond)).add(next % kSecond);
    twist.add(std::string("rover/base_link")).add(0.3);
    for (int i = 0; i < 4; ++i) twist.add(0.0);
    Bytes bytes = twist.add(turn).bytes();
    std::this_thread::sleep_for(std::chrono::microseconds(delay_us));
    commands->write(&bytes);
    if (++count % 100 == 0) {
      std::printf("drove %d\n", count);
      std::fflush(stdout);
    }
  });
}

/// Sends each request until its reply is there: the server may discover this client late.
void call(Peer& peer) {
  // Identity and number of the request precede the message; both endpoints have the same client id.
  constexpr const char* kClient = "clientid=1.2.3;";
  static std::atomic<std::int64_t> answered = 0;
  dds::DataWriter* const requests =
      peer.write("rq/rover/enableRequest", "std_srvs::srv::dds_::SetBool_Request_", kClient);
  peer.read(
      "rr/rover/enableReply", "std_srvs::srv::dds_::SetBool_Response_", {true, false},
      [](Bytes& reply) {
        std::uint64_t client = 0;
        std::int64_t count = 0;
        bool success = false;
        std::string message;
        read_into(reply, client, count, success, message);
        if (answered.exchange(count) == count) return;
        std::printf("reply %llx %lld %d %s\n", static_cast<unsigned long long>(client),
                    static_cast<long long>(count), success, message.c_str());
        std::fflush(stdout);
      },
      kClient);
  for (std::int64_t count = 1; count <= 2; ++count) {
    const bool big_endian = count == 2;
    Bytes request =
        Message(big_endian).add(std::uint64_t{0x1122334455667788}).add(count).add(true).bytes();
    while (answered != count) {
      requests->write(&request);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  }
}

/// As call(), of a service without fields in its request.
void ask_state(Peer& peer) {
  constexpr const char* kClient = "clientid=1.2.4;";
  static std::atomic<bool> answered = false;
  dds::DataWriter* const requests =
      peer.write("rq/vinerow/get_simulation_stateRequest",
                 "simulation_interfaces::srv::dds_::GetSimulationState_Request_", kClient);
  peer.read(
      "rr/vinerow/get_simulation_stateReply",
      "simulation_interfaces::srv::dds_::GetSimulationState_Response_", {true, false},
      [](Bytes& reply) {
        std::uint64_t client = 0;
        std::int64_t count = 0;
        std::uint8_t state = 0, result = 0;
        read_into(reply, client, count, state, result);
        if (answered.exchange(true)) return;
        std::printf("state %d %d\n", state, result);
        std::fflush(stdout);
      },
      kClient);
  Bytes request = Message().add(std::uint64_t{7}).add(std::int64_t{1}).add(std::uint8_t{0}).bytes();
  while (!answered) {
    requests->write(&request);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  Peer peer(std::atoi(argv[1]));
  const std::string mode = argv[2];
  peer.read("ros_discovery_info", kInfo, {true, true}, print_nodes);
  if (mode == "echo") {
    echo(peer, argc > 3);
  } else if (mode == "listen") {
    peer.read("rt/rover/imu", kImu, {true, false}, [](Bytes& imu) {
      Stamp stamp;
      read_into(imu, stamp.sec);
      std::printf("imu %d\n", stamp.sec);
      std::fflush(stdout);
    });
  } else if (mode == "latched") {
    peer.read("rt/map", "std_msgs::msg::dds_::String_", {true, true}, [](Bytes& map) {
      std::string text;
      read_into(map, text);
      std::printf("map %zu\n", text.size());
      std::fflush(stdout);
    });
  } else if (mode == "drive") {
    drive(peer, argc > 3 ? std::atoi(argv[3]) : 0);
  } else if (mode == "call") {
    call(peer);
  } else if (mode == "state") {
    ask_state(peer);
  }
  for (std::string line; std::getline(std::cin, line);) {
  }
  std::_Exit(0);  // no orderly leave: a killed node looks the same
}
