#pragma once
// The object behind a mobil_surfaces*.

#include <mobil/systems/surfaces/body_surfaces.h>
#include "systems/c/c_call.h"

struct mobil_surfaces {
  mobil::BodySurfaces bound;
  mobil::MuscleSet muscles;  // driving muscles, and the cells of their meshes
  mobil::Cells cells;
  bool mirrored = false;  // the host's axes are mirrored, so triangles change their winding

  /// Returns the muscles that people with these surfaces must have.
  mobil::LegMuscles choice() const {
    mobil::LegMuscles of;
    of.muscles = muscles;
    of.cells = cells;
    return of;
  }
};
