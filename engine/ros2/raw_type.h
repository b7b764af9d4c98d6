#pragma once
/// A Cyclone DDS type whose samples are the bytes of a message: Cyclone neither reads nor changes
/// them, so one type serves every ROS 2 message, and no damaged message can make it fail.
/// Internal to this folder.
///
/// Source: the interface of dds/ddsi/ddsi_sertype.h and ddsi_serdata.h of Cyclone DDS 0.10.

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <cstdint>
#include <span>
#include <string>

namespace vinerow::ros2 {

/// @returns a new type; dds_create_topic_sertype() takes it over
ddsi_sertype* new_raw_type(const std::string& dds_type_name);

/// A sample of two pieces in a row, padded with zeros to a multiple of 4 bytes as RTPS demands.
/// @returns null if there is no memory or more than 2 GiB; dds_writecdr() takes the sample over
ddsi_serdata* new_raw_sample(const ddsi_sertype* type, std::span<const std::uint8_t> first,
                             std::span<const std::uint8_t> second = {});

/// The bytes of a sample of a raw type, with encapsulation header.
std::span<const std::uint8_t> raw_bytes(const ddsi_serdata* sample);

}  // namespace vinerow::ros2
