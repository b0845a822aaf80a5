#include "systems/muscles/owner_legs.h"

#include "engine/rows.h"
#include "systems/lines/line_of_action.h"

namespace mobil {
namespace {

constexpr LegPost::Leg nobodys_leg{
    {{0, 1, 0}, {0, 0.5F, 0}, {0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}, {0, 0}};

const LegPost::Leg& leg_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner, std::size_t lane) {
  const LegPost* post = posts.find({owner.index[lane], owner.generation[lane]});
  return post == nullptr ? nobodys_leg : post->leg[owner.side[lane]];
}

}  // namespace

LegFrames<Lanes<float>> legs_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner,
                                Ahead<MuscleOwner> ahead) {
  const LegPost::Leg* from[lane_count];
  for (std::size_t lane = 0; lane < lane_count; ++lane) from[lane] = &leg_of(posts, owner, lane);
  LegFrames<Lanes<float>> leg;
  take_legs(from, leg);
  if (ahead.block == nullptr) return leg;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const LegPost::Leg& next = leg_of(posts, *ahead.block, lane);
    __builtin_prefetch(&next);
    __builtin_prefetch(reinterpret_cast<const char*>(&next) + 64);
  }
  return leg;
}

LegClock<Lanes<float>> clocks_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner) {
  LegClock<Lanes<float>> clocks;
  for (std::size_t lane = 0; lane < lane_count; ++lane) put_row(leg_of(posts, owner, lane).clock, clocks, lane);
  return clocks;
}

}  // namespace mobil
