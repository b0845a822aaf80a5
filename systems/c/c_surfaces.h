#pragma once
// What a mobil_surfaces* points to.

#include <mobil/systems/surfaces/body_surfaces.h>
#include "systems/c/c_call.h"

struct mobil_surfaces {
  mobil::BodySurfaces bound;
  mobil::MuscleSet muscles;  // that drive them, and the cells of their meshes
  mobil::Cells cells;
  bool mirrored = false;  // the host's axes: triangles turn round

  /// What people have who are to show them.
  mobil::LegMuscles choice() const {
    mobil::LegMuscles of;
    of.muscles = muscles;
    of.cells = cells;
    return of;
  }
};
