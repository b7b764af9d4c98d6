#include "engine/ros2/participant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/core/error.h"
#include "engine/ros2/dds_qos.h"
#include "engine/ros2/names.h"
#include "engine/ros2/raw_type.h"
#include "engine/ros2/type_hash.h"

namespace vinerow::ros2 {
namespace {

const NodeOptions& checked(const NodeOptions& options) {
  check_node_name(options.name);
  check_name_space(options.name_space);
  return options;
}

/// @throws ConfigError "<what>: <reason of Cyclone>" if `entity` is an error code
dds_entity_t created(dds_entity_t entity, std::string_view what) {
  if (entity < 0) throw ConfigError(fmt::format("{}: {}", what, dds_strretcode(-entity)));
  return entity;
}

}  // namespace

Guid guid_of(dds_entity_t entity) {
  dds_guid_t dds{};
  dds_get_guid(entity, &dds);
  Guid guid;
  std::memcpy(guid.data(), dds.v, guid.size());
  return guid;
}

Participant::Participant(const NodeOptions& options)
    : domain_(checked(options).domain_id, options.network), humble_(options.humble) {
  const std::string what = fmt::format("node '{}' in ROS domain {}", options.name, domain_.id());
  participant_ = created(dds_create_participant(static_cast<dds_domainid_t>(domain_.id()),
                                                make_participant_qos().get(), nullptr),
                         what);
  try {
    info_.name_space = options.name_space;
    info_.node_name = options.name;
    info_.participant = guid_of(participant_);
    waitset_ = created(dds_create_waitset(participant_), what);
    wake_ = created(dds_create_guardcondition(participant_), what);
    created(dds_waitset_attach(waitset_, wake_, wake_), what);
    // Humble has neither hashes nor this form of the message.
    const std::string hash =
        humble_ ? "" : message_type_hash(kDiscoveryType, discovery_definition());
    info_writer_ =
        create_writer(kDiscoveryTopic, kDiscoveryType, kLatchedQos, type_hash_entry(hash));
    publish_info();
  } catch (...) {
    dds_delete(participant_);
    throw;
  }
}

Participant::~Participant() {
  dds_delete(participant_);
}

std::pair<dds_entity_t, const ddsi_sertype*> Participant::create_topic(const std::string& topic,
                                                                       const std::string& type) {
  ddsi_sertype* raw_type = new_raw_type(dds_type_name(type));
  const dds_entity_t entity =
      dds_create_topic_sertype(participant_, topic.c_str(), &raw_type, nullptr, nullptr, nullptr);
  if (entity < 0) {
    ddsi_sertype_unref(raw_type);
    created(entity, fmt::format("topic '{}' of type {}", topic, type));
  }
  // The pointer may have changed to an equal type that the domain already had.
  return {entity, raw_type};
}

Participant::Writer Participant::create_writer(const std::string& topic, const std::string& type,
                                               const Qos& qos, const std::string& user_data) {
  const auto [topic_entity, raw_type] = create_topic(topic, type);
  const dds_entity_t writer =
      dds_create_writer(participant_, topic_entity, make_dds_qos(qos, user_data).get(), nullptr);
  dds_delete(topic_entity);  // the writer keeps what it needs
  return {created(writer, fmt::format("publisher of '{}'", topic)), raw_type};
}

dds_entity_t Participant::create_reader(const std::string& topic, const std::string& type,
                                        const Qos& qos, const std::string& user_data) {
  const auto [topic_entity, raw_type] = create_topic(topic, type);
  const dds_entity_t reader =
      dds_create_reader(participant_, topic_entity, make_dds_qos(qos, user_data).get(), nullptr);
  dds_delete(topic_entity);
  created(reader, fmt::format("subscription of '{}'", topic));
  // The condition is deleted with its reader.
  const dds_entity_t has_data = dds_create_readcondition(reader, DDS_ANY_STATE);
  dds_waitset_attach(waitset_, has_data, reader);
  return reader;
}

void Participant::announce_writer(dds_entity_t writer) {
  const std::lock_guard lock(mutex_);
  info_.writers.push_back(guid_of(writer));
  publish_info();
}

void Participant::announce_reader(dds_entity_t reader) {
  const std::lock_guard lock(mutex_);
  info_.readers.push_back(guid_of(reader));
  publish_info();
}

void Participant::remove_writer(dds_entity_t writer) {
  const std::lock_guard lock(mutex_);
  std::erase(info_.writers, guid_of(writer));
  publish_info();
  dds_delete(writer);
}

void Participant::remove_reader(dds_entity_t reader) {
  const std::lock_guard lock(mutex_);
  std::erase(info_.readers, guid_of(reader));
  publish_info();
  dds_delete(reader);
}

std::string Participant::next_service_id() {
  const std::lock_guard lock(mutex_);
  // Unique among all participants: this one's 12 bytes and a counter in place of the endpoint.
  Guid id = info_.participant;
  const std::uint32_t count = ++last_service_;
  for (std::size_t i = 0; i < 4; ++i) {
    id[12 + i] = static_cast<std::uint8_t>(count >> (24 - 8 * i));
  }
  std::string text;
  for (const std::uint8_t byte : id) text += fmt::format("{}{:x}", text.empty() ? "" : ".", byte);
  return "serviceid=" + text + ";";
}

bool Participant::wait(std::chrono::nanoseconds timeout) {
  dds_attach_t first = 0;  // one of the triggered entities
  const dds_return_t triggered =
      dds_waitset_wait(waitset_, &first, 1, std::max<std::int64_t>(timeout.count(), 0));
  bool woken = false;
  dds_take_guardcondition(wake_, &woken);
  return triggered > 1 || (triggered == 1 && first != wake_);
}

void Participant::wake() {
  dds_set_guardcondition(wake_, true);
}

void Participant::publish_info() {
  record::ByteBuffer message;
  write_discovery_info(info_, humble_, message);
  if (ddsi_serdata* const sample = new_raw_sample(info_writer_.type, message.view())) {
    dds_writecdr(info_writer_.entity, sample);
  }
}

}  // namespace vinerow::ros2
