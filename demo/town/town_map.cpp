#include "demo/town/town_map.h"

#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshBuilder.h>
#include <recastnavigation/DetourNavMeshQuery.h>
#include <recastnavigation/Recast.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace mobil {
namespace {

// Sizes of Recast's voxels and of a walker, m, and the steepest slope, degrees.
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

/// All triangles of the town in the format of Recast.
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

/// Runs the stages of Recast: voxels, spans, regions, outlines, polygons. Returns false if one of them fails.
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

using enum TownBlock::Use;

constexpr Colour asphalt{0.42F, 0.43F, 0.45F}, stone{0.80F, 0.78F, 0.74F}, step{0.86F, 0.84F, 0.80F};
constexpr Colour plaster{0.83F, 0.74F, 0.62F}, brick{0.70F, 0.52F, 0.44F}, parapet{0.74F, 0.72F, 0.68F};

constexpr float low_x = -14, high_x = 14, low_z = -10, high_z = 20;  // bounds of the town
constexpr float kerb = 0.12F, riser = 0.15F, tread = 0.32F, stairs_z = 10.4F;
constexpr float stairs_low_x = -8, stairs_high_x = -3, terrace_z = 12, terrace_high_x = 2;
constexpr float terrace = kerb + 6 * riser;
constexpr float ramp_low_z = 14, ramp_high_z = 17, ramp_high_x = 11;
constexpr float thin = 0.12F, rail = terrace + 0.85F;  // half of a parapet's thickness; its top

constexpr TownBlock stair(int number) {
  const float z = stairs_z + tread * static_cast<float>(number), y = kerb + riser * static_cast<float>(number + 1);
  return {stairs_low_x, stairs_high_x, z, terrace_z, y, y, walk, step};
}
constexpr TownBlock along_x(float from, float to, float z, float at_from, float at_to) {
  return {from, to, z - thin, z + thin, at_from, at_to, wall, parapet};
}
constexpr TownBlock along_z(float x, float from, float to, float high) {
  return {x - thin, x + thin, from, to, high, high, wall, parapet};
}

constexpr std::array blocks = {
    TownBlock{low_x, high_x, low_z, -6, kerb, kerb, walk, stone},
    TownBlock{low_x, high_x, 0, high_z, kerb, kerb, walk, stone},
    stair(0),
    stair(1),
    stair(2),
    stair(3),
    stair(4),
    TownBlock{stairs_low_x, terrace_high_x, terrace_z, high_z - 1, terrace, terrace, walk, stone},
    TownBlock{terrace_high_x, ramp_high_x, ramp_low_z, ramp_high_z, terrace, kerb, walk, step},
    along_x(stairs_high_x, terrace_high_x, terrace_z, rail, rail),
    along_x(terrace_high_x, ramp_high_x, ramp_low_z, rail, rail - terrace + kerb),
    along_x(terrace_high_x, ramp_high_x, ramp_high_z, rail, rail - terrace + kerb),
    along_z(terrace_high_x, terrace_z, ramp_low_z, rail),
    along_z(terrace_high_x, ramp_high_z, high_z - 1, rail),
    along_z(stairs_high_x, stairs_z, terrace_z, 0.85F + kerb + riser),
    along_z(stairs_low_x, stairs_z, terrace_z, 0.85F + kerb + riser),
    along_z(stairs_low_x, terrace_z, high_z - 1, rail),
    TownBlock{low_x, high_x, high_z - 1, high_z, 4.2F, 4.2F, wall, plaster},
    TownBlock{low_x, -10.5F, 4, high_z - 1, 3.6F, 3.6F, wall, brick},
    TownBlock{4.5F, 11.5F, 3, 9.5F, 3.4F, 3.4F, wall, plaster},
};

constexpr GroundPoint places[] = {
    {8, -8.5F},
    {8, 1.2F},
    {2.2F, 2},
    {-5, 8.5F},
    {-5.5F, 13.5F},
    {0.5F, 15.5F},
    {12.5F, 15.5F},
    // not on the tour
    {-12, -8},
    {12.5F, -8},
    {-12.5F, -3},
    {12.5F, -3},
    {-12, 1.5F},
    {12.8F, 1.5F},
    {0, 8},
    {-9, 6},
    {12.8F, 8},
    {-6, 17.5F},
};

bool within(const TownBlock& block, float x_m, float z_m) {
  return x_m >= block.low_x_m && x_m < block.high_x_m && z_m >= block.low_z_m && z_m < block.high_z_m;
}
float rise_of(const TownBlock& block) {
  return (block.at_high_m - block.at_low_m) / (block.high_x_m - block.low_x_m);
}

void add_quad(TownMesh& mesh, const std::array<Vec3<float>, 4>& corner, const Vec3<float>& normal) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (const Vec3<float>& at : corner) mesh.position.push_back(at), mesh.normal.push_back(normal);
  for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.triangle.push_back(first + i);
}

