#pragma once
/// Labels of a colour picture, found by a segmentation net that the user brings.
///
/// The net takes (colour / 255 - mean) / std of each channel, as nets of torchvision do, and gives
/// each pixel, or each of a coarser grid, scores of its classes. The class with the highest score
/// becomes the pixel's label.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/messages/camera.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/surface.h"
#include "engine/nets/segmentation_net.h"

namespace vinerow::controllers {

struct NetLabelsParams {
  std::string model;  ///< ONNX file; empty: none
  std::vector<std::string> classes = {"sky", "ground", "leaf", "wood", "post"};
  std::array<double, 3> mean = {0.0, 0.0, 0.0};
  std::array<double, 3> std = {1.0, 1.0, 1.0};
};

/// `model`, `model_classes`, `model_mean`, `model_std`.
const ParameterTable<NetLabelsParams>& net_labels_table();

class NetLabels {
 public:
  /// Reads the model. @param part  for errors
  /// @throws ConfigError for a bad model or an unknown class
  NetLabels(const NetLabelsParams& params, const std::string& part);

  /// @param colours  RGB8
  /// @returns labels, MONO8; valid until the next call
  /// @throws ConfigError if the model does not take this size, or gives another number of classes
  /// or scores that are NaN
  const Picture& find(const Picture& colours);

 private:
  void label_pixels(const nets::Scores& scores);

  std::string model_;
  std::vector<Label> classes_;
  std::unique_ptr<nets::SegmentationNet> net_;
  std::array<std::array<float, 256>, 3> value_of_byte_;
  std::vector<float> planes_;
  Picture labels_;
};

}  // namespace vinerow::controllers
