#include "demo/scene/crowd_people.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <mobil/anthropometry.h>
#include <mobil/systems/gait/resolve_gait.h>
#include "demo/scene/crowd_parties.h"
#include "demo/scene/scatter.h"

namespace mobil {
namespace {

// Streams of a person, one for each quantity. Those of body and style have room for draws.
constexpr std::uint64_t place_stream = 0x10000, change_stream = 0x20000;
constexpr std::uint64_t mass_stream = 0x1040000, biotype_stream = 0x1050000, constitution_stream = 0x1060000,
                        speed_stream = 0x1070000, style_stream = 0x1080000;
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

float crowd_speed(CrowdRandom& random, float usual_m_s) {
  return usual_m_s * std::exp(random.bell(0, 0.10F));
}

/// Returns the correlation of the standard scores of stature and body mass index: that of children of the Berkeley
/// Child Guidance Study, 0 for adults.
static float height_with_mass_index(float age_y) {
  return age_y < 12 ? std::lerp(0.38F, 0.33F, (age_y - 6) / 6)
                    : std::max(0.0F, std::lerp(0.33F, 0.0F, (age_y - 12) / 6));
}

CrowdPerson crowd_person(std::uint64_t seed, std::uint64_t number, std::uint32_t draw) {
  const CrowdMember one = crowd_member(seed, number);
  const auto stream = [&](std::uint64_t of) { return CrowdRandom(seed, one.drawn, of + draw); };
  CrowdPerson person;
  person.party_first = one.party_first;
  person.party_size = one.party_size;
  const float r = height_with_mass_index(one.age_y), cut = one.age_y < 18 ? 2.0F : 2.5F;
  const float mass_z = r * one.height_z + std::sqrt(1 - r * r) * stream(mass_stream).bell(0, 1);
  person.body = typical_body(one.sex, one.age_y, one.height_z, std::clamp(mass_z, -cut, cut));
  CrowdRandom biotype = stream(biotype_stream), style = stream(style_stream);
  person.body.biotype = {biotype.bell(3, 0.7F), biotype.bell(4, 0.7F), biotype.bell(3, 0.7F)};
  person.body.constitution = static_cast<Constitution>(stream(constitution_stream).below(constitutions));
  float speed_m_s = std::numeric_limits<float>::max();
  for (std::uint64_t k = one.party_first; k < one.party_first + one.party_size; ++k) {
    const CrowdMember member = crowd_member(seed, k);
    CrowdRandom random(seed, member.drawn, speed_stream);
    speed_m_s = std::min(speed_m_s, crowd_speed(random, usual_speed_m_s({.sex = member.sex, .age_y = member.age_y})));
  }
  person.gait.speed_m_s = speed_m_s;
  person.gait.style = usual_style(person.body);
  for (const GaitParameter& parameter : gait_parameters) {
    float& value = person.gait.style.*parameter.value;
    value = std::clamp(value * style.even(0.9F, 1.1F), parameter.low, parameter.high);
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

CrowdOffset crowd_abreast(std::uint32_t place, std::uint32_t party_size, float heading_rad) {
  constexpr std::uint32_t most = 3;
  constexpr float beside_m = 0.75F, behind_m = 1.0F;
  const std::uint32_t row = place / most, in_row = std::min(most, party_size - row * most);
  const float left_m = beside_m * (static_cast<float>(place % most) - 0.5F * static_cast<float>(in_row - 1));
  const float ahead_m = -behind_m * static_cast<float>(row), s = std::sin(heading_rad), c = std::cos(heading_rad);
  return {left_m * c + ahead_m * s, ahead_m * c - left_m * s};
}

CrowdChange crowd_change(std::uint64_t seed, std::uint64_t number, std::uint32_t k, bool stopped, float usual_m_s) {
  CrowdRandom random(seed, number, change_stream + k);
  CrowdChange change;
  change.after_s = stopped ? random.even(2, 8) : k == 0 ? random.even(0, 15) : random.even(4, 26);
  const float what = random.even(0, 1);
  if (stopped || what >= stop_part + turn_part) {
    change.speed_m_s = crowd_speed(random, usual_m_s);
  } else if (what < stop_part) {
    change.speed_m_s = 0;
  } else {
    change.turn_rad = random.bell(0, turning_deg * std::numbers::pi_v<float> / 180);
  }
  return change;
}

}  // namespace mobil
