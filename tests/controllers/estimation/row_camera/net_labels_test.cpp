/// Labels from nets in closed form: colour_net.onnx is a convolution of one pixel with the unit
/// matrix, so that the score of a class is a colour; coarse_net.onnx takes every second pixel.
/// PyTorch wrote both. Scores of other nets: tests/engine/nets/nets_judge.py.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "controllers/estimation/row_camera/net_labels.h"
#include "engine/core/error.h"
#include "tests/support/paths.h"

namespace vinerow::controllers::net_labels_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::string net_file(const std::string& name) {
  return std::string(VINEROW_SOURCE_DIR) + "/tests/controllers/estimation/row_camera/nets/" + name;
}

class NetLabelsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!nets::why_no_nets().empty()) GTEST_SKIP() << nets::why_no_nets();
    params_.model = net_file("colour_net.onnx");
    params_.classes = {"sky", "ground", "post"};
  }

  NetLabelsParams params_;
};

/// 6 x 4 pixels, each of one colour in turn: red, green, blue, red, ...
Picture three_colours() {
  Picture picture;
  picture.width = 6;
  picture.height = 4;
  for (int i = 0; i < 24; ++i) {
    for (int c = 0; c < 3; ++c) picture.data.push_back(c == i % 3 ? 200 : 100);
  }
  return picture;
}

std::vector<Label> labels_in(const Picture& picture) {
  std::vector<Label> labels;
  for (const std::uint8_t byte : picture.data) labels.push_back(static_cast<Label>(byte));
  return labels;
}

TEST_F(NetLabelsTest, TheHighestScoreIsThePixelsLabel) {
  NetLabels net(params_, "rover.estimator");
  const Picture& found = net.find(three_colours());
  EXPECT_EQ(found.width, 6u);
  EXPECT_EQ(found.height, 4u);
  EXPECT_EQ(found.format, Picture::Format::kMono8);
  const std::vector<Label> labels = labels_in(found);
  ASSERT_EQ(labels.size(), 24u);
  const Label expected[] = {Label::kSky, Label::kGround, Label::kPost};
  for (std::size_t i = 0; i < labels.size(); ++i) EXPECT_EQ(labels[i], expected[i % 3]) << i;
}

TEST_F(NetLabelsTest, MeanAndDeviationAreThoseOfEachChannel) {
  // Red 200 becomes (0.784 - 0.5) / 1 = 0.284, green 100 becomes 0.392 / 2 = 0.196, blue 100
  // becomes (0.392 + 0.1) / 1 = 0.492: the highest.
  params_.mean = {0.5, 0.0, -0.1};
  params_.std = {1.0, 2.0, 1.0};
  NetLabels net(params_, "rover.estimator");
  const std::vector<Label> labels = labels_in(net.find(three_colours()));
  EXPECT_EQ(labels[0], Label::kPost);  // red
  EXPECT_EQ(labels[1], Label::kPost);  // green: 200 / 255 / 2 = 0.392 is less than 0.492
  EXPECT_EQ(labels[2], Label::kPost);
  params_.std = {0.5, 0.5, 10.0};
  NetLabels other(params_, "rover.estimator");
  const std::vector<Label> others = labels_in(other.find(three_colours()));
  EXPECT_EQ(others[0], Label::kGround);  // red: 0.569 against green 0.784
  EXPECT_EQ(others[1], Label::kGround);
}

TEST_F(NetLabelsTest, ACoarserNetLabelsBlocks) {
  params_.model = net_file("coarse_net.onnx");
  NetLabels net(params_, "rover.estimator");
  const std::vector<Label> labels = labels_in(net.find(three_colours()));
  // Pixels 0, 2, 4 of rows 0 and 2 are red, blue, green.
  const Label row[] = {Label::kSky,  Label::kSky,    Label::kPost,
                       Label::kPost, Label::kGround, Label::kGround};
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(labels[i], row[i % 6]) << i;
}

TEST_F(NetLabelsTest, RefusesWhatDoesNotFit) {
  params_.classes = {"sky", "ground", "pots"};
  EXPECT_THAT([&] { NetLabels(params_, "rover.estimator"); },
              ThrowsMessage<ConfigError>(HasSubstr(
                  "rover.estimator: model_classes has 'pots', which is none of the labels sky, "
                  "ground, leaf, wood, bunch, fruit, post, wire, obstacle, vehicle, person, weed; "
                  "did you mean 'post'?")));
  params_.classes = {"sky", "ground"};
  NetLabels net(params_, "rover.estimator");
  EXPECT_THAT([&] { net.find(three_colours()); },
              ThrowsMessage<ConfigError>(
                  HasSubstr("gives scores of 3 classes, but model_classes lists 2")));
  // All scores are sums with red.
  params_.classes = {"sky", "ground", "post"};
  params_.mean[0] = std::numeric_limits<double>::quiet_NaN();
  NetLabels damaged(params_, "rover.estimator");
  EXPECT_THAT([&] { damaged.find(three_colours()); },
              ThrowsMessage<ConfigError>(HasSubstr("gives scores that are not numbers")));
  params_.model = net_file("missing.onnx");
  EXPECT_THAT([&] { NetLabels(params_, "rover.estimator"); },
              ThrowsMessage<ConfigError>(
                  testing::AllOf(HasSubstr("rover.estimator: model '"),
                                 HasSubstr("missing.onnx' does not exist or is no file"))));
}

}  // namespace
}  // namespace vinerow::controllers::net_labels_test
