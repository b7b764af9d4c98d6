#include "engine/ros2/service.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include "engine/ros2/dds_qos.h"
#include "engine/ros2/participant.h"
#include "engine/ros2/raw_type.h"

namespace vinerow::ros2 {
namespace {

constexpr std::size_t kEncapsulationSize = 4;

/// Second byte of the encapsulation header: 0 = big-endian, 1 = little-endian.
bool same_byte_order(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  return ((a[1] ^ b[1]) & 1) == 0;
}

struct FreeEndpoint {
  void operator()(dds_builtintopic_endpoint_t* endpoint) const {
    dds_builtintopic_free_endpoint(endpoint);
  }
};
using Endpoint = std::unique_ptr<dds_builtintopic_endpoint_t, FreeEndpoint>;

}  // namespace

Service::Service(std::shared_ptr<Participant> participant, std::int32_t reader, std::int32_t writer,
                 const ddsi_sertype* response_type)
    : participant_(std::move(participant)),
      reader_(reader),
      writer_(writer),
      response_type_(response_type) {}

Service::~Service() {
  participant_->remove_reader(reader_);
  participant_->remove_writer(writer_);
}

bool Service::take(Request& out) {
  ddsi_serdata* sample = nullptr;
  dds_sample_info_t info{};
  while (dds_takecdr(reader_, &sample, 1, &info, DDS_ANY_STATE) == 1) {
    const std::span<const std::uint8_t> bytes = raw_bytes(sample);
    const bool valid = info.valid_data && bytes.size() >= kEncapsulationSize + out.header.size();
    if (valid) {
      const auto body = bytes.subspan(kEncapsulationSize + out.header.size());
      std::memcpy(out.header.data(), bytes.data() + kEncapsulationSize, out.header.size());
      out.cdr.assign(bytes.begin(), bytes.begin() + kEncapsulationSize);
      // The header is a multiple of 8 bytes: the alignment of the body does not change.
      out.cdr.insert(out.cdr.end(), body.begin(), body.end());
      out.writer = info.publication_handle;
    }
    ddsi_serdata_unref(sample);
    if (valid) return true;
  }
  return false;
}

bool Service::reply(const Request& request, std::span<const std::uint8_t> cdr) {
  if (cdr.size() < kEncapsulationSize || request.cdr.size() < kEncapsulationSize) return false;
  constexpr auto kPatience = std::chrono::milliseconds(100), kPause = std::chrono::milliseconds(1);
  for (auto waited = kPatience * 0; !client_reads(request.writer); waited += kPause) {
    if (waited >= kPatience) return false;
    std::this_thread::sleep_for(kPause);
  }
  std::array<std::uint8_t, kEncapsulationSize + 16> start{};
  std::copy_n(cdr.begin(), kEncapsulationSize, start.begin());
  std::copy(request.header.begin(), request.header.end(), start.begin() + kEncapsulationSize);
  if (!same_byte_order(cdr, request.cdr)) {  // two 8-byte numbers
    std::reverse(start.begin() + kEncapsulationSize, start.begin() + kEncapsulationSize + 8);
    std::reverse(start.begin() + kEncapsulationSize + 8, start.end());
  }
  ddsi_serdata* const sample =
      new_raw_sample(response_type_, start, cdr.subspan(kEncapsulationSize));
  return sample != nullptr && dds_writecdr(writer_, sample) == DDS_RETCODE_OK;
}

/// True if the reader of the client with this request writer is matched. Both have the same
/// "clientid" in their user data; a client without one is assumed to read.
bool Service::client_reads(std::uint64_t request_writer) const {
  const Endpoint writer(dds_get_matched_publication_data(reader_, request_writer));
  if (writer == nullptr) return false;
  const std::string client = user_data_value(writer->qos, "clientid");
  if (client.empty()) return true;
  std::vector<dds_instance_handle_t> readers(16);
  dds_return_t count = 0;
  while ((count = dds_get_matched_subscriptions(writer_, readers.data(), readers.size())) >
         static_cast<dds_return_t>(readers.size())) {
    readers.resize(static_cast<std::size_t>(count));
  }
  readers.resize(static_cast<std::size_t>(std::max(count, 0)));
  return std::any_of(readers.begin(), readers.end(), [&](dds_instance_handle_t handle) {
    const Endpoint reader(dds_get_matched_subscription_data(writer_, handle));
    return reader != nullptr && user_data_value(reader->qos, "clientid") == client;
  });
}

}  // namespace vinerow::ros2
