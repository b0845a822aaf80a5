#include "demo/crowd/crowd_legs.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include <mobil/shard_bytes.h>

namespace mobil {
namespace {

/// What is seen through the skin of who is near: the shirt hides the rest.
bool is_leg(Segment segment) {
  return segment == Segment::pelvis || (segment >= Segment::thigh_right && segment < Segment::clavicle_right);
}

template <class T>
void put_list(PlainBytes& bytes, const std::vector<T>& list) {
  bytes.put(std::uint64_t{list.size()});
  bytes.put_all(std::span<const T>(list));
}

template <class T>
void take_list(PlainReader& reader, std::vector<T>& list) {
  std::uint64_t count = 0;
  reader.take(count);
  list = reader.take_many<T>(static_cast<std::size_t>(count));
}

/// Triangles must speak of vertices that are there.
bool whole(std::size_t vertices, const std::vector<std::uint32_t>& triangle) {
  return triangle.size() % 3 == 0 &&
         std::ranges::all_of(triangle, [&](std::uint32_t vertex) { return vertex < vertices; });
}

constexpr std::string_view side_name[] = {"_right", "_left"};

}  // namespace

Result<const WalkRecording*> CrowdLegs::of(const Simulation& simulation, Entity person, std::uint64_t number) {
  const auto human = simulation.human(person);
  if (!human) return fail("a person who is to be drawn has left");
  auto found = shown_.find(number);
  if (found == shown_.end()) {
    auto figure = make_figure(*human);
    if (!figure) return tl::unexpected(figure.error());
    found = shown_.emplace(number, Shown{std::move(*figure), {}}).first;
  }
  Shown& shown = found->second;
  shown.recording = begin_recording(shown.figure, 1.0F / 30);
  std::erase_if(shown.recording.bones, [](const BoneSurface& bone) { return !is_leg(bone.segment); });
  record_frame(shown.figure, simulation, *human, shown.recording);
  return &shown.recording;
}

std::vector<std::byte> pack_legs(const WalkRecording& legs) {
  PlainBytes bytes;
  bytes.put(legs.frames.front());
  bytes.put(std::uint64_t{legs.bones.size()});
  for (const BoneSurface& bone : legs.bones) {
    bytes.put(bone.segment);
    put_list(bytes, bone.mesh.position);
    put_list(bytes, bone.mesh.triangle);
  }
  bytes.put(std::uint64_t{legs.muscles.size()});
  for (const RecordedMuscle& muscle : legs.muscles) {
    bytes.put(static_cast<std::uint8_t>(muscle.name.ends_with(side_name[1]) ? 1 : 0));
    bytes.put(muscle.colour);
    put_list(bytes, muscle.position_m.front());
    put_list(bytes, muscle.triangle);
  }
  return bytes.bytes();
}

Result<WalkRecording> unpack_legs(std::span<const std::byte> packed) {
  constexpr std::uint64_t most = 10'000;  // surfaces
  WalkRecording legs;
  PlainReader reader(packed);
  std::uint64_t bones = 0, muscles = 0;
  bool good = true;
  reader.take(legs.frames.emplace_back());
  reader.take(bones);
  for (std::uint64_t i = 0; i < std::min(bones, most); ++i) {
    BoneSurface& bone = legs.bones.emplace_back();
    reader.take(bone.segment);
    take_list(reader, bone.mesh.position);
    take_list(reader, bone.mesh.triangle);
    good = good && index(bone.segment) < segment_count && whole(bone.mesh.position.size(), bone.mesh.triangle);
  }
  reader.take(muscles);
  for (std::uint64_t i = 0; i < std::min(muscles, most); ++i) {
    RecordedMuscle& muscle = legs.muscles.emplace_back();
    std::uint8_t left = 0;
    reader.take(left);
    muscle.name = side_name[left == 0 ? 0 : 1];
    reader.take(muscle.colour);
    take_list(reader, muscle.position_m.emplace_back());
    take_list(reader, muscle.triangle);
    good = good && whole(muscle.position_m.front().size(), muscle.triangle);
  }
  if (!good || !reader.whole()) return fail("a person's bones and muscles do not agree with themselves");
  return legs;
}

}  // namespace mobil
