#include "engine/ros2/dds_qos.h"

namespace vinerow::ros2 {
namespace {

DdsQos with_user_data(const std::string& user_data) {
  DdsQos qos(dds_create_qos());
  if (!user_data.empty()) dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  return qos;
}

}  // namespace

DdsQos make_dds_qos(const Qos& qos, const std::string& user_data) {
  DdsQos result = with_user_data(user_data);
  dds_qos_t* const dds = result.get();
  dds_qset_history(dds, DDS_HISTORY_KEEP_LAST, qos.depth);
  // A blocking time of 0: should Cyclone ever have no room, the message is dropped, not delayed.
  dds_qset_reliability(dds, qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       0);
  if (qos.transient_local) {
    dds_qset_durability(dds, DDS_DURABILITY_TRANSIENT_LOCAL);
    // Cyclone takes the history for late readers from here, not from the history policy.
    dds_qset_durability_service(dds, 0, DDS_HISTORY_KEEP_LAST, qos.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  } else {
    dds_qset_durability(dds, DDS_DURABILITY_VOLATILE);
  }
  dds_qset_writer_data_lifecycle(dds, false);  // messages have no keys to dispose of
  dds_qset_liveliness(dds, DDS_LIVELINESS_AUTOMATIC, DDS_INFINITY);
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(dds, 1, &xcdr1);
  return result;
}

DdsQos make_participant_qos() {
  return with_user_data("enclave=/;");
}

std::string type_hash_entry(const std::string& type_hash) {
  return type_hash.empty() ? std::string() : "typehash=" + type_hash + ";";
}

std::string user_data_value(const dds_qos_t* qos, const std::string& key) {
  void* bytes = nullptr;
  std::size_t size = 0;
  if (qos == nullptr || !dds_qget_userdata(qos, &bytes, &size) || bytes == nullptr) return {};
  std::string text(static_cast<const char*>(bytes), size);
  dds_free(bytes);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(';', at), text.size());
    if (text.compare(at, key.size() + 1, key + "=") == 0) {
      const std::size_t value = at + key.size() + 1;
      return text.substr(value, end - value);
    }
    at = end + 1;
  }
  return {};
}

}  // namespace vinerow::ros2
