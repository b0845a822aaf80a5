#pragma once
// Writes pictures as an MP4 film, encoded by the ffmpeg program.

#include <memory>
#include <string>

#include <mobil/engine/error.h>
#include <mobil/systems/render/image.h>

namespace mobil::inline v0_3 {

/// Writes a film: H.264, yuv420p, BT.709, playable during download. Until close() succeeds the file has a temporary
/// name next to `path` (OutputFile). A writer that is destroyed before that leaves no file.
class VideoWriter {
 public:
  /// Starts a film. `path` must end in .mp4; width and height are even, 2–8192 pixels; 1–240 pictures a second. Errors:
  /// a value out of range, ffmpeg is missing (with the package to install), a process cannot be started.
  static Result<VideoWriter> create(const std::string& path, int width, int height, double pictures_per_second);

  /// Adds a picture and waits while ffmpeg is busy. Errors: another size, a failure of ffmpeg (with its message).
  Result<void> add(const Image& image);

  /// Finishes the film and renames it to `path`. Errors: a failure of ffmpeg, no pictures, already closed.
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
