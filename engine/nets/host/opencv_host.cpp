/// The functions of net_host.h by OpenCV's module dnn.

#include <algorithm>
#include <cctype>
#include <cstring>
#include <exception>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <string>

#include "engine/nets/host/net_host.h"

struct VinerowNet {
  cv::dnn::Net net;
  cv::Mat scores;
};

namespace {

/// As one line. OpenCV's texts have several, some with places in its source.
void write_reason(const std::string& words, VinerowNetReason& reason) {
  std::string line;
  for (const char c : words) {
    const bool is_space = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!is_space) line += c;
    if (is_space && !line.empty() && line.back() != ' ') line += ' ';
  }
  const std::size_t length = std::min(line.size(), sizeof reason.text - 1);
  std::memcpy(reason.text, line.data(), length);
  reason.text[length] = '\0';
}

/// Calls a function; nullptr and the reason if it throws.
template <class Function>
auto attempt(VinerowNetReason& reason, Function&& function) -> decltype(function()) {
  try {
    return function();
  } catch (const cv::Exception& error) {
    write_reason(error.err, reason);
  } catch (const std::exception& error) {
    write_reason(error.what(), reason);
  }
  return nullptr;
}

int be_silent(int, const char*, const char*, const char*, int, void*) {
  return 0;
}

/// For all of OpenCV in this process. Its functions for newer instructions add in another order, so
/// the bits would be those of one kind of processor. One thread: runs share the machine already.
void prepare_opencv() {
  cv::setUseOptimized(false);
  cv::setNumThreads(1);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::redirectError(be_silent);
}

}  // namespace

#define VINEROW_EXPORTED extern "C" __attribute__((visibility("default")))

VINEROW_EXPORTED VinerowNet* vinerow_net_open(const char* file, VinerowNetReason* reason) {
  return attempt(*reason, [&] {
    prepare_opencv();
    auto net = std::make_unique<VinerowNet>();
    net->net = cv::dnn::readNetFromONNX(file);
    net->net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net->net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return net.release();
  });
}

VINEROW_EXPORTED const VinerowNetScores* vinerow_net_run(VinerowNet* net, const float* planes,
                                                         int height, int width,
                                                         VinerowNetScores* scores,
                                                         VinerowNetReason* reason) {
  return attempt(*reason, [&]() -> const VinerowNetScores* {
    const int size[] = {1, 3, height, width};
    // OpenCV copies the input.
    net->net.setInput(cv::Mat(4, size, CV_32F, const_cast<float*>(planes)));
    net->scores = net->net.forward();
    const cv::Mat& found = net->scores;
    const bool is_plain = found.type() == CV_32F && found.isContinuous() && found.total() > 0;
    if (!is_plain || found.dims != 4 || found.size[0] != 1) {
      std::string shape;
      for (int i = 0; i < found.dims; ++i) {
        shape += (i > 0 ? " x " : "") + std::to_string(found.size[i]);
      }
      write_reason("its result is " + shape + " numbers, not 1 x classes x height x width",
                   *reason);
      return nullptr;
    }
    *scores = {found.ptr<float>(), found.size[1], found.size[2], found.size[3]};
    return scores;
  });
}

VINEROW_EXPORTED void vinerow_net_close(VinerowNet* net) {
  delete net;
}
