#include "demo/scene/crowd_parties.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "demo/scene/crowd_people.h"

namespace mobil {
namespace {

constexpr std::uint64_t sex_stream = 0x1000000, age_stream = 0x1010000, height_stream = 0x1020000,
                        party_stream = 0x1030000;
constexpr std::array<std::size_t, 13> family_sizes = {5, 5, 4, 4, 4, 4, 3, 3, 3, 3, 3, 3, 3};
constexpr std::size_t pairs = 27, couples = 18;
constexpr float adult_y = 18, never_alone_y = 10;
constexpr float of_spouse = 0.28F, of_both = 0.40F, rest_of_both = 0.77F, of_one = 0.512F;

struct AgeNode {
  float age_y, density;
};
constexpr AgeNode ages[] = {{6, 1.1F},  {18, 1.1F}, {30, 1.25F}, {45, 1.3F},
                            {60, 1.3F}, {70, 1.0F}, {80, 0.6F},  {90, 0.1F}};

/// Returns the age below which a fraction of the people is.
float age_at(float fraction) {
  const auto area = [](const AgeNode& a, const AgeNode& b) {
    return 0.5F * (a.density + b.density) * (b.age_y - a.age_y);
  };
  float left = 0;
  for (std::size_t i = 0; i + 1 < std::size(ages); ++i) left += area(ages[i], ages[i + 1]);
  left *= fraction;
  for (std::size_t i = 0; i + 1 < std::size(ages); ++i) {
    const auto& [from_y, density] = ages[i];
    const AgeNode& to = ages[i + 1];
    const float here = area(ages[i], to), rise = (to.density - density) / (to.age_y - from_y);
    if (left < here || i + 2 == std::size(ages))
      return std::min(from_y + 2 * left / (density + std::sqrt(density * density + 2 * left * rise)), to.age_y);
    left -= here;
  }
  return ages[0].age_y;
}

/// Relatives of a person within a block, on whom the stature depends.
struct Relatives {
  std::optional<std::size_t> husband{}, mother{}, father{};
};

/// Forms the parties of a block.
class Matchmaker {
 public:
  Matchmaker(const CrowdBlock& people, CrowdRandom random) : people_(people), random_(random) {
    for (const std::size_t size : family_sizes) family(size);
    for (std::size_t k = 0; k < pairs; ++k) pair(k < couples);
    for (std::size_t i = 0; i < people_.size(); ++i)
      if (!taken_[i]) join({i});
    for (std::size_t i = parties.size(); i > 1; --i) std::swap(parties[i - 1], parties[random_.below(i)]);
  }

  std::vector<std::vector<std::size_t>> parties;
  std::array<Relatives, crowd_block_size> relatives{};

 private:
  /// Returns the free person nearest to an age. `fits` filters people.
  template <class Fits>
  std::optional<std::size_t> nearest(float age_y, Fits fits) const {
    std::optional<std::size_t> found;
    float least = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < people_.size(); ++i) {
      const float apart = std::abs(people_[i].age_y - age_y);
      if (taken_[i] || !(apart < least) || !fits(people_[i])) continue;
      found = i;
      least = apart;
    }
    return found;
  }
  std::optional<std::size_t> adult(Sex sex, float age_y) const {
    return nearest(age_y, [&](const CrowdMember& one) { return one.age_y >= adult_y && one.sex == sex; });
  }
  std::optional<std::size_t> child(float age_y, float mothers_age_y) const {
    return nearest(age_y, [&](const CrowdMember& one) {
      return one.age_y < adult_y && mothers_age_y - one.age_y >= adult_y && mothers_age_y - one.age_y <= 45;
    });
  }
  void join(const std::vector<std::size_t>& party) {
    for (const std::size_t one : party) taken_[one] = true;
    parties.push_back(party);
  }
  std::optional<std::size_t> husband_of(std::size_t wife) {
    return adult(Sex::man, people_[wife].age_y + random_.bell(2.5F, 4));
  }

