/// Writes the scores that a net gives a picture: net_scores MODEL HEIGHT WIDTH < planes > scores.
/// Both are 32-bit numbers. Standard error: "classes height width", or the reason of a failure
/// (exit status 1). Exit status 77: no nets in this build.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "engine/nets/segmentation_net.h"

int main(int argc, char** argv) {
  using namespace vinerow::nets;
  if (argc != 4) return 2;
  if (!why_no_nets().empty()) {
    std::fprintf(stderr, "%s\n", why_no_nets().c_str());
    return 77;
  }
  try {
    const int height = std::atoi(argv[2]), width = std::atoi(argv[3]);
    std::vector<float> planes(3 * static_cast<std::size_t>(height) *
                              static_cast<std::size_t>(width));
    if (std::fread(planes.data(), sizeof(float), planes.size(), stdin) != planes.size()) return 2;
    SegmentationNet net(argv[1]);
    net.run(planes, height, width);
    const Scores scores = net.run(planes, height, width);  // a net can be used again
    std::fwrite(scores.values.data(), sizeof(float), scores.values.size(), stdout);
    std::fprintf(stderr, "%d %d %d\n", scores.classes, scores.height, scores.width);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
