#pragma once
// The option --axes of exported walks and crowds.

#include <string>
#include <utility>

#include "demo/program/options.h"

namespace mobil {

inline constexpr const char *usual_axes = "y_up", *z_back_axes = "y_up_z_back";

/// Returns the option --axes, which has one of the words above.
inline Option axes_option(std::string& axes, std::string group = {}) {
  return {.name = "--axes",
          .target = &axes,
          .help = "Axes of .glb, .usda, .bvh, .x3d, .wrl and .gl: y_up walks toward +Z, y_up_z_back toward -Z (Godot)",
          .group = std::move(group),
          .choices = {usual_axes, z_back_axes}};
}

}  // namespace mobil