  /// Joins the youngest free person with a mother, a father and siblings, or with people of like age.
  void family(std::size_t size) {
    const auto youngest = nearest(0, [](const CrowdMember&) { return true; });
    // Parties of four and more have older siblings, who are 3 years apart.
    const float siblings_y = 1.5F * static_cast<float>(size - 3);
    const auto mother = adult(Sex::woman, people_[*youngest].age_y + siblings_y + random_.bell(30, 5));
    if (people_[*youngest].age_y >= adult_y || !mother) return friends(*youngest, size);
    std::vector<std::size_t> party = {*mother}, children = {*youngest};
    const auto father = husband_of(*mother);
    if (father) {
      party.push_back(*father);
      relatives[*mother].husband = father;
    }
    for (const std::size_t one : {*mother, *youngest}) taken_[one] = true;
    while (party.size() + children.size() < size) {
      const auto next = child(people_[children.back()].age_y + random_.bell(3, 1.5F), people_[*mother].age_y);
      if (!next) break;
      children.push_back(*next);
      taken_[*next] = true;
    }
    for (const std::size_t one : children) {
      relatives[one] = {.mother = mother, .father = father};
      party.push_back(one);
    }
    while (party.size() < size) {  // no further children: another adult comes along
      for (const std::size_t one : party) taken_[one] = true;
      const auto guest = nearest(people_[*mother].age_y, [](const CrowdMember& one) { return one.age_y >= adult_y; });
      if (!guest) break;
      party.insert(party.begin(), *guest);
    }
    join(party);
  }

  /// Joins a child under 10 and its mother, a couple, or two people of like age.
  void pair(bool couple) {
    const auto youngest = nearest(0, [](const CrowdMember&) { return true; });
    const auto someone = nearest(random_.even(adult_y, 80), [&](const CrowdMember& one) {
      return one.age_y >= adult_y && (!couple || one.sex == Sex::woman);
    });
    if (people_[*youngest].age_y < never_alone_y) {
      const auto mother = adult(Sex::woman, people_[*youngest].age_y + random_.bell(30, 5));
      relatives[*youngest].mother = mother;
      return join({mother.value_or(*nearest(90, [](const CrowdMember&) { return true; })), *youngest});
    }
    const auto husband = couple && someone ? husband_of(*someone) : std::nullopt;
    if (!husband) return friends(someone.value_or(*youngest), 2);
    relatives[*someone].husband = husband;
    join({*someone, *husband});
  }

  /// Joins a person with those of nearest age.
  void friends(std::size_t one, std::size_t size) {
    std::vector<std::size_t> party = {one};
    taken_[one] = true;
    while (party.size() < size) {
      const auto next = nearest(people_[one].age_y, [](const CrowdMember& of) { return of.age_y >= never_alone_y; });
      if (!next) break;
      party.push_back(*next);
      taken_[*next] = true;
    }
    join(party);
  }

  const CrowdBlock& people_;
  CrowdRandom random_;
  std::array<bool, crowd_block_size> taken_{};
};

float uncorrelated(float correlation) {
  return std::sqrt(1 - correlation * correlation);
}

}  // namespace

CrowdBlock crowd_block(std::uint64_t seed, std::uint64_t block) {
  CrowdBlock drawn, ordered;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    CrowdMember& one = drawn[i];
    one.drawn = block * crowd_block_size + i;
    one.sex = CrowdRandom(seed, one.drawn, sex_stream).even(0, 1) < 0.5F ? Sex::woman : Sex::man;
    one.age_y = age_at(CrowdRandom(seed, one.drawn, age_stream).even(0, 1));
    one.height_z = CrowdRandom(seed, one.drawn, height_stream).bell(0, 1);
  }
  const Matchmaker made(drawn, CrowdRandom(seed, block, party_stream));
  const auto relate = [&](auto has, auto height_z) {
    for (std::size_t i = 0; i < drawn.size(); ++i)
      if (has(made.relatives[i]))
        drawn[i].height_z = std::clamp(height_z(drawn[i].height_z, made.relatives[i]), -2.5F, 2.5F);
  };
  relate([](const Relatives& of) { return of.husband.has_value(); },
         [&](float own, const Relatives& of) {
           return of_spouse * drawn[*of.husband].height_z + uncorrelated(of_spouse) * own;
         });
  relate([](const Relatives& of) { return of.mother.has_value(); },
         [&](float own, const Relatives& of) {
           const float mother = drawn[*of.mother].height_z;
           return of.father ? of_both * (drawn[*of.father].height_z + mother) + rest_of_both * own
                            : of_one * mother + uncorrelated(of_one) * own;
         });
  std::size_t at = 0;
  for (const auto& party : made.parties) {
    const std::uint64_t first = block * crowd_block_size + at;
    for (const std::size_t one : party) {
      ordered[at] = drawn[one];
      ordered[at].party_first = first;
      ordered[at++].party_size = static_cast<std::uint32_t>(party.size());
    }
  }
  return ordered;
}

CrowdMember crowd_member(std::uint64_t seed, std::uint64_t number) {
  struct Last {
    std::uint64_t seed, block;
    CrowdBlock people;
  };
  thread_local std::optional<Last> last;  // people are mostly drawn in order of their numbers
  const std::uint64_t block = number / crowd_block_size;
  if (!last || last->seed != seed || last->block != block) last = {seed, block, crowd_block(seed, block)};
  return last->people[number % crowd_block_size];
}

}  // namespace mobil
