#include "demo/town/town_paths.h"

#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshBuilder.h>
#include <recastnavigation/DetourNavMeshQuery.h>
#include <recastnavigation/Recast.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo/town/town_map.h"

namespace mobil {
namespace {

// Recast's voxels, and who walks: m.
constexpr float cell_m = 0.1F, layer_m = 0.04F;
constexpr float person_height_m = 2, person_radius_m = 0.32F, highest_step_m = 0.2F, steepest_deg = 40;
constexpr float longest_edge_m = 8, simplified_m = 0.13F;
constexpr unsigned short walkable = 1;

template <class T, void (*release)(T*)>
struct Freed {
  void operator()(T* object) const { release(object); }
};
template <class T, void (*release)(T*)>
using Owned = std::unique_ptr<T, Freed<T, release>>;

/// All triangles of the town as Recast takes them.
struct Triangles {
  std::vector<float> corner;
  std::vector<int> index;

  Triangles() {
    for (const TownMesh& mesh : town_meshes()) {
      const int first = static_cast<int>(corner.size() / 3);
      for (const Vec3<float>& at : mesh.position) corner.insert(corner.end(), {at.x, at.y, at.z});
      for (const std::uint32_t i : mesh.triangle) index.push_back(first + static_cast<int>(i));
    }
  }
  int corners() const { return static_cast<int>(corner.size() / 3); }
  int triangles() const { return static_cast<int>(index.size() / 3); }
};

rcConfig config_of(const Triangles& town) {
  rcConfig config{};
  config.cs = cell_m;
  config.ch = layer_m;
  config.walkableSlopeAngle = steepest_deg;
  config.walkableHeight = static_cast<int>(std::ceil(person_height_m / layer_m));
  config.walkableClimb = static_cast<int>(std::floor(highest_step_m / layer_m));
  config.walkableRadius = static_cast<int>(std::ceil(person_radius_m / cell_m));
  config.maxEdgeLen = static_cast<int>(longest_edge_m / cell_m);
  config.maxSimplificationError = simplified_m / cell_m;
  config.minRegionArea = 64;
  config.mergeRegionArea = 400;
  config.maxVertsPerPoly = DT_VERTS_PER_POLYGON;
  config.detailSampleDist = 6 * cell_m;
  config.detailSampleMaxError = layer_m;
  rcCalcBounds(town.corner.data(), town.corners(), config.bmin, config.bmax);
  rcCalcGridSize(config.bmin, config.bmax, config.cs, &config.width, &config.height);
  return config;
}

using PolyMesh = Owned<rcPolyMesh, rcFreePolyMesh>;
using DetailMesh = Owned<rcPolyMeshDetail, rcFreePolyMeshDetail>;

/// Voxels, spans, regions, outlines, polygons: Recast's own order. False where one of them fails.
bool make_polygons(const Triangles& town, const rcConfig& config, PolyMesh& polygons, DetailMesh& detail) {
  rcContext context(false);
  const Owned<rcHeightfield, rcFreeHeightField> solid(rcAllocHeightfield());
  const Owned<rcCompactHeightfield, rcFreeCompactHeightfield> open(rcAllocCompactHeightfield());
  const Owned<rcContourSet, rcFreeContourSet> outlines(rcAllocContourSet());
  polygons.reset(rcAllocPolyMesh());
  detail.reset(rcAllocPolyMeshDetail());
  std::vector<unsigned char> area(static_cast<std::size_t>(town.triangles()));
  rcMarkWalkableTriangles(&context, config.walkableSlopeAngle, town.corner.data(), town.corners(), town.index.data(),
                          town.triangles(), area.data());
  if (!rcCreateHeightfield(&context, *solid, config.width, config.height, config.bmin, config.bmax, config.cs,
                           config.ch) ||
      !rcRasterizeTriangles(&context, town.corner.data(), town.corners(), town.index.data(), area.data(),
                            town.triangles(), *solid, config.walkableClimb))
    return false;
  rcFilterLowHangingWalkableObstacles(&context, config.walkableClimb, *solid);
  rcFilterLedgeSpans(&context, config.walkableHeight, config.walkableClimb, *solid);
  rcFilterWalkableLowHeightSpans(&context, config.walkableHeight, *solid);
  return rcBuildCompactHeightfield(&context, config.walkableHeight, config.walkableClimb, *solid, *open) &&
         rcErodeWalkableArea(&context, config.walkableRadius, *open) && rcBuildDistanceField(&context, *open) &&
         rcBuildRegions(&context, *open, 0, config.minRegionArea, config.mergeRegionArea) &&
         rcBuildContours(&context, *open, config.maxSimplificationError, config.maxEdgeLen, *outlines) &&
         rcBuildPolyMesh(&context, *outlines, config.maxVertsPerPoly, *polygons) &&
         rcBuildPolyMeshDetail(&context, *polygons, *open, config.detailSampleDist, config.detailSampleMaxError,
                               *detail);
}

}  // namespace

struct TownPaths::Mesh {
  Owned<dtNavMesh, dtFreeNavMesh> mesh{dtAllocNavMesh()};
  Owned<dtNavMeshQuery, dtFreeNavMeshQuery> query{dtAllocNavMeshQuery()};
  dtQueryFilter filter;

