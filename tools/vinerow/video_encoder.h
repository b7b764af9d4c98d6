#pragma once
/// Video encoder that pipes raw frames into a separate ffmpeg process.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vinerow::tools {

class VideoEncoder {
 public:
  /// @param out  its extension gives the format: .mp4, .mkv, .webm, .gif
  /// @throws ConfigError if ffmpeg is not installed
  VideoEncoder(std::filesystem::path out, double fps);
  /// Removes an unfinished video.
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// @param rgb  top row first; all frames must have the size of the first
  /// @throws WriteError if ffmpeg has ended
  void add(const std::vector<std::uint8_t>& rgb, int width, int height);
  /// Waits for ffmpeg and moves the video to its final name. @throws WriteError
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
