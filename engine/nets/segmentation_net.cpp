#include "engine/nets/segmentation_net.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include "engine/core/error.h"
#include "engine/core/own_libraries.h"
#include "engine/nets/host/net_host.h"

namespace vinerow::nets {
namespace {

constexpr const char* kHostName = "libvinerow_net_host.so";

struct Host {
  decltype(&vinerow_net_open) open = nullptr;
  decltype(&vinerow_net_run) run = nullptr;
  decltype(&vinerow_net_close) close = nullptr;
  std::string fault;
};

/// The library stays open until the program ends.
Host open_host() {
  Host host;
  const std::filesystem::path file = find_own_library(kHostName);
  if (!std::filesystem::exists(file)) {
    host.fault =
        fmt::format("{} is missing; install vinerow-nets, or build with OpenCV", file.string());
    return host;
  }
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | own_libraries_first());
  if (library == nullptr) {
    host.fault = fmt::format("OpenCV cannot be loaded: {}", dlerror());
    return host;
  }
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(library, name));
    if (function == nullptr) host.fault = fmt::format("{} is not of this vinerow", file.string());
  };
  find(host.open, "vinerow_net_open");
  find(host.run, "vinerow_net_run");
  find(host.close, "vinerow_net_close");
  return host;
}

const Host& host() {
  static const Host host = open_host();
  return host;
}

}  // namespace

const std::string& why_no_nets() {
  return host().fault;
}

SegmentationNet::SegmentationNet(const std::filesystem::path& file) : file_(file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw ConfigError(fmt::format("model '{}' does not exist or is no file", file.string()));
  }
  if (!why_no_nets().empty()) {
    throw ConfigError(fmt::format("model '{}' needs OpenCV, but {}", file.string(), why_no_nets()));
  }
  VinerowNetReason reason{};
  net_ = host().open(file.c_str(), &reason);
  if (net_ == nullptr) {
    throw ConfigError(fmt::format("model '{}' is not an ONNX file that OpenCV can read: {}",
                                  file.string(), reason.text));
  }
}

SegmentationNet::~SegmentationNet() {
  host().close(net_);
}

Scores SegmentationNet::run(std::span<const float> planes, int height, int width) {
  VinerowNetScores scores{};
  VinerowNetReason reason{};
  if (host().run(net_, planes.data(), height, width, &scores, &reason) == nullptr) {
    throw ConfigError(fmt::format("model '{}' does not take pictures of {} x {} pixels: {}",
                                  file_.string(), width, height, reason.text));
  }
  const std::size_t count = static_cast<std::size_t>(scores.classes) *
                            static_cast<std::size_t>(scores.height) *
                            static_cast<std::size_t>(scores.width);
  return {{scores.values, count}, scores.classes, scores.height, scores.width};
}

}  // namespace vinerow::nets
