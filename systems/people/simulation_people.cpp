#include "systems/people/simulation_people.h"

#include <algorithm>
#include <utility>

namespace mobil {

void People::reserve(std::size_t more, std::size_t index_end) {
  const std::size_t people = all_.size() + more;
  if (people > all_.capacity()) all_.reserve(std::max(people, 2 * all_.capacity()));
  if (index_end > place_.size()) {
    if (index_end > place_.capacity()) place_.reserve(std::max(index_end, 2 * place_.capacity()));
    place_.resize(index_end, nobody);
  }
}

void People::add(PersonRecord person) {
  reserve(1, std::size_t{person.entity.index} + 1);
  if (place_[person.entity.index] != nobody) remove(all_[place_[person.entity.index]].entity);  // gone by the world
  place_[person.entity.index] = static_cast<std::uint32_t>(all_.size());
  all_.push_back(std::move(person));
}

void People::remove(Entity entity) {
  const std::uint32_t at = std::exchange(place_[entity.index], nobody);
  if (at + 1 != all_.size()) {
    all_[at] = std::move(all_.back());
    place_[all_[at].entity.index] = at;
  }
  all_.pop_back();
}

void People::clear() {
  all_.clear();
  std::fill(place_.begin(), place_.end(), nobody);
}

std::uint32_t People::number_of(const LegMuscles& choice) {
  auto at = std::find(choices_.begin(), choices_.end(), choice);
  if (at == choices_.end()) at = choices_.insert(at, choice);
  return static_cast<std::uint32_t>(at - choices_.begin());
}

}  // namespace mobil
