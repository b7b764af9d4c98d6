#include "engine/ros2/publisher.h"

#include "engine/ros2/participant.h"
#include "engine/ros2/raw_type.h"

namespace vinerow::ros2 {

Publisher::Publisher(std::shared_ptr<Participant> participant, std::int32_t writer,
                     const ddsi_sertype* type)
    : participant_(std::move(participant)), writer_(writer), type_(type) {}

Publisher::~Publisher() {
  participant_->remove_writer(writer_);
}

bool Publisher::publish(std::span<const std::uint8_t> cdr) {
  ddsi_serdata* const sample = cdr.size() < 4 ? nullptr : new_raw_sample(type_, cdr);
  if (sample != nullptr && dds_writecdr(writer_, sample) == DDS_RETCODE_OK) return true;
  ++dropped_;
  return false;
}

int Publisher::subscriber_count() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer_, &status);
  return static_cast<int>(status.current_count);
}

Guid Publisher::guid() const {
  return guid_of(writer_);
}

}  // namespace vinerow::ros2
