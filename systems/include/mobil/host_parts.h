#pragma once
// The host's own parts (mobil/engine/archetype.h) on people and muscles, and entities of the host's own: the one door
// to what rows are made of.
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

/// Parts are in the state hash; in snapshots where a module names them (SimulationOptions::modules). A part of a muscle
/// stays with it whatever its method. What is the library's, and its people and muscles, answer Status::not_yours: for
/// these are the calls of Simulation.
class HostParts {
 public:
  /// `ours`: ids of the library's parts, ascending.
  HostParts(World& world, std::span<const std::uint64_t> ours) : world_(world), ours_(ours) {}

  /// Adds a part that is not there yet.
  template <class P>
  Result<void> add(Entity entity, const P& part) {
    return result_of("add", ours(component_id(part).id) ? Status::not_yours : world_.add(entity, part));
  }
  /// Overwrites a component's row.
  template <template <class> class C>
  Result<void> set(Entity entity, const C<float>& row) {
    return result_of("set", ours(type_id<C<float>>()) ? Status::not_yours : world_.set(entity, row));
  }
  /// Overwrites a field; `values` is as long as the field is wide.
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
  /// An entity of the host's own, of its own parts.
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
  /// Takes a share in an immutable resource, for a Shared part.
  template <class T>
  Shared<T> share(std::shared_ptr<const T> resource) {
    return world_.share(std::move(resource));
  }
  /// Calls `f` with each block of all that have what its parameters name (mobil/each.h). The library's parts are there
  /// to be read: where `f` would write one, nothing is done and the answer is Status::not_yours. Within ticks a
  /// module's systems may write them.
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