TownMesh mesh_of(const TownBlock& b) {
  TownMesh mesh;
  mesh.colour = b.colour;
  const float rise = rise_of(b), per = 1 / std::sqrt(1 + rise * rise);
  const float x0 = b.low_x_m, x1 = b.high_x_m, z0 = b.low_z_m, z1 = b.high_z_m, y0 = b.at_low_m, y1 = b.at_high_m;
  add_quad(mesh, {{{x0, y0, z0}, {x0, y0, z1}, {x1, y1, z1}, {x1, y1, z0}}}, {-rise * per, per, 0});
  add_quad(mesh, {{{x0, 0, z0}, {x0, y0, z0}, {x1, y1, z0}, {x1, 0, z0}}}, {0, 0, -1});
  add_quad(mesh, {{{x1, 0, z1}, {x1, y1, z1}, {x0, y0, z1}, {x0, 0, z1}}}, {0, 0, 1});
  add_quad(mesh, {{{x0, 0, z1}, {x0, y0, z1}, {x0, y0, z0}, {x0, 0, z0}}}, {-1, 0, 0});
  add_quad(mesh, {{{x1, 0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, 0, z1}}}, {1, 0, 0});
  return mesh;
}

}  // namespace

struct TownPaths::Mesh {
  Owned<dtNavMesh, dtFreeNavMesh> mesh{dtAllocNavMesh()};
  Owned<dtNavMeshQuery, dtFreeNavMeshQuery> query{dtAllocNavMeshQuery()};
  dtQueryFilter filter;

  static constexpr int max_polygons = 256, max_corners = 64;

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
  if (!make_polygons(town, config, polygons, detail)) return fail("Recast cannot make a mesh of this town");
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
  if (!dtCreateNavMeshData(&params, &data, &bytes)) return fail("Detour cannot make a mesh of this town");
  auto made = std::make_unique<Mesh>();
  if (dtStatusFailed(made->mesh->init(data, bytes, DT_TILE_FREE_DATA)) ||
      dtStatusFailed(made->query->init(made->mesh.get(), 2048)))
    return fail("Detour cannot use the mesh of this town");
  return TownPaths(std::move(made));
}

void TownPaths::find(GroundPoint from, GroundPoint to, std::vector<GroundPoint>& corners) const {
  corners.clear();
  float begin[3], end[3];
  const dtPolyRef first = mesh_->nearest(from, begin), last = mesh_->nearest(to, end);
  dtPolyRef polygon[Mesh::max_polygons];
  int polygons = 0, count = 0;
  if (first == 0 || last == 0) return;
  mesh_->query->findPath(first, last, begin, end, &mesh_->filter, polygon, &polygons, Mesh::max_polygons);
  float corner[3 * Mesh::max_corners];
  if (polygons == 0) return;
  mesh_->query->findStraightPath(begin, end, polygon, polygons, corner, nullptr, nullptr, &count, Mesh::max_corners);
  for (int i = 1; i < count; ++i) corners.push_back({corner[3 * i], corner[3 * i + 2]});
}

std::span<const TownBlock> town_blocks() {
  return blocks;
}

TerrainHeight town_ground(float x_m, float z_m) {
  TerrainHeight ground;
  for (const TownBlock& block : blocks) {
    if (block.use != walk || !within(block, x_m, z_m)) continue;
    const float rise = rise_of(block), height_m = block.at_low_m + rise * (x_m - block.low_x_m);
    if (height_m > ground.height_m) ground = {height_m, rise, 0};
  }
  return ground;
}

std::vector<Wall> town_walls() {
  std::vector<Wall> walls;
  for (const TownBlock& b : blocks) {
    if (b.use != wall) continue;
    const std::array<GroundPoint, 4> corner = {
        {{b.low_x_m, b.low_z_m}, {b.high_x_m, b.low_z_m}, {b.high_x_m, b.high_z_m}, {b.low_x_m, b.high_z_m}}};
    for (std::size_t i = 0; i < 4; ++i) walls.push_back({corner[i], corner[(i + 1) % 4]});
  }
  return walls;
}

bool on_town_stairs(float x_m, float z_m) {
  constexpr float before_m = 0.8F;
  return x_m > stairs_low_x && x_m < stairs_high_x && z_m > stairs_z - before_m && z_m < terrace_z + before_m;
}

std::span<const GroundPoint> town_places() {
  return places;
}

std::vector<TownMesh> town_meshes() {
  std::vector<TownMesh> meshes;
  TownMesh& street = meshes.emplace_back();
  street.colour = asphalt;
  add_quad(street, {{{low_x, 0, -6}, {low_x, 0, 0}, {high_x, 0, 0}, {high_x, 0, -6}}}, {0, 1, 0});
  for (const TownBlock& block : blocks) meshes.push_back(mesh_of(block));
  return meshes;
}

std::vector<Vec3<float>> town_paving() {
  std::vector<Vec3<float>> lines;
  const auto line = [&](float x0, float z0, float x1, float z1, float y) {
    lines.push_back({x0, y, z0});
    lines.push_back({x1, y, z1});
  };
  constexpr float over = 0.002F;
  for (float x = low_x; x <= high_x; x += 1) {
    line(x, low_z, x, -6, kerb + over);
    line(x, 0, x, high_z, kerb + over);
  }
  for (float z = low_z; z <= high_z; z += 1)
    if (z <= -6 || z >= 0) line(low_x, z, high_x, z, kerb + over);
  for (float x = stairs_low_x; x <= terrace_high_x; x += 1) line(x, terrace_z, x, high_z - 1, terrace + over);
  for (float z = terrace_z; z < high_z - 1; z += 1) line(stairs_low_x, z, terrace_high_x, z, terrace + over);
  return lines;
}

}  // namespace mobil
