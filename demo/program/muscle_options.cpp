#include "demo/program/muscle_options.h"

#include <fmt/format.h>

#include <mobil/muscle_table.h>
#include "demo/program/units.h"

namespace mobil {

Result<MuscleSet> read_muscles(const std::string& text) {
  MuscleSet set;
  for (const std::string& name : split(text, ',')) {
    if (name == "usual") {
      set |= usual_muscles();
    } else if (name == "groups") {
      set |= muscle_groups();
    } else if (name == "single" || name == "all" || name == "members") {
      set |= muscle_members();
    } else if (const auto muscle = find_muscle(name)) {
      set.set(static_cast<std::size_t>(*muscle));
    } else {
      std::string known;
      for (const MuscleRow& row : muscles()) known += fmt::format(", {}", row.name);
      return fail(fmt::format("--muscles '{}': '{}' is not one of usual, groups, all{}", text, name, known));
    }
  }
  return set;
}

std::string muscle_list(const MuscleSet& set) {
  std::string list;
  for (std::size_t m = 0; m < muscle_count; ++m)
    if (set[m]) list += (list.empty() ? "" : ",") + std::string(muscle_name(static_cast<Muscle>(m)));
  return list;
}

}  // namespace mobil
