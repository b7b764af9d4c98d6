#pragma once
/// Functions of libvinerow_net_host.so, in C, so that it does not matter how OpenCV was compiled.
///
/// A function that fails returns nullptr and writes one sentence into `reason`.

extern "C" {

struct VinerowNet;

/// Scores of the classes: classes x height x width numbers, class by class, row by row.
struct VinerowNetScores {
  const float* values;  ///< valid until the next call with this net
  int classes;
  int height;
  int width;
};

struct VinerowNetReason {
  char text[400];
};

/// Reads an ONNX file.
VinerowNet* vinerow_net_open(const char* file, VinerowNetReason* reason);

/// @param planes  3 x height x width numbers: red, green, blue
/// @returns `scores`
const VinerowNetScores* vinerow_net_run(VinerowNet* net, const float* planes, int height, int width,
                                        VinerowNetScores* scores, VinerowNetReason* reason);

void vinerow_net_close(VinerowNet* net);

}  // extern "C"
