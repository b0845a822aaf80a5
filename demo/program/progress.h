#pragma once
// Progress on stderr: on a terminal, a line that the next one replaces; in a log or a pipe, plain lines ten seconds
// apart, so that short runs write none.

#include <cstddef>
#include <optional>
#include <string_view>

namespace mobil {

/// Set by --quiet. The functions below then write nothing.
inline bool quiet = false;

/// Pace of plain lines. A line is due ten seconds after the first request, and ten seconds after each written line.
class LinePace {
 public:
  bool due(double now_s);

 private:
  std::optional<double> next_s_;
};

/// Replaces the line that was shown. An empty line clears it, which must precede other output. Any thread can call it.
void show(std::string_view line);

/// Shows a line such as "what 40 %", with `part` from 0 to 1.
void show_part(std::string_view what, double part);

/// Shows a line such as "what [=====     ] 3/6", or "what 3/6" as a plain line. `of` must be above 0.
void show_progress(std::string_view what, std::size_t done, std::size_t of);

/// A bar for many small items, shown after the first second, at most ten times a second, and cleared at the end.
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
  double next_s_;  // time of the next update, on the steady clock
  bool shown_ = false;
};

}  // namespace mobil
