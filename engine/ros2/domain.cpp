#include "engine/ros2/domain.h"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <mutex>

#include "engine/core/error.h"
#include "engine/ros2/loopback_sockets.h"

namespace vinerow::ros2 {
namespace {

// The last domain whose ports fit into 16 bits.
constexpr int kMaxDomainId = 232;

// Cyclone's limit (MAX_XMIT_CONNS).
constexpr std::size_t kMaxInterfaces = 4;

// Peers of this host with default settings announce its network addresses, not 127.0.0.1, and
// Cyclone ignores peers without an address on one of its interfaces: so it gets them all, and
// DomainSockets keeps the packets on the host.
// The loopback device may carry 64 KiB packets, so that most messages need one. The number of
// participants to look for on this host and localhost as peer are the choices of
// rmw_cyclonedds_cpp for ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST. Without multicast nothing but the
// repeated announcement finds a peer that starts later: one second instead of Cyclone's 30.
constexpr const char* kLoopbackConfiguration = R"(<CycloneDDS><Domain>
<General><Interfaces>{}</Interfaces>
<AllowMulticast>false</AllowMulticast>
<MaxMessageSize>65000B</MaxMessageSize><MaxRexmitMessageSize>65000B</MaxRexmitMessageSize>
<FragmentSize>60000B</FragmentSize></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<SPDPInterval>1s</SPDPInterval>
<Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>)";

// As rmw_cyclonedds_cpp for ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET.
constexpr const char* kNetworkConfiguration = R"(<CycloneDDS><Domain>
<Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex></Discovery>
</Domain></CycloneDDS>)";

struct OpenDomain {
  dds_entity_t entity = 0;
  bool network = false;
  int owners = 0;
};

std::mutex g_domains_mutex;
std::map<int, OpenDomain> g_domains;

/// Collects what Cyclone logs, in place of printing it, to name the reason of a failure.
class LogCapture {
 public:
  LogCapture() { dds_set_log_sink(&keep, this); }
  ~LogCapture() { dds_set_log_sink(nullptr, nullptr); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  const std::string& text() const { return text_; }

 private:
  static void keep(void* self, const dds_log_data_t* line) {
    auto& capture = *static_cast<LogCapture*>(self);
    const std::lock_guard lock(capture.mutex_);
    if ((line->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) == 0) return;
    std::string text(line->message, line->size);
    text.resize(text.find_last_not_of(". \n") + 1);
    // The first error names the cause, later ones are its consequences.
    if (capture.text_.empty()) capture.text_ = std::move(text);
  }

  std::mutex mutex_;
  std::string text_;
};

OpenDomain open_domain(int id, bool network) {
  const char* const environment = std::getenv("CYCLONEDDS_URI");
  const bool by_user = environment != nullptr && *environment != '\0';
  const std::string configuration = by_user ? environment : domain_configuration(network);
  const DomainSockets sockets;
  const LogCapture log;
  OpenDomain domain;
  domain.network = network;
  domain.entity = dds_create_domain(static_cast<dds_domainid_t>(id), configuration.c_str());
  if (domain.entity < 0) {
    throw ConfigError(
        fmt::format("DDS domain {} does not start: {}", id,
                    log.text().empty() ? dds_strretcode(-domain.entity) : log.text().c_str()));
  }
  if (network || by_user) return domain;
  try {
    sockets.bind_to_loopback();
  } catch (const ConfigError&) {
    dds_delete(domain.entity);
    throw;
  }
  return domain;
}

}  // namespace

std::string domain_configuration(bool network) {
  if (network) return kNetworkConfiguration;
  std::string interfaces;
  for (const std::string& address : own_addresses(kMaxInterfaces)) {
    interfaces += fmt::format(R"(<NetworkInterface address="{}"/>)", address);
  }
  return fmt::format(kLoopbackConfiguration, interfaces);
}

Domain::Domain(int id, bool network) : id_(id) {
  if (id < 0 || id > kMaxDomainId) {
    throw ConfigError(fmt::format("ROS domain id = {}, must be from 0 to {}", id, kMaxDomainId));
  }
  const std::lock_guard lock(g_domains_mutex);
  auto found = g_domains.find(id);
  if (found == g_domains.end()) found = g_domains.emplace(id, open_domain(id, network)).first;
  if (found->second.network != network) {
    throw ConfigError(fmt::format("DDS domain {} is open with another choice of network", id));
  }
  ++found->second.owners;
}

Domain::~Domain() {
  const std::lock_guard lock(g_domains_mutex);
  const auto found = g_domains.find(id_);
  if (--found->second.owners > 0) return;
  dds_delete(found->second.entity);
  g_domains.erase(found);
}

}  // namespace vinerow::ros2
