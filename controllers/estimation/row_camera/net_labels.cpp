#include "controllers/estimation/row_camera/net_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::controllers {
namespace {

Label label_of_class(const std::string& name, const std::string& part) {
  std::vector<std::string> known;
  for (int i = 0; i < kLabelCount; ++i) {
    const auto label = static_cast<Label>(i);
    if (name == to_string(label)) return label;
    known.emplace_back(to_string(label));
  }
  throw ConfigError(fmt::format("{}: model_classes has '{}', which is none of the labels {}{}",
                                part, name, join(known), did_you_mean(name, known)));
}

std::vector<Label> labels_of_classes(const std::vector<std::string>& names,
                                     const std::string& part) {
  std::vector<Label> labels;
  for (const std::string& name : names) labels.push_back(label_of_class(name, part));
  return labels;
}

/// Errors name the part, so that the message points to the scenario's line.
std::unique_ptr<nets::SegmentationNet> open_net(const std::string& model, const std::string& part) {
  try {
    return std::make_unique<nets::SegmentationNet>(model);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: {}", part, error.what()));
  }
}

}  // namespace

const ParameterTable<NetLabelsParams>& net_labels_table() {
  using P = NetLabelsParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .path("model", &P::model,
                "ONNX file of a segmentation net that finds the labels in the colour picture "
                "(marks: labels); default: the camera's own labels")
          .texts("model_classes", &P::classes,
                 "labels of the model's classes, in the order of its scores")
          .numbers("model_mean", "", &P::mean, kAnyNumber,
                   "of red, green and blue, 0 to 1: subtracted from the picture")
          .numbers("model_std", "", &P::std, kPositive, "by which the rest is divided");
  return table;
}

NetLabels::NetLabels(const NetLabelsParams& params, const std::string& part)
    : model_(params.model),
      classes_(labels_of_classes(params.classes, part)),
      net_(open_net(params.model, part)) {
  // A byte has 256 values: the division is done once for each.
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const double share = static_cast<double>(byte) / 255.0;
      value_of_byte_[c][byte] = static_cast<float>((share - params.mean[c]) / params.std[c]);
    }
  }
  labels_.format = Picture::Format::kMono8;
}

const Picture& NetLabels::find(const Picture& colours) {
  const std::size_t count = std::size_t{colours.width} * colours.height;
  planes_.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      planes_[c * count + i] = value_of_byte_[c][colours.data[3 * i + c]];
    }
  }
  const int width = static_cast<int>(colours.width), height = static_cast<int>(colours.height);
  const nets::Scores scores = net_->run(planes_, height, width);
  if (scores.classes != static_cast<int>(classes_.size())) {
    throw ConfigError(
        fmt::format("model '{}' gives scores of {} classes, but model_classes lists {}", model_,
                    scores.classes, classes_.size()));
  }
  // Of these no class would be the best, and the first one would label the whole picture.
  const auto is_nan = [](float score) { return std::isnan(score); };
  if (std::any_of(scores.values.begin(), scores.values.end(), is_nan)) {
    throw ConfigError(fmt::format(
        "model '{}' gives scores that are not numbers: its weights may be damaged", model_));
  }
  labels_.width = colours.width;
  labels_.height = colours.height;
  labels_.data.resize(count);
  label_pixels(scores);
  return labels_;
}

void NetLabels::label_pixels(const nets::Scores& scores) {
  const int width = static_cast<int>(labels_.width), height = static_cast<int>(labels_.height);
  // Scores lie class by class: those of a pixel are a whole grid apart.
  const std::size_t grid =
      static_cast<std::size_t>(scores.height) * static_cast<std::size_t>(scores.width);
  std::size_t pixel = 0;
  for (int y = 0; y < height; ++y) {
    const int row = y * scores.height / height;
    for (int x = 0; x < width; ++x) {
      const float* at = &scores.values[static_cast<std::size_t>(row) * scores.width +
                                       static_cast<std::size_t>(x * scores.width / width)];
      std::size_t best = 0;
      for (std::size_t k = 1; k < classes_.size(); ++k) {
        if (at[k * grid] > at[best * grid]) best = k;
      }
      labels_.data[pixel++] = static_cast<std::uint8_t>(classes_[best]);
    }
  }
}

}  // namespace vinerow::controllers
