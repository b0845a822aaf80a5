#pragma once
// How far something is: a line on stderr that the next one replaces, on a terminal alone.

#include <cstddef>
#include <string_view>

namespace mobil {

/// Whether stderr is a terminal. Elsewhere nothing below writes anything.
bool on_terminal();

/// Replaces the line that was shown; "" clears it, which is due before anything else is printed.
void show(std::string_view line);

/// The same as "what 40 %", `part` of 0 to 1.
void show_part(std::string_view what, double part);

/// The same as "what [=====     ] 3/6"; `of` is above 0.
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
  bool terminal_, shown_ = false;
};

}  // namespace mobil
