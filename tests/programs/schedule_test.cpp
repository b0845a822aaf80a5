// `mobil schedule`: the picture shows the complete tick, and the one in ARCHITECTURE.md is current.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include "demo/schedule/schedule_picture.h"
#include "tests/program/program.h"

namespace mobil {
namespace {
namespace schedule {

std::size_t count_of(std::string_view piece, std::string_view in) {
  std::size_t count = 0;
  for (std::size_t at = in.find(piece); at != std::string_view::npos; at = in.find(piece, at + 1)) ++count;
  return count;
}

TEST(SchedulePicture, EverySystemAndEveryAccessHasItsMark) {
  const Simulation simulation;
  const std::string picture = schedule_picture(simulation.schedule());
  std::size_t read = 0, written = 0, looked_up = 0, previous = 0;
  for (const System& system : simulation.schedule().systems()) {
    EXPECT_NE(picture.find(">" + system.name + "<"), std::string::npos) << system.name;
    for (const Access& access : system.accesses) {
      read += access.mode == Access::Mode::read ? 1 : 0;
      written += access.mode == Access::Mode::write ? 1 : 0;
      looked_up += access.mode == Access::Mode::lookup ? 1 : 0;
      previous += access.mode == Access::Mode::previous ? 1 : 0;
      if (access.mode == Access::Mode::none) continue;
      EXPECT_NE(picture.find(">" + std::string(plain_name(access.name)) + "<"), std::string::npos) << access.name;
    }
  }
  EXPECT_GT(written, 20U);
  for (const auto phases : {simulation.schedule().before(), simulation.schedule().after()})
    for (const TimedPhase& one : phases)
      EXPECT_NE(picture.find(">" + one.phase.name + "<"), std::string::npos) << one.phase.name;
  // each occurs once more in the legend
  EXPECT_EQ(count_of("class=\"read\"", picture), read + 1);
  EXPECT_EQ(count_of("class=\"write\"", picture), written + 1);
  EXPECT_EQ(count_of("class=\"lookup\"", picture), looked_up + 1);
  EXPECT_EQ(count_of("class=\"previous\"", picture), previous + 1);
}

TEST(SchedulePicture, CommittedPictureIsCurrent) {
  EXPECT_EQ(read_bytes(MOBIL_SOURCE_DIR "/demo/gallery/schedule.svg"), schedule_picture(Simulation().schedule()))
      << "the systems have changed; run: mobil schedule --svg demo/gallery/schedule.svg";
}

TEST(ScheduleCommand, PrintsOneLineAPhaseAndSystem) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("schedule", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  const Simulation simulation;
  const Schedule& all = simulation.schedule();
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(ran.out, '\n')),
            all.before().size() + all.systems().size() + all.after().size());
  EXPECT_NE(ran.out.find("kinematics; reads "), std::string::npos) << ran.out;
}

}  // namespace schedule
}  // namespace
}  // namespace mobil
