#include "engine/ros2/raw_type.h"

#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

namespace vinerow::ros2 {
namespace {

// Chosen: Cyclone's own limit for samples (Internal/MaxSampleSize).
constexpr std::size_t kMaxSampleSize = 0x7fffffff - 3;

struct RawSample : ddsi_serdata {
  std::unique_ptr<std::uint8_t[]> bytes;
  std::uint32_t size = 0;  ///< a multiple of 4
};

struct RawType : ddsi_sertype {};

const RawSample& raw(const ddsi_serdata* sample) {
  return *static_cast<const RawSample*>(sample);
}

/// Sample of `size` bytes, all undefined but the padding. The callbacks below are called from C:
/// they must not throw.
RawSample* new_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  if (size > kMaxSampleSize) return nullptr;
  std::unique_ptr<RawSample> sample(new (std::nothrow) RawSample());
  if (sample == nullptr) return nullptr;
  ddsi_serdata_init(sample.get(), type, kind);
  const std::size_t padded = (size + 3) / 4 * 4;
  sample->bytes.reset(new (std::nothrow) std::uint8_t[padded + 4]);
  if (sample->bytes == nullptr) return nullptr;
  std::memset(sample->bytes.get() + size, 0, padded - size);
  sample->size = static_cast<std::uint32_t>(padded);
  return sample.release();
}

// Messages have no keys: all samples of a topic are of the same instance.
bool same_key(const ddsi_serdata*, const ddsi_serdata*) {
  return true;
}

std::uint32_t sample_size(const ddsi_serdata* sample) {
  return raw(sample).size;
}

ddsi_serdata* from_network(const ddsi_sertype* type, ddsi_serdata_kind kind,
                           const nn_rdata* fragment, std::size_t size) {
  RawSample* const sample = new_sample(type, kind, size);
  if (sample == nullptr) return nullptr;
  std::size_t filled = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    // Fragments are in order, but may overlap.
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end <= filled || fragment->min > filled) continue;
    const std::uint8_t* const payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(sample->bytes.get() + filled, payload + (filled - fragment->min), end - filled);
    filled = end;
  }
  std::memset(sample->bytes.get() + filled, 0, size - filled);
  return sample;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces, std::size_t size) {
  RawSample* const sample = new_sample(type, kind, size);
  if (sample == nullptr) return nullptr;
  std::size_t filled = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
    const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - filled);
    if (length > 0) std::memcpy(sample->bytes.get() + filled, pieces[i].iov_base, length);
    filled += length;
  }
  std::memset(sample->bytes.get() + filled, 0, size - filled);
  return sample;
}

ddsi_serdata* from_key(const ddsi_sertype* type, const ddsi_keyhash*) {
  return new_sample(type, SDK_KEY, 0);
}

// Samples have no C++ form: they are written by dds_writecdr() and taken by dds_takecdr().
ddsi_serdata* from_object(const ddsi_sertype* type, ddsi_serdata_kind kind, const void*) {
  return kind == SDK_KEY ? new_sample(type, SDK_KEY, 0) : nullptr;
}
bool to_object(const ddsi_serdata*, void*, void**, void*) {
  return false;
}
bool key_to_object(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
  return false;
}

void copy_out(const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* out) {
  std::memcpy(out, raw(sample).bytes.get() + offset, size);
}

ddsi_serdata* lend(const ddsi_serdata* sample, std::size_t offset, std::size_t size,
                   ddsrt_iovec_t* out) {
  out->iov_base = raw(sample).bytes.get() + offset;
  out->iov_len = static_cast<ddsrt_iov_len_t>(size);
  return ddsi_serdata_ref(sample);
}
void take_back(ddsi_serdata* sample, const ddsrt_iovec_t*) {
  ddsi_serdata_unref(sample);
}

/// Cyclone keeps the key for longer than the type: it must not point to it.
ddsi_serdata* key_of(const ddsi_serdata* sample) {
  RawSample* const key = new_sample(sample->type, SDK_KEY, 0);
  if (key != nullptr) key->type = nullptr;
  return key;
}

void free_sample(ddsi_serdata* sample) {
  delete static_cast<RawSample*>(sample);
}

std::size_t print(const ddsi_sertype*, const ddsi_serdata* sample, char* out, std::size_t size) {
  const int length = std::snprintf(out, size, "(%u bytes)", sample_size(sample));
  return length < 0 ? 0 : static_cast<std::size_t>(length);
}

void key_hash(const ddsi_serdata*, ddsi_keyhash* hash, bool) {
  *hash = {};
}

// Assignment by name: with shared memory support the struct has more members, which stay null
// (a type without a fixed size is not sent through shared memory).
const ddsi_serdata_ops kSampleFunctions = [] {
  ddsi_serdata_ops ops{};
  ops.eqkey = same_key;
  ops.get_size = sample_size;
  ops.from_ser = from_network;
  ops.from_ser_iov = from_pieces;
  ops.from_keyhash = from_key;
  ops.from_sample = from_object;
  ops.to_ser = copy_out;
  ops.to_ser_ref = lend;
  ops.to_ser_unref = take_back;
  ops.to_sample = to_object;
  ops.to_untyped = key_of;
  ops.untyped_to_sample = key_to_object;
  ops.free = free_sample;
  ops.print = print;
  ops.get_keyhash = key_hash;
  return ops;
}();

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<RawType*>(type);
}
// Called for types of equal name only.
bool same_type(const ddsi_sertype*, const ddsi_sertype*) {
  return true;
}
std::uint32_t type_hash_of(const ddsi_sertype*) {
  return 0;
}
void zero_objects(const ddsi_sertype*, void*, std::size_t) {}
void new_objects(void** objects, const ddsi_sertype*, void*, std::size_t, std::size_t count) {
  std::fill_n(objects, count, nullptr);
}
void free_objects(const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {}

const ddsi_sertype_ops kTypeFunctions = [] {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = free_type;
  ops.zero_samples = zero_objects;
  ops.realloc_samples = new_objects;
  ops.free_samples = free_objects;
  ops.equal = same_type;
  ops.hash = type_hash_of;
  return ops;
}();

}  // namespace

ddsi_sertype* new_raw_type(const std::string& dds_type_name) {
  auto type = std::make_unique<RawType>();
  ddsi_sertype_init_flags(type.get(), dds_type_name.c_str(), &kTypeFunctions, &kSampleFunctions,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type.release();
}

ddsi_serdata* new_raw_sample(const ddsi_sertype* type, std::span<const std::uint8_t> first,
                             std::span<const std::uint8_t> second) {
  RawSample* const sample = new_sample(type, SDK_DATA, first.size() + second.size());
  if (sample == nullptr) return nullptr;
  if (!first.empty()) std::memcpy(sample->bytes.get(), first.data(), first.size());
  if (!second.empty()) {
    std::memcpy(sample->bytes.get() + first.size(), second.data(), second.size());
  }
  return sample;
}

std::span<const std::uint8_t> raw_bytes(const ddsi_serdata* sample) {
  return {raw(sample).bytes.get(), raw(sample).size};
}

}  // namespace vinerow::ros2
