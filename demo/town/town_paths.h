#pragma once
// Ways through the town by Recast and Detour: a mesh of where people can walk, made once of the town's triangles, and
// the shortest ways on it.

#include <memory>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/systems/avoidance/obstacles.h>

namespace mobil {

class TownPaths {
 public:
  /// Errors: Recast fails.
  static Result<TownPaths> make();
  TownPaths(TownPaths&&) noexcept;
  TownPaths& operator=(TownPaths&&) noexcept;
  ~TownPaths();

  /// Corners of the shortest way, its end last; empty where there is none.
  void find(GroundPoint from, GroundPoint to, std::vector<GroundPoint>& corners) const;

 private:
  struct Mesh;
  explicit TownPaths(std::unique_ptr<Mesh> mesh);
  std::unique_ptr<Mesh> mesh_;
};

}  // namespace mobil
