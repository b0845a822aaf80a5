#include "demo/crowd/city_picture.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <mobil/png.h>
#include <mobil/shard_bytes.h>
#include "demo/crowd/crowd_legs.h"
#include "demo/program/commands.h"
#include "demo/program/progress.h"

namespace mobil {

void take_picture(Ranks& ranks, Cluster& cluster, const Camera& camera, std::optional<CrowdCamera>& pictures,
                  const std::filesystem::path& file) {
  ranks.between_ticks();
  std::vector<PicturedPerson> seen;
  std::map<std::uint64_t, std::pair<const Simulation*, Entity>> where;
  each_shard(cluster, [&](CityShard& shard) {
    const auto people = shard.people();
    for (const auto& person : people) where.emplace(person.number, std::pair{&shard.simulation(), person.entity});
    const auto own = CrowdCamera::see(shard.simulation(), camera, people);
    seen.insert(seen.end(), own.begin(), own.end());
  });
  const auto all_seen = ranks.gather(std::as_bytes(std::span(seen)));
  seen.clear();
  for (const auto& bytes : all_seen) {
    const auto some = PlainReader(bytes).take_many<PicturedPerson>(bytes.size() / sizeof(PicturedPerson));
    seen.insert(seen.end(), some.begin(), some.end());
  }
  arrange(seen);
  PlainBytes chosen;
  for (std::size_t i = 0; i < std::min(seen.size(), most_legs) && seen[i].near != 0; ++i) chosen.put(seen[i].number);
  const auto numbers = ranks.share(chosen.bytes());
  PlainBytes own_legs;
  CrowdLegs makes;
  for (const std::uint64_t number :
       PlainReader(numbers).take_many<std::uint64_t>(numbers.size() / sizeof(std::uint64_t))) {
    const auto found = where.find(number);
    if (found == where.end()) continue;
    const auto legs = makes.of(*found->second.first, found->second.second, number);
    if (!legs) ranks.stop("mobil crowd: --capture: " + legs.error().message);
    ranks.alive();
    const auto packed = pack_legs(**legs);
    own_legs.put(number);
    own_legs.put(std::uint64_t{packed.size()});
    own_legs.put_all(std::span<const std::byte>(packed));
  }
  std::map<std::uint64_t, WalkRecording> legs;
  for (const auto& bytes : ranks.gather(own_legs.bytes())) {
    for (PlainReader reader(bytes); !reader.whole();) {
      std::uint64_t number = 0, size = 0;
      reader.take(number);
      reader.take(size);
      auto one = unpack_legs(reader.take_many<std::byte>(static_cast<std::size_t>(size)));
      if (!one) ranks.stop("mobil crowd: --capture: " + one.error().message);
      legs.emplace(number, std::move(*one));
    }
  }
  if (!ranks.first()) return;
  CrowdCamera::Legs drawn;
  for (const auto& [number, recording] : legs) drawn.emplace(number, &recording);
  Image image;
  auto done = pictures->draw(camera, seen, drawn, image);
  if (done) done = write_png(file.string(), image, PngEffort::small);
  if (!done) ranks.stop("mobil crowd: --capture: " + done.error().message);
  show("");
  say_written(file);
}

}  // namespace mobil
