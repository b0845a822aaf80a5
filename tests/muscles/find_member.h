#pragma once
// Finds a row of the table of muscles by name.

#include <algorithm>
#include <string_view>

#include <mobil/muscle_table.h>

namespace mobil {

/// Returns the muscle of that name, or null.
inline const MemberMuscle* find_member_muscle(std::string_view name) {
  const auto members = member_muscles();
  const auto found = std::ranges::find(members, name, &MemberMuscle::name);
  return found == members.end() ? nullptr : &*found;
}

}  // namespace mobil
