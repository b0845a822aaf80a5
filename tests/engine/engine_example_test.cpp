// The engine in use: humans and muscles, each muscle following its human.
#include <gtest/gtest.h>

#include "components/muscle.h"
#include "engine/schedule.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("threads");

namespace mobil::engine_example_test {
template <class F>
struct Heel {
  F height_m;
};

void stride(Heel<Lanes<float>>& heel, float tick_s) {
  for (float& h : heel.height_m.lane) h += 2.0F * tick_s;
}

void follow(const MuscleOwner<Lanes<float>>& owner, const Lookup<Heel>& heels, EndDrive<Lanes<float>>& end) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float* heel = heels.find({owner.index[l], owner.generation[l]});
    if (heel != nullptr) end.to[l] = *heel;
  }
}

TEST(EngineExample, EveryMuscleFollowsItsHuman) {
  World world;
  const Entity tall = world.create(Heel<float>{0.2F}), small = world.create(Heel<float>{0.1F});
  const Entity muscle = world.create(MuscleOwner<float>{small.index, small.generation, Side::right}, EndDrive<float>{},
                                     FieldWidth<NodalDisplacement>{3});

  auto schedule = ScheduleBuilder().add("follow", &follow).add("stride", &stride).build();
  ASSERT_TRUE(schedule) << schedule.error().message;
  EXPECT_EQ(schedule->describe(),
            "1. stride; writes Heel\n2. follow; reads MuscleOwner; looks up Heel; writes EndDrive\n");

  const Threads threads(2);
  schedule->run(world, {0.25F, 0}, threads.jobs());
  EXPECT_EQ(world.get<EndDrive>(muscle)->to, 0.6F);

  EXPECT_EQ(world.destroy(small), Status::ok);
  schedule->run(world, {0.25F, 1}, threads.jobs());
  EXPECT_EQ(world.get<EndDrive>(muscle)->to, 0.6F);  // nobody to follow
  EXPECT_EQ(world.get<Heel>(tall)->height_m, 1.2F);
  EXPECT_EQ(world.get<Heel>(small).error(), Status::stale_entity);
}
}  // namespace mobil::engine_example_test
