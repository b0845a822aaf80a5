#include <mobil/skin_writer.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include <mobil/components/fat.h>
#include <mobil/components/pose.h>
#include <mobil/engine/interrupt.h>
#include <mobil/systems/people/sleepers.h>
#include <mobil/systems/surfaces/place_skin.h>
#include "systems/gait/fat_motion.h"
#include "systems/poses/walk_ahead.h"

namespace mobil::inline v0_3 {
namespace {

Result<void> check_skin(const World& world, const SkinRequest& request) {
  if (request.shape.skin == nullptr) return fail("no skin; BodySkins::of gives one");
  const std::size_t vertices = request.shape.skin->rest.size(), bytes = sizeof(Vec3<float>);
  if (auto done = check_stream("positions", request.positions, vertices, bytes); !done) return done;
  if (!request.normals.bytes.empty()) {
    if (auto done = check_stream("normals", request.normals, vertices, bytes); !done) return done;
    if (lie_over(request.positions, bytes, request.normals, bytes, vertices))
      return fail("normals lie over positions; put them into slots of their own, or into other memory");
  }
  if (!world.alive(request.person)) return fail("the person is not there (a stale handle)", Status::stale_entity);
  if (auto done = check_ahead(request.ahead_s); !done) return done;
  if (request.pose == nullptr && is_asleep(world, request.person))
    return fail("the person is asleep; give the pose that get<Pose> returns", Status::missing);
  return {};
}

const SkinMesh& mesh_of(const BodySkin& skin) {
  return skin_mesh(skin.sex, skin.detail);
}

}  // namespace

Result<SkinShape> BodySkins::of(const BodyRequest& body, SkinDetail detail) {
  if (auto ok = check_body(body); !ok) return tl::unexpected(ok.error());
  const int coarse = detail < SkinDetail::far ? 1 : 2;
  const auto [age_y, steps, usual] = skin_build(body, index_step * static_cast<float>(coarse));
  const int step = coarse * steps;
  auto& skin = skin_[{body.sex, detail, age_y, step}];
  if (!skin) {
    const auto made = make_body(usual);
    if (!made) return tl::unexpected(made.error());
    auto& fit = fit_[{body.sex, age_y, step}];
    if (!fit) fit = fit_trunk(*made);
    skin = std::make_unique<BodySkin>(make_body_skin(*made, *fit, detail, dress_));
  }
  return SkinShape{skin.get(), body.height_m / usual.height_m};
}

struct SkinWriter::Work {
  ScratchPool& scratch;
  const World& world;
  std::span<const SkinRequest> requests;
  const VertexAxes& axes;
};

SkinWriter::SkinWriter(std::pmr::memory_resource* memory) : scratch_(memory) {}

void SkinWriter::write_people(void* context, std::size_t begin, std::size_t end) {
  const auto& work = *static_cast<const Work*>(context);
  const ScratchLease scratch(&work.scratch);
  for (std::size_t i = begin; i < end; ++i) {
    check_interrupt();
    const SkinRequest& request = work.requests[i];
    const BodySkin& skin = *request.shape.skin;
    const std::span maps(reinterpret_cast<FrameMap*>(scratch.data()), mesh_of(skin).frame.size());
    const VertexTarget out{request.positions.bytes.data(),
                           request.normals.bytes.empty() ? nullptr : request.normals.bytes.data(),
                           request.positions.stride, request.normals.stride};
    Pose<float> own;
    if (request.pose != nullptr) {
      own = *request.pose;
    } else if (request.ahead_s == 0 && work.world.has<Pose>(request.person)) {
      own = *work.world.get<Pose>(request.person);
    } else {
      own = pose_ahead(work.world, request.person, static_cast<float>(request.ahead_s));
    }
    const auto fat = work.world.get<FatWobble>(request.person);
    const bool wobbles = fat && work.world.has<Pose>(request.person);
    FatBeside beside;
    if (wobbles) beside = shown_fat(*work.world.get<BodySize>(request.person), *fat);
    pose_skin(skin, own, request.shape.lengths, request.origin_m, request.muscles, request.table,
              wobbles ? &beside : nullptr, maps, out);
    convert_axes(request.positions, 0, skin.rest.size(), VertexField::position, work.axes);
    convert_axes(request.normals, 0, skin.rest.size(), VertexField::normal, work.axes);
    if (request.bounds != nullptr) *request.bounds = bounds_of(request.positions, skin.rest.size());
  }
}

Result<void> SkinWriter::write(const World& world, std::span<const SkinRequest> requests, const Jobs& jobs,
                               const VertexAxes& axes) {
  const FloatMode mode;
  if (auto done = check_axes(axes); !done) return done;
  std::size_t frames = 0;
  for (std::size_t r = 0; r < requests.size(); ++r) {
    if (auto done = check_skin(world, requests[r]); !done)
      return fail(fmt::format("skin of request {}: {}", r, done.error().message), done.error().status);
    frames = std::max(frames, mesh_of(*requests[r].shape.skin).frame.size());
  }
  scratch_.prepare(frames * sizeof(FrameMap) / sizeof(float), jobs.threads);
  Work work{scratch_, world, requests, axes};
  run_in_parallel(jobs, requests.size(), write_people, &work);
  return {};
}

}  // namespace mobil::inline v0_3
