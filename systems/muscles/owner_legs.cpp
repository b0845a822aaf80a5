#include "systems/muscles/owner_legs.h"

#include <mobil/rows.h>
#include "engine/fetch_ahead.h"
#include "systems/lines/line_of_action.h"

namespace mobil::inline v0_3 {
namespace {

constexpr PublishedLeg::Leg nobodys_leg{
    {{0, 1, 0}, {0, 0.5F, 0}, {0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}, {0, 0}};

/// Finds the legs of the owners of sixteen muscles; both legs of a person are mostly in adjacent lanes.
void find_legs(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner, const PublishedLeg::Leg** legs) {
  Entity last{};  // an invalid handle, without a leg
  const PublishedLeg* post = nullptr;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const Entity person{owner.index[lane], owner.generation[lane]};
    if (person != last) post = posts.find(last = person);
    legs[lane] = post == nullptr ? &nobodys_leg : &post->leg[owner.side[lane]];
  }
}

}  // namespace

LegFrames<Lanes<float>> legs_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner,
                                Ahead<MuscleOwner> ahead) {
  const PublishedLeg::Leg* from[lane_count];
  find_legs(posts, owner, from);
  LegFrames<Lanes<float>> leg;
  take_legs(from, leg);
  // Prefetches the owners of the third block, the places of the second's owners, and the legs of the next block's.
  FetchAhead(ahead.third).fetch(all_lines);
  if (ahead.second != nullptr)
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      posts.fetch({ahead.second->index[lane], ahead.second->generation[lane]});
  if (ahead.block == nullptr) return leg;
  find_legs(posts, *ahead.block, from);
  for (const PublishedLeg::Leg* const next : from) {
    __builtin_prefetch(next);
    __builtin_prefetch(reinterpret_cast<const char*>(next) + 64);
  }
  return leg;
}

LegClock<Lanes<float>> clocks_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner) {
  const PublishedLeg::Leg* from[lane_count];
  find_legs(posts, owner, from);
  LegClock<Lanes<float>> clocks;
  for (std::size_t lane = 0; lane < lane_count; ++lane) put_row(from[lane]->clock, clocks, lane);
  return clocks;
}

}  // namespace mobil::inline v0_3
