#include "systems/snapshot/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include <mobil/engine/interrupt.h>
#include <mobil/schedule.h>
#include "engine/snapshot.h"
#include "systems/snapshot/snapshot_check.h"

namespace mobil::inline v0_3 {
namespace {

/// Lists of the front, with the lengths in its header.
struct SavedFront {
  FrontHeader header{};
  Records<SavedModule> modules;
  Records<SavedResource> resources;
  Records<SavedPartName> parts;
  Records<SavedGlobal> globals;
  std::span<const std::byte> global_bytes;
};

/// Calls f(part, value) with each global of the modules that is not at its first value.
template <class F>
void each_changed_global(std::span<const Module> modules, const World& world, F&& f) {
  for (const Module& module : modules)
    for (const GlobalPart& part : module.globals)
      if (world.globals().changed(part.id)) f(part, world.globals().find(part.id));
}

bool has_state(const Module& module, const World& world) {
  bool changed = false;
  each_changed_global({&module, 1}, world, [&](const GlobalPart&, std::span<const std::byte>) { changed = true; });
  if (changed) return true;
  for (const Table& table : world.tables()) {
    if (table.row_count() == 0) continue;
    for (const ComponentId& part : module.parts) {
      if (find_component(table.key(), part.id) != nullptr) return true;
    }
  }
  return false;
}

SavedModule pack(const Module& module) {
  SavedModule saved{};
  module.name.copy(saved.name, sizeof(saved.name));
  saved.version = module.version;
  return saved;
}

/// Lists unnamed components of tables that are new since the last call.
void learn_unnamed(const SnapshotScene& scene, SnapshotWork& work) {
  const auto& tables = scene.world.tables();
  for (; work.tables_seen < tables.size(); ++work.tables_seen) {
    for (const ComponentId& part : tables[work.tables_seen].key()) {
      if (module_of(scene.modules, part.id) != nullptr) continue;
      auto at = std::ranges::find(work.unnamed, part.id, [](const UnnamedPart& one) { return one.part.id; });
      if (at == work.unnamed.end()) at = work.unnamed.insert(at, {part, {}});
      at->tables.push_back(work.tables_seen);
    }
  }
}

/// Calls f(part) with each part that rows have and no module names.
template <class F>
void each_unnamed(const SnapshotScene& scene, const SnapshotWork& work, F&& f) {
  for (const UnnamedPart& one : work.unnamed) {
    const auto has_rows = [&](std::size_t table) { return scene.world.tables()[table].row_count() > 0; };
    if (std::ranges::any_of(one.tables, has_rows)) f(one.part);
  }
}

/// Counts the entries of the front's lists. Marks resources that tables with rows have.
FrontHeader count(const SnapshotScene& scene, SnapshotWork& work) {
  std::vector<std::uint8_t>& used = work.used;
  FrontHeader header{};
  for (const Module& module : scene.modules) header.modules += has_state(module, scene.world) ? 1 : 0;
  each_changed_global(scene.modules, scene.world, [&](const GlobalPart&, std::span<const std::byte> value) {
    ++header.globals;
    header.global_bytes += static_cast<std::uint32_t>(value.size());
  });
  used.assign(scene.world.resource_count(), 0);
  for (const Table& table : scene.world.tables()) {
    if (table.row_count() == 0) continue;
    for (const ComponentId& part : table.key()) {
      if (part.kind == PartKind::shared) used[part.value] = 1;
    }
  }
  header.resources = static_cast<std::uint32_t>(std::count(used.begin(), used.end(), 1));
  learn_unnamed(scene, work);
  each_unnamed(scene, work, [&](const ComponentId&) { ++header.parts; });
  return header;
}

/// Returns a function for a table's omitted component (Module::follows). Its std::function allocates no memory.
auto left_out_by(std::span<const Module> modules) {
  return [modules](const Archetype& key) -> std::uint64_t {
    for (const Module& module : modules) {
      if (!module.follows) continue;
      if (const std::uint64_t part = module.follows(key); part != 0) return part;
    }
    return 0;
  };
}

void make_left_out(const RestoreScene& scene) {
  for (Table& table : scene.world.tables()) {
    if (table.row_count() == 0) continue;
    for (const Module& module : scene.modules) {
      if (!module.follows || module.follows(table.key()) == 0) continue;
      const auto make = [&](std::size_t begin, std::size_t end) {
        module.make(table, scene.world, begin, end);
      };
      try {
        in_parallel(scene.jobs, table.block_count(), make);
      } catch (...) {  // a host's jobs threw, although they must not
        make(0, table.block_count());
      }
    }
  }
}

SnapshotLayout layout_of(const SnapshotScene& scene, const FrontHeader& header) {
  SnapshotLayout layout = WorldSnapshot::layout(scene.world, left_out_by(scene.modules));
  layout.front = sizeof(FrontHeader) + header.modules * sizeof(SavedModule) + header.resources * sizeof(SavedResource) +
                 header.parts * sizeof(SavedPartName) + header.globals * sizeof(SavedGlobal) + header.global_bytes;
  return layout;
}

Result<SavedFront> read_front(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  SavedFront front;
  if (reader.take(front.header)) {
    front.modules = reader.take_many<SavedModule>(front.header.modules);
    front.resources = reader.take_many<SavedResource>(front.header.resources);
    front.parts = reader.take_many<SavedPartName>(front.header.parts);
    front.globals = reader.take_many<SavedGlobal>(front.header.globals);
    front.global_bytes = reader.take_bytes(front.header.global_bytes);
  }
  if (!reader.whole()) return damaged("the sizes of its lists");
  return front;
}

/// Checks that every component exists here, in a module or on a row.
Result<void> check_parts(const SavedFront& front, const SavedWorld& saved, const RestoreScene& scene) {
  for (std::size_t i = 0; i < front.parts.size(); ++i) {
    const SavedPartName part = front.parts[i];
    const auto has = [&](const Table& table) { return find_component(table.key(), part.id) != nullptr; };
    if (module_of(scene.modules, part.id) != nullptr || std::ranges::any_of(scene.world.tables(), has)) continue;
    bool needed = false;
    for (std::uint32_t t = 0; t < saved.tables.size(); ++t) needed = needed || saved.part(t, part.id).has_value();
    if (!needed) continue;
    return fail(
        fmt::format("the snapshot's rows have '{}', which no module of this simulation names; list it in the"
                    " parts of a module (SimulationOptions::modules)",
                    std::string_view(part.name, strnlen(part.name, sizeof part.name))));
  }
  return {};
}

/// Returns the bytes of a saved global's value; empty if it had its first value.
std::span<const std::byte> saved_global(const SavedFront& front, std::uint64_t id) {
  std::span<const std::byte> left = front.global_bytes;
  for (std::size_t i = 0; i < front.globals.size(); ++i) {
    const SavedGlobal one = front.globals[i];
    if (one.id == id) return left.first(static_cast<std::size_t>(one.bytes));
    left = left.subspan(static_cast<std::size_t>(one.bytes));
  }
  return {};
}

/// Checks that every saved global belongs to a module, has the same size as here, and is valid.
Result<void> check_globals(const SavedFront& front, std::span<const Module> modules) {
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < front.globals.size(); ++i) {
    const SavedGlobal one = front.globals[i];
    const GlobalPart* known = nullptr;
    for (const Module& module : modules)
      for (const GlobalPart& part : module.globals)
        if (part.id == one.id) known = &part;
    if (known == nullptr)
      return fail(
          fmt::format("the snapshot has a global (number {}) that no module of this simulation names; list it in"
                      " a module's globals (SimulationOptions::modules)",
                      one.id));
    if (known->first.size() != one.bytes || one.bytes > front.global_bytes.size() - bytes)
      return damaged("a value that no module has");
    bytes += one.bytes;
  }
  if (bytes != front.global_bytes.size()) return damaged("the sizes of its lists");
  for (const Module& module : modules)
    for (const GlobalPart& part : module.globals) {
      const auto value = saved_global(front, part.id);
      if (!value.empty() && part.is_sound != nullptr && !part.is_sound(value.data()))
        return damaged("the value of " + std::string(plain_name(part.name)));
    }
  return {};
}

void restore_globals(const SavedFront& front, const RestoreScene& scene) noexcept {
  for (const Module& module : scene.modules)
    for (const GlobalPart& part : module.globals) {
      const auto value = saved_global(front, part.id);
      std::ranges::copy(value.empty() ? part.first : value, scene.world.globals().find(part.id).begin());
    }
}

Result<SnapshotTime> restore_checked(const RestoreScene& scene, const SnapshotTime& present, SnapshotWork& work,
                                     const RestoreLimits& limits, std::span<const std::byte> in) {
  const auto open = open_snapshot(in, scene.jobs);
  if (!open) return tl::unexpected(open.error());
  const auto world = WorldSnapshot::read(*open);
  if (!world) return tl::unexpected(world.error());
  const auto front = read_front(open->front);
  if (!front) return tl::unexpected(front.error());
  const FrontHeader& header = front->header;
  if (header.tick_units != present.tick_units || header.remainder_units < 0 ||
      header.remainder_units >= present.tick_units) {
    return fail(fmt::format("the snapshot's ticks are {} s long and this simulation's {} s; make one with that tick_s",
                            std::ldexp(static_cast<double>(header.tick_units), -50),
                            std::ldexp(static_cast<double>(present.tick_units), -50)));
  }
  std::size_t rows = 0;
  for (std::size_t t = 0; t < world->tables.size(); ++t) rows += world->tables[t].rows;
  if (rows > limits.rows) {
    return fail(
        fmt::format("the snapshot has {} people and muscles, and at most {} are allowed; raise RestoreLimits::rows",
                    rows, limits.rows));
  }
  if (header.resources > limits.resources) {
    return fail(
        fmt::format("the snapshot shares {} meshes, solvers, bases and choices, and at most {} are allowed;"
                    " raise RestoreLimits::resources",
                    header.resources, limits.resources));
  }
  if (auto ok = check_modules(front->modules, *world, scene.modules); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_parts(*front, *world, scene); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_globals(*front, scene.modules); !ok) return tl::unexpected(ok.error());
  if (limits.numbers) {
    if (auto ok = check_numbers(*world, scene.modules, scene.jobs); !ok) return tl::unexpected(ok.error());
  }
  work.parts.clear();
  for (const Module& module : scene.modules) {
    work.parts.insert(work.parts.end(), module.parts.begin(), module.parts.end());
  }
  work.shared.clear();
  work.resources.learn(scene.world, scene.library, scene.modules);
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < front->resources.size(); ++i) {
    const SavedResource saved = front->resources[i];
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const std::size_t max_nodes = spent.count() < limits.seconds ? limits.mesh_nodes : 0;
    const auto number = work.resources.number_of(saved, max_nodes, scene.world, scene.library, scene.modules);
    if (!number) return tl::unexpected(number.error());
    work.shared.push_back({resource_type(saved.recipe), saved.number, *number});
  }
  // Only one reference is captured, so that a std::function of it allocates no memory.
  const struct {
    const RestoreScene& scene;
    const ResourceList& resources;
    double tick_s;
    std::size_t max_steps;
  } known{scene, work.resources, std::ldexp(static_cast<double>(header.tick_units), -50), limits.steps};
  const auto check = [&known](const Archetype& key) -> Result<void> {
    if (auto ok = check_key(key, known.scene.world, known.resources, known.scene.modules); !ok) return ok;
    return check_steps(key, known.scene.world, known.tick_s, known.max_steps);
  };
  if (auto ok = work.world.prepare(scene.world, *world, work.parts, work.shared, left_out_by(scene.modules), check);
      !ok)
    return tl::unexpected(ok.error());
  work.world.commit(scene.world, *world, scene.jobs);  // nothing fails from here on
  restore_globals(*front, scene);
  make_left_out(scene);
  return SnapshotTime{header.tick_units, header.remainder_units, header.tick};
}

}  // namespace

