#pragma once
/// Frames into a video by ffmpeg, where that is installed: a process of its own that takes raw
/// pixels.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vinerow::tools {

class VideoEncoder {
 public:
  /// @param out  its ending says the format: .mp4, .mkv, .webm, .gif
  /// @throws ConfigError where there is no ffmpeg
  VideoEncoder(std::filesystem::path out, double fps);
  /// Removes what is not finished.
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// @param rgb  top row first; all frames have the first one's size
  /// @throws WriteError where ffmpeg ended
  void add(const std::vector<std::uint8_t>& rgb, int width, int height);
  /// Waits for ffmpeg and gives the video its name. @throws WriteError
  void finish();

 private:
  void start(int width, int height);
  bool wait_for_success();

  std::filesystem::path out_, temporary_;
  double fps_;
  pid_t process_ = -1;
  int pipe_ = -1;
};

}  // namespace vinerow::tools
