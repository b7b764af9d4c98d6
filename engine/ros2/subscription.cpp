#include "engine/ros2/subscription.h"

#include <cstring>

#include "engine/ros2/participant.h"
#include "engine/ros2/raw_type.h"

namespace vinerow::ros2 {

Subscription::Subscription(std::shared_ptr<Participant> participant, std::int32_t reader)
    : participant_(std::move(participant)), reader_(reader) {}

Subscription::~Subscription() {
  participant_->remove_reader(reader_);
}

bool Subscription::take(Message& out) {
  ddsi_serdata* sample = nullptr;
  dds_sample_info_t info{};
  while (dds_takecdr(reader_, &sample, 1, &info, DDS_ANY_STATE) == 1) {
    const bool valid = info.valid_data;  // false for a writer that left
    if (valid) {
      const std::span<const std::uint8_t> bytes = raw_bytes(sample);
      out.cdr.assign(bytes.begin(), bytes.end());
      out.writer = writer_of(info.publication_handle);
      out.source_time_ns = info.source_timestamp;
    }
    ddsi_serdata_unref(sample);
    if (valid) return true;
  }
  return false;
}

Guid Subscription::writer_of(std::uint64_t handle) {
  const auto known = writers_.find(handle);
  if (known != writers_.end()) return known->second;
  Guid guid{};
  if (dds_builtintopic_endpoint_t* const writer =
          dds_get_matched_publication_data(reader_, handle)) {
    std::memcpy(guid.data(), writer->key.v, guid.size());
    dds_builtintopic_free_endpoint(writer);
    writers_.emplace(handle, guid);
  }
  return guid;
}

int Subscription::publisher_count() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader_, &status);
  return static_cast<int>(status.current_count);
}

Guid Subscription::guid() const {
  return guid_of(reader_);
}

}  // namespace vinerow::ros2