std::size_t snapshot_bytes(const SnapshotScene& scene, SnapshotWork& work) {
  return layout_of(scene, count(scene, work)).bytes();
}

Result<std::size_t> save_snapshot(const SnapshotScene& scene, const SnapshotTime& time, SnapshotWork& work,
                                  std::span<std::byte> out) {
  work.resources.learn(scene.world, scene.library, scene.modules);
  FrontHeader header = count(scene, work);
  header.tick_units = time.tick_units;
  header.remainder_units = time.remainder_units;
  header.tick = time.tick;
  const SnapshotLayout layout = layout_of(scene, header);
  if (out.size() < layout.bytes())
    return fail(fmt::format("save: the snapshot takes {} bytes, and there is room for {}; give snapshot_bytes()",
                            layout.bytes(), out.size()));
  ByteWriter writer(&out[layout.front_at()]);
  writer.put(header);
  for (const Module& module : scene.modules) {
    if (has_state(module, scene.world)) writer.put(pack(module));
  }
  for (std::uint32_t number = 0; number < work.used.size(); ++number) {
    if (work.used[number] == 0) continue;
    const auto& [recipe, fingerprint] = work.resources.known()[number];
    if (recipe.kind == ResourceKind::unknown)
      return fail(
          "save: an entity has a shared resource that no module names; list it in a module's resources, or take it"
          " off all that have it");
    writer.put(SavedResource{recipe, fingerprint, number, 0});
  }
  each_unnamed(scene, work, [&](const ComponentId& part) {
    SavedPartName saved{part.id, {}};
    part.name.copy(saved.name, sizeof(saved.name));
    writer.put(saved);
  });
  each_changed_global(scene.modules, scene.world, [&](const GlobalPart& part, std::span<const std::byte> value) {
    writer.put(SavedGlobal{part.id, value.size()});
  });
  each_changed_global(scene.modules, scene.world, [&](const GlobalPart&, std::span<const std::byte> value) {
    writer.put(value.data(), value.size());
  });
  WorldSnapshot::save(scene.world, layout, out.first(layout.bytes()), scene.jobs, left_out_by(scene.modules));
  return layout.bytes();
}

Result<SnapshotTime> restore_snapshot(const RestoreScene& scene, const SnapshotTime& present, SnapshotWork& work,
                                      const RestoreLimits& limits, std::span<const std::byte> in) {
  Result<SnapshotTime> done;
  try {
    done = restore_checked(scene, present, work, limits, in);
  } catch (const std::bad_alloc&) {
    done = fail(Status::no_memory);
  } catch (const Interrupted&) {
    WorldSnapshot::give_up(scene.world);
    throw;
  }
  if (!done) WorldSnapshot::give_up(scene.world);
  return done;
}

}  // namespace mobil::inline v0_3
