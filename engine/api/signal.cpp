#include "engine/api/signal.h"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {
namespace {

/// Feeds every field of a message to the digest.
struct HashField {
  Hasher& hasher;

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) { hasher.add(value); }
  void operator()(const std::string& text) { hasher.add(std::string_view(text)); }
  void operator()(const Eigen::Vector3d& v) { hasher.add_bytes(v.data(), sizeof(double) * 3); }
  void operator()(const Eigen::Quaterniond& q) {
    hasher.add_bytes(q.coeffs().data(), sizeof(double) * 4);
  }
  void operator()(const std::vector<double>& values) {
    hasher.add(static_cast<std::uint64_t>(values.size()));
    hasher.add_bytes(values.data(), values.size() * sizeof(double));
  }
  void operator()(const std::vector<std::uint8_t>& bytes) {
    hasher.add(static_cast<std::uint64_t>(bytes.size()));
    hasher.add_bytes(bytes.data(), bytes.size());
  }
  void operator()(const std::vector<std::string>& texts) {
    hasher.add(static_cast<std::uint64_t>(texts.size()));
    for (const std::string& text : texts) hasher.add(std::string_view(text));
  }
};

/// Finds a field that is not a number.
struct NanField {
  bool found = false;

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) {
    if constexpr (std::is_floating_point_v<T>) found = found || std::isnan(value);
  }
  void operator()(const std::string&) {}
  void operator()(const Eigen::Vector3d& v) { found = found || v.array().isNaN().any(); }
  void operator()(const Eigen::Quaterniond& q) {
    found = found || q.coeffs().array().isNaN().any();
  }
  void operator()(const std::vector<double>& values) {
    for (const double value : values) found = found || std::isnan(value);
  }
  void operator()(const std::vector<std::uint8_t>&) {}
  void operator()(const std::vector<std::string>&) {}
};

}  // namespace

template <class T>
void Signal<T>::hash_into(Hasher& hasher) {
  hasher.add(std::string_view(name_));
  hasher.add(stamp_.ns);
  value_.fields(HashField{hasher});
}

template <class T>
bool Signal<T>::has_nan() {
  NanField check;
  value_.fields(check);
  return check.found;
}

template class Signal<Odometry>;
template class Signal<ImuSample>;
template class Signal<GnssFix>;
template class Signal<RangeSample>;
template class Signal<PressureSample>;
template class Signal<MagneticSample>;
template class Signal<LaserScan>;
template class Signal<PositionEllipsoid>;
template class Signal<VelocityCommand>;
template class Signal<LocalCommand>;
template class Signal<LineList>;
template class Signal<OccupancyGrid>;
template class Signal<NamedValues>;
template class Signal<LinkPoses>;
template class Signal<PlannedPath>;
template class Signal<FollowerState>;
template class Signal<MovementAuthority>;
template class Signal<ReferenceTrajectory>;
template class Signal<AirReference>;
template class Signal<AirData>;
template class Signal<CameraShot>;
template class Signal<BatteryState>;
template class Signal<Event>;

SignalBase& SignalBus::slot(const std::string& name, const char* type, const std::string& who,
                            std::unique_ptr<SignalBase> (*make)(const std::string&)) {
  if (SignalBase* existing = find(name)) {
    if (std::string_view(existing->type()) != type) {
      throw ConfigError(fmt::format("{} takes signal '{}' as {}, but it is {}", who, name, type,
                                    existing->type()));
    }
    return *existing;
  }
  signals_.push_back(make(name));
  by_name_.emplace(name, signals_.back().get());
  return *signals_.back();
}

void SignalBus::release(std::string_view part) {
  const std::string below = std::string(part) + ".";
  for (const auto& signal : signals_) {
    if (!signal->writer_.starts_with(below)) continue;
    signal->writer_.clear();
    signal->forgotten_ = signal->sequence_;
  }
}

void SignalBus::set_writer(SignalBase& signal, const std::string& writer) {
  if (!signal.writer_.empty()) {
    throw ConfigError(fmt::format("signal '{}' is written by both {} and {}", signal.name(),
                                  signal.writer_, writer));
  }
  signal.writer_ = writer;
}

void SignalBus::set_reader(SignalBase& signal, const std::string& reader) {
  signal.is_read_ = true;
  if (signal.first_reader_.empty()) signal.first_reader_ = reader;
}

void SignalBus::check_connected() const {
  for (const auto& signal : signals_) {
    if (!signal->writer().empty() || signal->first_reader().empty()) continue;
    // Only names of the same vehicle can be meant, and only their last part can be mistyped.
    const std::size_t slash = signal->name().find('/') + 1;
    const std::string scope = signal->name().substr(0, slash);
    std::vector<std::string> written;
    for (const auto& other : signals_) {
      const bool is_meant = !other->writer().empty() && other->name().starts_with(scope);
      if (is_meant) written.push_back(other->name().substr(slash));
    }
    throw ConfigError(fmt::format(
        "{} reads signal '{}', which nobody writes{} (written in '{}': {})", signal->first_reader(),
        signal->name(), did_you_mean(signal->name().substr(slash), written), scope, join(written)));
  }
}

SignalBase* SignalBus::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : found->second;
}

}  // namespace vinerow
