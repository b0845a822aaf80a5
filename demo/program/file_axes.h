#pragma once
// The option --axes of exported walks and crowds.

#include <string>
#include <utility>

#include "demo/program/options.h"

namespace mobil {

inline constexpr const char *usual_axes = "y_up", *z_back_axes = "y_up_z_back";

/// Returns the option --axes for these formats. Its value is usual_axes or z_back_axes.
inline Option axes_option(std::string& axes, const std::string& formats, std::string group = {}) {
  return {.name = "--axes",
          .target = &axes,
          .help = "Axes of " + formats + ": y_up walks toward +Z, y_up_z_back toward -Z (Godot)",
          .group = std::move(group),
          .choices = {usual_axes, z_back_axes}};
}

}  // namespace mobil
