#pragma once
// How far something is, on stderr. On a terminal a line that the next one replaces; elsewhere, in a log or a pipe,
// plain lines ten seconds apart, so that short runs write none.

#include <cstddef>
#include <optional>
#include <string_view>

namespace mobil {

/// Set by --quiet: no function below writes anything then.
inline bool quiet = false;

/// When a plain line is due: ten seconds after the first that was asked for, and after each that was written.
class LinePace {
 public:
  bool due(double now_s);

 private:
  std::optional<double> next_s_;
};

/// Replaces the line that was shown; "" clears it, which is due before anything else is printed. From any thread.
void show(std::string_view line);

/// The same as "what 40 %", `part` of 0 to 1.
void show_part(std::string_view what, double part);

/// The same as "what [=====     ] 3/6", plainly "what 3/6"; `of` is above 0.
void show_progress(std::string_view what, std::size_t done, std::size_t of);

/// A bar over many small items: from the first second on, at most ten times a second; cleared at the end.
class ProgressBar {
 public:
  ProgressBar(std::string_view what, std::size_t of);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void at(std::size_t done);

 private:
  std::string_view what_;
  std::size_t of_;
  double next_s_;  // when it may be shown again, on the steady clock
  bool shown_ = false;
};

}  // namespace mobil
