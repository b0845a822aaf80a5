// What a simulation's people are like, in one number.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <vector>

#include "engine/row_hash.h"
#include "systems/simulation.h"

namespace mobil {
namespace {

/// Whose a muscle is follows from the person; handles are not what anybody is like.
constexpr IgnoredWords handles[] = {{type_id<MuscleOwner<float>>(), 0, 2}};

class Mixer {
 public:
  explicit Mixer(std::uint64_t start) : hash_(start) {}
  void add(std::uint64_t word) { hash_ = mix64((hash_ + 0x9e3779b97f4a7c15) ^ word); }
  void add(float a, float b) {
    add(std::uint64_t{std::bit_cast<std::uint32_t>(a)} << 32 | std::bit_cast<std::uint32_t>(b));
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(bool value) { add(std::uint64_t{value}); }
  void add(const std::optional<double>& value) {
    add(value.has_value());
    add(value.value_or(0));
  }
  void add(const Cells& cells) {
    for (const std::uint32_t count : cells) add(std::uint64_t{count});
  }
  void add(Method method, const ReducedChoice& reduced) {
    add(static_cast<std::uint64_t>(method) | std::uint64_t{reduced.vectors} << 8 | std::uint64_t{reduced.moving} << 40 |
        std::uint64_t{reduced.corrected} << 41 | std::uint64_t{reduced.control_points} << 42 |
        std::uint64_t{reduced.reported} << 43);
    add(reduced.cells);
  }
  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_;
};

std::uint64_t hash_of(const LegMuscles& choice) {
  Mixer mixer(1);
  mixer.add(std::uint64_t{choice.muscles.to_ulong()});
  mixer.add(static_cast<std::uint64_t>(choice.drive) << 16 | static_cast<std::uint64_t>(choice.element) << 8 |
            static_cast<std::uint64_t>(choice.mass));
  mixer.add(choice.method, choice.reduced);
  for (const double value : {choice.material.density_kg_m3, choice.material.young_pa, choice.material.poisson,
                             choice.damping_per_s, choice.stiffness_damping_s}) {
    mixer.add(value);
  }
  mixer.add(choice.inertia);
  mixer.add(choice.line_motion);
  mixer.add(choice.foundation_hz);
  mixer.add(choice.cells);
  mixer.add(choice.dt_s);
  return mixer.hash();
}

/// One number a row, and of each row whether it is somebody's; and of people.
struct Hashing {
  const World& world;
  const People& people;
  std::vector<std::uint64_t> choice;     // by number
  std::vector<std::size_t> first_block;  // by table, and one more: how many there are
  std::vector<std::uint64_t> row;        // sixteen a block
  std::vector<std::uint8_t> counted;     // by row
  std::atomic<std::uint64_t> sum = 0;    // of people

  Hashing(const World& of, const People& who) : world(of), people(who) {
    for (const LegMuscles& made : people.choices()) choice.push_back(hash_of(made));
    std::size_t blocks = 0;
    for (const Table& table : world.tables()) {
      first_block.push_back(blocks);
      blocks += table.block_count();
    }
    first_block.push_back(blocks);
    row.resize(blocks * lane_count);
    counted.resize(blocks * lane_count);
  }

  void hash_blocks(std::size_t begin, std::size_t end) {
    const auto after = std::upper_bound(first_block.begin(), first_block.end(), begin);
    auto table = static_cast<std::size_t>(after - first_block.begin()) - 1;
    for (; begin < end; ++table) {
      const std::size_t first = first_block[table], to = std::min(end, first_block[table + 1]);
      if (to == begin) continue;
      hash_rows(world.tables()[table], begin - first, to - first, handles, &row[begin * lane_count]);
      begin = to;
    }
  }

  /// 0 for a stale handle. Marks the row.
  std::uint64_t take(Entity entity) {
    const auto* at = world.locate(entity);
    if (at == nullptr) return 0;
    const std::size_t place = first_block[at->table] * lane_count + at->row;
    counted[place] = 1;
    return row[place];
  }

  void hash_people(std::size_t begin, std::size_t end) {
    std::uint64_t all = 0;
    for (const PersonRecord& person : people.all().subspan(begin, end - begin)) {
      if (!world.alive(person.entity)) continue;
      Mixer mixer(take(person.entity));
      const BodyRequest& body = person.body;
      mixer.add(body.height_m, body.mass_kg);
      mixer.add(body.biotype.endo, body.biotype.meso);
      mixer.add(body.biotype.ecto, 0.0F);
      mixer.add(static_cast<std::uint64_t>(body.constitution) << 1 | std::uint64_t{person.posed});
      if (!person.muscles.empty()) mixer.add(choice[person.choice]);
      for (const OwnMuscle& own : person.muscles) {
        mixer.add(static_cast<std::uint64_t>(own.muscle));
        for (const Entity muscle : own.entity) mixer.add(take(muscle));
      }
      all += mix64(mixer.hash());
    }
    sum += all;
  }

  std::uint64_t nobodys() const {
    std::uint64_t all = 0;
    for (std::size_t t = 0; t + 1 < first_block.size(); ++t) {
      const std::size_t first = first_block[t] * lane_count;
      for (std::size_t r = 0; r < world.tables()[t].row_count(); ++r) {
        if (counted[first + r] == 0) all += mix64(row[first + r] ^ 1);
      }
    }
    return all;
  }
};

}  // namespace

std::uint64_t Simulation::state_hash() const {
  Hashing hashing(world_, people_);
  const auto each = [&](std::size_t count, Jobs::Body body) { jobs_.parallel_for(jobs_.user, count, body, &hashing); };
  each(hashing.first_block.back(),
       [](void* to, std::size_t begin, std::size_t end) { static_cast<Hashing*>(to)->hash_blocks(begin, end); });
  each(people_.all().size(),
       [](void* to, std::size_t begin, std::size_t end) { static_cast<Hashing*>(to)->hash_people(begin, end); });
  return mix64(mix64(hashing.sum + hashing.nobodys()) + tick_);
}

}  // namespace mobil
