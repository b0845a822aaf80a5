#pragma once
// The panel of `mobil view`: sliders for body, walk, style, muscles and crowd; plots; what it costs.

#include <string>

#include "demo/view/view_scene.h"

namespace mobil {

/// What concerns the window alone.
struct ViewTime {
  bool paused = false;
  int pace = 0;  // time as it runs, a quarter, a sixteenth
  double tick_ms = 0, picture_ms = 0;
};

/// Draws it, between ViewWindow::begin_frame and end_frame. What the user changed is in the choice it returns;
/// `refusal` is shown in red.
ViewChoice view_panel(const ViewScene& scene, const std::string& refusal, ViewTime& time);

}  // namespace mobil
