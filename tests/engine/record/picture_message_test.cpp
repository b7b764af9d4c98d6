/// Format texts of sensor_msgs/CompressedImage, by which compressed_image_transport and cv_bridge
/// choose the encoding: the part before the semicolon (sensor_msgs/image_encodings.hpp).

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record::picture_message_test {
namespace {

using Format = Picture::Format;

TEST(PictureMessage, EncodingsAreThoseOfRos) {
  const FrameNames frames = FrameNames::of_signal("rover/front");
  for (const auto& [format, encoding] : {std::pair(Format::kRgb8, "rgb8"),
                                         {Format::kMono8, "mono8"},
                                         {Format::kMono16, "mono16"},
                                         {Format::kDepth16, "16UC1"}}) {
    Picture picture;
    picture.format = format;
    picture.width = 3;
    picture.height = 2;
    picture.data.assign(6 * Picture::bytes_per_pixel(format), 7);
    ByteBuffer buffer;
    CdrWriter out(buffer);
    RosMapping<Picture>::write(out, {frames, Time{1'000'000'000}, nullptr}, picture);
    const std::vector<std::uint8_t> bytes(buffer.data(), buffer.data() + buffer.size());
    CdrReader in(bytes);
    skip_header(in);
    const std::string text(in.read_text());
    EXPECT_EQ(text.substr(0, text.find(';')), encoding);
    EXPECT_NE(text.find("; png compressed"), std::string::npos) << text;
    Picture back;
    CdrReader again(bytes);
    ASSERT_TRUE(RosMapping<Picture>::read(again, frames, back));
    EXPECT_EQ(back.format, format);
    EXPECT_EQ(back.data, picture.data);
  }
}

}  // namespace
}  // namespace vinerow::record::picture_message_test