  static constexpr int most_polygons = 256, most_corners = 64;

  dtPolyRef nearest(GroundPoint place, float* on_mesh) const {
    const float at[3] = {place.x_m, town_ground(place.x_m, place.z_m).height_m, place.z_m};
    const float reach[3] = {1.5F, 0.6F, 1.5F};
    dtPolyRef polygon = 0;
    query->findNearestPoly(at, reach, &filter, &polygon, on_mesh);
    return polygon;
  }
};

TownPaths::TownPaths(std::unique_ptr<Mesh> mesh) : mesh_(std::move(mesh)) {}
TownPaths::TownPaths(TownPaths&&) noexcept = default;
TownPaths& TownPaths::operator=(TownPaths&&) noexcept = default;
TownPaths::~TownPaths() = default;

Result<TownPaths> TownPaths::make() {
  const Triangles town;
  const rcConfig config = config_of(town);
  PolyMesh polygons;
  DetailMesh detail;
  if (!make_polygons(town, config, polygons, detail)) return fail("Recast makes no mesh of this town");
  for (int i = 0; i < polygons->npolys; ++i) polygons->flags[i] = walkable;

  dtNavMeshCreateParams params{};
  params.verts = polygons->verts;
  params.vertCount = polygons->nverts;
  params.polys = polygons->polys;
  params.polyAreas = polygons->areas;
  params.polyFlags = polygons->flags;
  params.polyCount = polygons->npolys;
  params.nvp = polygons->nvp;
  params.detailMeshes = detail->meshes;
  params.detailVerts = detail->verts;
  params.detailVertsCount = detail->nverts;
  params.detailTris = detail->tris;
  params.detailTriCount = detail->ntris;
  params.walkableHeight = person_height_m;
  params.walkableRadius = person_radius_m;
  params.walkableClimb = highest_step_m;
  std::copy_n(polygons->bmin, 3, params.bmin);
  std::copy_n(polygons->bmax, 3, params.bmax);
  params.cs = config.cs;
  params.ch = config.ch;
  params.buildBvTree = true;
  unsigned char* data = nullptr;
  int bytes = 0;
  if (!dtCreateNavMeshData(&params, &data, &bytes)) return fail("Detour makes no mesh of this town");
  auto made = std::make_unique<Mesh>();
  if (dtStatusFailed(made->mesh->init(data, bytes, DT_TILE_FREE_DATA)) ||
      dtStatusFailed(made->query->init(made->mesh.get(), 2048)))
    return fail("Detour takes no mesh of this town");
  return TownPaths(std::move(made));
}

void TownPaths::find(GroundPoint from, GroundPoint to, std::vector<GroundPoint>& corners) const {
  corners.clear();
  float begin[3], end[3];
  const dtPolyRef first = mesh_->nearest(from, begin), last = mesh_->nearest(to, end);
  dtPolyRef polygon[Mesh::most_polygons];
  int polygons = 0, count = 0;
  if (first == 0 || last == 0) return;
  mesh_->query->findPath(first, last, begin, end, &mesh_->filter, polygon, &polygons, Mesh::most_polygons);
  float corner[3 * Mesh::most_corners];
  if (polygons == 0) return;
  mesh_->query->findStraightPath(begin, end, polygon, polygons, corner, nullptr, nullptr, &count, Mesh::most_corners);
  for (int i = 1; i < count; ++i) corners.push_back({corner[3 * i], corner[3 * i + 2]});
}

}  // namespace mobil
