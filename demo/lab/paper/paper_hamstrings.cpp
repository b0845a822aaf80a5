// Figures 16 and 17: the hamstrings in a walking skeleton, and as mesh and surface; and real meshes beside built-in
// ones.

#include <array>

#include <mobil/engine/geometry.h>
#include "demo/lab/paper/paper.h"
#include "demo/pictures/contact_sheet.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr std::size_t sequence = 8;
constexpr double still_at = 0.9;  // the thigh swung forward, the hamstrings stretched

std::vector<double> evenly(std::size_t count) {
  std::vector<double> at;
  for (std::size_t i = 0; i < count; ++i) at.push_back(static_cast<double>(i) / static_cast<double>(count));
  return at;
}

/// The legs of a person seen from the side at every moment, in a row of pictures.
Result<std::vector<Image>> row_of(const ShownWalk& walk) {
  std::vector<Image> row;
  for (std::size_t frame = 0; frame < walk.recording.frames.size(); ++frame) {
    const Actor actor{&walk, frame};
    auto image = take_picture({camera_at({0, 0.55F, 0}, 1.22F, 20, 4), 145, 180}, {&actor, 1});
    if (!image) return tl::unexpected(image.error());
    row.push_back(std::move(*image));
  }
  return row;
}

/// Of the frames of a sequence, and of the still as the last.
Result<Image> figure16(const ShownWalk& walk) {
  constexpr float apart_m = 0.92F;
  const Actor actor{&walk, sequence};
  auto left = take_picture({camera_at({0, 0.66F, 0}, 1.42F, -42, 4), 200, 305}, {&actor, 1});
  if (!left) return left;
  const Camera camera = camera_at({0, 0.93F, 0}, 1.98F, 6, 3);
  std::vector<Actor> actors;
  for (std::size_t i = 0; i < sequence; ++i) {
    const float place = apart_m * (static_cast<float>(i) - (static_cast<float>(sequence) - 1) / 2);
    actors.push_back({.walk = &walk, .frame = i, .at = place * across(camera)});
  }
  auto right = take_picture({camera, 1165, 305}, actors);
  if (!right) return right;
  const std::vector<Image> row = {std::move(*left), std::move(*right)};
  return contact_sheet({&row, 1}, 4);
}

Result<Image> figure17(const ShownWalk& walk) {
  std::vector<Image> row;
  for (const auto& [surface, mesh] : {std::pair{false, true}, {true, false}, {true, true}}) {
    const Actor actor{&walk, 0, {}, Actor::Bones::right_leg, surface ? Actor::Muscles::right : Actor::Muscles::none,
                      mesh};
    auto image = take_picture({camera_at({-0.09F, 0.68F, 0.03F}, 0.66F, -50, 3), 300, 540, false}, {&actor, 1});
    if (!image) return image;
    row.push_back(std::move(*image));
  }
  return contact_sheet({&row, 1}, 4);
}

CycleRequest hamstrings_alone(std::vector<double> shown_at) {
  return {paper_body(), paper_gait(), only({Muscle::hamstrings}), std::move(shown_at), {}};
}

}  // namespace

Result<void> paper_figure16(PaperRun& run) {
  std::vector<double> shown_at = evenly(sequence);
  shown_at.push_back(still_at);
  const auto walk = walk_cycle(hamstrings_alone(std::move(shown_at)));
  if (!walk) return tl::unexpected(walk.error());
  return run.write_picture(
      "The legs from behind at 90 % of the cycle; from the side every eighth of it, beginning with the right heel "
      "strike.",
      [&] { return figure16(walk->shown); });
}

Result<void> paper_figure17(PaperRun& run) {
  CycleRequest request = hamstrings_alone({0.3});
  request.muscles->cells = paper_mesh;
  const auto walk = walk_cycle(request);
  if (!walk) return tl::unexpected(walk.error());
  return run.write_picture(
      "The right thigh from behind in mid-stance: the mesh of 525 nodes, the surface that follows it, both.",
      [&] { return figure17(walk->shown); });
}

Result<void> paper_anatomy(PaperRun& run) {
  std::array<PaperCycle, 2> walks;  // real, built-in
  for (std::size_t i = 0; i < walks.size(); ++i) {
    run.progress(i == 0 ? "real meshes" : "built-in meshes", 0.4 * static_cast<double>(i));
    CycleRequest request{paper_body(), paper_gait(), LegMuscles{}, evenly(sequence), {}};
    if (i == 0) request.anatomy = run.anatomy;
    auto walk = walk_cycle(request);
    if (!walk) return tl::unexpected(walk.error());
    walks[i] = std::move(*walk);
  }
  return run.write_picture(
      "Above real meshes, below built-in ones, every eighth of the cycle from the right heel strike on.",
      [&]() -> Result<Image> {
        std::vector<std::vector<Image>> rows;
        for (const PaperCycle& walk : walks) {
          auto row = row_of(walk.shown);
          if (!row) return tl::unexpected(row.error());
          rows.push_back(std::move(*row));
        }
        return contact_sheet(rows, 3);
      });
}

}  // namespace mobil
