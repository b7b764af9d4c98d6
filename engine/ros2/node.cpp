#include "engine/ros2/node.h"

#include "engine/ros2/dds_qos.h"
#include "engine/ros2/names.h"
#include "engine/ros2/participant.h"

namespace vinerow::ros2 {

Node::Node(const NodeOptions& options) : participant_(std::make_shared<Participant>(options)) {}

Node::~Node() = default;

std::unique_ptr<Publisher> Node::create_publisher(const std::string& topic, const std::string& type,
                                                  const Qos& qos, const std::string& type_hash) {
  const Participant::Writer writer = participant_->create_writer(
      "rt" + resolve_name(topic, name_space(), name()), type, qos, type_hash_entry(type_hash));
  std::unique_ptr<Publisher> publisher(new Publisher(participant_, writer.entity, writer.type));
  participant_->announce_writer(writer.entity);
  return publisher;
}

std::unique_ptr<Subscription> Node::create_subscription(const std::string& topic,
                                                        const std::string& type, const Qos& qos,
                                                        const std::string& type_hash) {
  const dds_entity_t reader = participant_->create_reader(
      "rt" + resolve_name(topic, name_space(), name()), type, qos, type_hash_entry(type_hash));
  std::unique_ptr<Subscription> subscription(new Subscription(participant_, reader));
  participant_->announce_reader(reader);
  return subscription;
}

std::unique_ptr<Service> Node::create_service(const std::string& service, const std::string& type,
                                              const std::string& request_hash,
                                              const std::string& response_hash, const Qos& qos) {
  const std::string name = resolve_name(service, name_space(), this->name());
  const std::string id = participant_->next_service_id();
  const Participant::Writer writer = participant_->create_writer(
      "rr" + name + "Reply", type + "_Response", qos, id + type_hash_entry(response_hash));
  dds_entity_t reader = 0;
  try {
    reader = participant_->create_reader("rq" + name + "Request", type + "_Request", qos,
                                         id + type_hash_entry(request_hash));
  } catch (...) {
    dds_delete(writer.entity);
    throw;
  }
  std::unique_ptr<Service> server(new Service(participant_, reader, writer.entity, writer.type));
  participant_->announce_writer(writer.entity);
  participant_->announce_reader(reader);
  return server;
}

bool Node::wait(std::chrono::nanoseconds timeout) {
  return participant_->wait(timeout);
}

void Node::wake() {
  participant_->wake();
}

const std::string& Node::name() const {
  return participant_->info().node_name;
}

const std::string& Node::name_space() const {
  return participant_->info().name_space;
}

Guid Node::participant() const {
  return participant_->info().participant;
}

}  // namespace vinerow::ros2
