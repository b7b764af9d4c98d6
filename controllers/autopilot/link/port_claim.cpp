#include "controllers/autopilot/link/port_claim.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

std::mutex mutex_of_claims;

/// Owners by port of a run; the old and the new parts of one owner may exist together.
std::map<std::string, std::multiset<std::string>>& claims() {
  static std::map<std::string, std::multiset<std::string>> all;
  return all;
}

}  // namespace

PortClaim::PortClaim(std::string run, Protocol protocol, mavlink::UdpAddress address,
                     std::string who)
    : who_(std::move(who)) {
  const std::string port = fmt::format(
      "{} port {} of {}.{}.{}.{}", protocol == Protocol::kTcp ? "TCP" : "UDP", address.port,
      address.host >> 24, address.host >> 16 & 0xff, address.host >> 8 & 0xff, address.host & 0xff);
  place_ = std::move(run) + "\n" + port;
  const std::lock_guard lock(mutex_of_claims);
  std::multiset<std::string>& owners = claims()[place_];
  if (!owners.empty() && *owners.begin() != who_) {
    throw ConfigError(
        fmt::format("{}: {} is that of {}: give one of them another instance or mavlink_port", who_,
                    port, *owners.begin()));
  }
  owners.insert(who_);
}

PortClaim::~PortClaim() {
  const std::lock_guard lock(mutex_of_claims);
  const auto owners = claims().find(place_);
  owners->second.erase(owners->second.find(who_));
  if (owners->second.empty()) claims().erase(owners);
}

}  // namespace vinerow::controllers
