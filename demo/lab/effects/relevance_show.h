#pragma once
// A crowd whose muscles are simulated as the scene needs them: what that saves, whether a budget holds as a camera
// flies through, and whether anything jumps when methods change all the time.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "engine/error.h"

namespace mobil {

struct ShownFigure {
  std::string name;
  double value = 0;
  std::string unit;
  std::string bound;  // what it is held against; empty where nothing
  bool held = true;
};

struct CrowdShow {
  std::size_t humans = 10000;
  double flight_s = 20, switching_s = 60;
  std::size_t switching_muscles = 10000;
  std::function<void(const std::string&)> progress{};
};

/// Errors: what the simulation refuses.
Result<std::vector<ShownFigure>> show_crowd(const CrowdShow& show);

std::string figures_table(const std::vector<ShownFigure>& figures);

}  // namespace mobil
