#pragma once
// Pictures in a row as an MP4 film, encoded by the ffmpeg program.

#include <memory>
#include <string>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>

namespace mobil::inline v0_3 {

/// A film being written: H.264, yuv420p, BT.709, playable while it downloads. Until close() succeeds it lies under a
/// temporary name beside `path`, as an OutputFile; a writer destroyed before that leaves nothing.
class VideoWriter {
 public:
  /// `path` ends in .mp4; width and height even, 2–8192 pixels; 1–240 pictures a second. Errors: those ranges, ffmpeg
  /// missing (with the package to install), no room for a process.
  static Result<VideoWriter> create(const std::string& path, int width, int height, double pictures_per_second);

  /// Waits while ffmpeg is busy. Errors: a picture of another size, ffmpeg gave up (with what it says).
  Result<void> add(const Image& image);

  /// Finishes the film and gives it its name. Errors: ffmpeg gave up, no picture was added, already closed.
  Result<void> close();

  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();

 private:
  struct Encoder;
  explicit VideoWriter(std::unique_ptr<Encoder> encoder);
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace mobil::inline v0_3
