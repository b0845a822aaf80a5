#include "demo/scene/crowd_people.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/systems/gait/resolve_gait.h>
#include "demo/scene/scatter.h"

namespace mobil {
namespace {

// streams of a person; lower numbers are draws of body and gait
constexpr std::uint64_t place_stream = 0x10000, change_stream = 0x20000, sex_stream = 0x50000;
constexpr float turning_deg = 50, turn_part = 0.5F, stop_part = 0.125F;

}  // namespace

CrowdRandom::CrowdRandom(std::uint64_t seed, std::uint64_t person, std::uint64_t stream)
    : state_(scatter(scatter(scatter(seed) ^ person) ^ stream)) {
  next();
}

std::uint64_t CrowdRandom::next() {
  return scatter(state_ += 0x9e3779b97f4a7c15);
}

float CrowdRandom::unit() {
  return static_cast<float>(next() >> 40) * 0x1p-24F;
}

float CrowdRandom::even(float low, float high) {
  return low + (high - low) * unit();
}

float CrowdRandom::bell(float mean, float deviation) {
  float sum = -6;
  for (int i = 0; i < 12; ++i) sum += unit();
  return mean + deviation * std::clamp(sum, -2.5F, 2.5F);
}

std::size_t CrowdRandom::below(std::size_t count) {
  return static_cast<std::size_t>(next() % count);
}

float crowd_speed(CrowdRandom& random) {
  return random.bell(1.35F, 0.15F);
}

CrowdPerson crowd_person(std::uint64_t seed, std::uint64_t number, std::uint32_t draw) {
  CrowdRandom random(seed, number, draw);
  CrowdPerson person;
  person.body.height_m = random.bell(1.72F, 0.09F);
  person.body.mass_kg = random.bell(24, 3) * person.body.height_m * person.body.height_m;
  person.body.biotype = {random.bell(3, 0.7F), random.bell(4, 0.7F), random.bell(3, 0.7F)};
  // Half are women, but fewer of the tall people.
  constexpr float between_m = 1.72F, spread_m = 0.04F;
  const float man = 1 / (1 + std::exp((between_m - person.body.height_m) / spread_m));
  person.body.sex = CrowdRandom(seed, number, sex_stream).even(0, 1) < man ? Sex::man : Sex::woman;
  person.body.constitution = static_cast<Constitution>(std::min(3, static_cast<int>(random.even(0, 4))));
  person.gait.speed_m_s = crowd_speed(random);
  for (const GaitParameter& parameter : gait_parameters) {
    float& value = person.gait.style.*parameter.value;
    value = std::clamp(value * random.even(0.9F, 1.1F), parameter.low, parameter.high);
  }
  // A variation by a tenth would make half of the crowd walk with knees bent by 30 to 50°.
  constexpr float part_of_it = 0.05F;
  float& height = person.gait.style.mid_stance_height;
  height = std::lerp(GaitStyle{}.mid_stance_height, height, part_of_it);
  return person;
}

Result<CrowdPerson> crowd_walker(std::uint64_t seed, std::uint64_t number, std::uint8_t& draw) {
  constexpr std::uint8_t max_draws = 20;
  for (;; ++draw) {
    const CrowdPerson person = crowd_person(seed, number, draw);
    const auto body = make_body(person.body);
    const auto gait = body ? resolve_gait(*body, person.gait) : tl::unexpected(body.error());
    if (gait) return person;
    if (draw == max_draws) return fail(fmt::format("person {} cannot walk as drawn: {}", number, gait.error().message));
  }
}

CrowdPlace crowd_place(std::uint64_t seed, std::uint64_t number) {
  CrowdRandom random(seed, number, place_stream);
  const float across = random.even(-0.5F, 0.5F), along = random.even(-0.5F, 0.5F);
  return {across, along, random.even(-std::numbers::pi_v<float>, std::numbers::pi_v<float>)};
}

CrowdChange crowd_change(std::uint64_t seed, std::uint64_t number, std::uint32_t k, bool stopped) {
  CrowdRandom random(seed, number, change_stream + k);
  CrowdChange change;
  change.after_s = stopped ? random.even(2, 8) : k == 0 ? random.even(0, 15) : random.even(4, 26);
  const float what = random.even(0, 1);
  if (stopped || what >= stop_part + turn_part) {
    change.speed_m_s = crowd_speed(random);
  } else if (what < stop_part) {
    change.speed_m_s = 0;
  } else {
    change.turn_rad = random.bell(0, turning_deg * std::numbers::pi_v<float> / 180);
  }
  return change;
}

}  // namespace mobil
