#pragma once
/// A neural network that gives each pixel of a picture scores of classes, read from an ONNX file.
///
/// The scores have the same bits on every x86-64 processor and with any number of threads.

#include <cstddef>
#include <filesystem>
#include <span>

struct VinerowNet;

namespace vinerow::nets {

/// class by class, row by row; the net may have fewer rows and columns than the picture.
struct Scores {
  std::span<const float> values;  ///< classes x height x width
  int classes = 0;
  int height = 0;
  int width = 0;
};

class SegmentationNet {
 public:
  /// @throws ConfigError if the file is missing or no net that OpenCV reads, or without OpenCV
  explicit SegmentationNet(const std::filesystem::path& file);
  ~SegmentationNet();
  SegmentationNet(const SegmentationNet&) = delete;
  SegmentationNet& operator=(const SegmentationNet&) = delete;

  /// @param planes  3 x height x width numbers: red, green, blue, row by row
  /// @returns valid until the next call
  /// @throws ConfigError if the net does not take pictures of this size
  Scores run(std::span<const float> planes, int height, int width);

 private:
  std::filesystem::path file_;
  VinerowNet* net_;
};

/// Empty if nets can be used, else the reason in words.
const std::string& why_no_nets();

}  // namespace vinerow::nets
