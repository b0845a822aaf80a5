#include <mobil/engine/module.h>

#include <algorithm>

#include <mobil/schedule.h>

namespace mobil::inline v0_3 {

const Module* module_of(std::span<const Module> modules, std::uint64_t part) {
  for (const Module& module : modules) {
    for (const ComponentId& own : module.parts) {
      if (own.id == part) return &module;
    }
  }
  return nullptr;
}

Result<Schedule> make_schedule(std::span<const Module> modules, std::pmr::memory_resource* memory) {
  ScheduleBuilder systems;
  for (std::size_t m = 0; m < modules.size(); ++m) {
    const Module& module = modules[m];
    const auto before = modules.first(m);
    const auto same_name = [&](const Module& other) { return other.name == module.name; };
    if (module.name.empty() || std::any_of(before.begin(), before.end(), same_name)) {
      return fail("modules: number " + std::to_string(m) + " is named '" + module.name +
                  "', which is empty or another one's name; give each its own");
    }
    if (static_cast<bool>(module.follows) != static_cast<bool>(module.make))
      return fail("modules: '" + module.name +
                  "' says which column follows, or how it is made, but not both; give both");
    for (const ComponentId& part : module.parts) {
      const Module* const other = module_of(before, part.id);
      if (other == nullptr) continue;
      return fail("modules: '" + module.name + "' and '" + other->name + "' both claim " + std::string(part.name) +
                  "; list it in one of them");
    }
    for (const GlobalPart& one : module.globals) {
      const auto has_it = [&](const Module& other) {
        return std::ranges::any_of(other.globals, [&](const GlobalPart& theirs) { return theirs.id == one.id; });
      };
      if (std::ranges::any_of(before, has_it))
        return fail("modules: '" + module.name + "' has the global " + std::string(one.name) +
                    ", which another module has; list it in one of them");
    }
    systems.begin_module(module.name);
    for (const Phase& phase : module.before) systems.before(phase);
    for (const Phase& phase : module.after) systems.after_all(phase);
    if (module.systems) module.systems(systems);
  }
  return systems.build(memory);
}

}  // namespace mobil::inline v0_3
