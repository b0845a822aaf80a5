#pragma once
// Adds the host's own parts (mobil/engine/archetype.h) to people and muscles, and creates the host's own entities.
//
//   simulation.parts().add(person, Fatigue<float>{0.2F});
//   simulation.parts().each([](const Rows& rows, const Pose<Lanes<float>>& pose, Fatigue<Lanes<float>>& fatigue) { …
//   });

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include <mobil/each.h>
#include <mobil/engine/error.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Access to the host's own parts (Simulation::parts). They are in the state hash, and in snapshots if a module names
/// them (SimulationOptions::modules). A part of a muscle stays when the muscle's method changes. Calls for the
/// library's parts, people and muscles return Status::not_yours; use the functions of Simulation for them.
class HostParts {
 public:
  /// `ours` are the ids of the library's parts, ascending.
  HostParts(World& world, std::span<const std::uint64_t> ours) : world_(world), ours_(ours) {}

  /// Adds a part that the entity does not have yet.
  template <class P>
  Result<void> add(Entity entity, const P& part) {
    return result_of("add", ours(component_id(part).id) ? Status::not_yours : world_.add(entity, part));
  }
  /// Overwrites a component's row.
  template <template <class> class C>
  Result<void> set(Entity entity, const C<float>& row) {
    return result_of("set", ours(type_id<C<float>>()) ? Status::not_yours : world_.set(entity, row));
  }
  /// Overwrites a field. `values` must be as long as the field is wide.
  template <class Tag>
  Result<void> set_field(Entity entity, std::span<const float> values) {
    return result_of("set_field", ours(type_id<Tag>()) ? Status::not_yours : world_.set_field<Tag>(entity, values));
  }
  /// Removes a part: a component by its template, a field or tag by its type.
  template <template <class> class C>
  Result<void> remove(Entity entity) {
    return result_of("remove", ours(type_id<C<float>>()) ? Status::not_yours : world_.remove<C>(entity));
  }
  template <class Tag>
  Result<void> remove(Entity entity) {
    return result_of("remove", ours(type_id<Tag>()) ? Status::not_yours : world_.remove<Tag>(entity));
  }
  /// Creates an entity from the host's own parts.
  template <class... P>
  Result<Entity> create(const P&... parts) {
    if ((ours(component_id(parts).id) || ...)) return fail(Status::not_yours);
    return world_.create(parts...);
  }
  /// Destroys an entity that `create` made.
  Result<void> destroy(Entity entity) {
    const auto place = world_.find(entity);
    if (!place) return fail(Status::stale_entity);
    const auto one_of_ours = [&](const ComponentId& part) { return ours(part.id); };
    if (std::ranges::any_of(place.table->key(), one_of_ours)) return fail(Status::not_yours);
    return result_of("destroy", world_.destroy(entity));
  }
  /// Registers an immutable resource, for a Shared part.
  template <class T>
  Shared<T> share(std::shared_ptr<const T> resource) {
    return world_.share(std::move(resource));
  }
  /// Calls `f` for each block of entities that have the parts of its parameters (mobil/each.h). `f` can only read the
  /// library's parts: if it has a parameter that writes one, the call does nothing and returns Status::not_yours.
  /// During ticks a module's systems can write them.
  template <class F>
  Result<void> each(F&& f) {
    if (writes_ours(Signature<std::remove_cvref_t<F>>{})) return fail(Status::not_yours);
    mobil::each(world_, f);
    return {};
  }

 private:
  bool ours(std::uint64_t part) const { return std::ranges::binary_search(ours_, part); }
  template <class... P>
  bool writes_ours(Parameters<P...>) const {
    return ((Parameter<P>::access().mode == Access::Mode::write && ours(Parameter<P>::access().id)) || ...);
  }

  World& world_;
  std::span<const std::uint64_t> ours_;
};

}  // namespace mobil::inline v0_3
