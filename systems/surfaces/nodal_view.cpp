#include <mobil/systems/surfaces/nodal_view.h>

#include <mobil/components/fade.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

NodalView nodal_displacement(const World& world, Entity muscle) {
  const auto place = world.find(muscle);
  if (!place) return {};
  const ComponentId* part = find_component(place.table->key(), type_id<ShownDisplacement>());
  if (part == nullptr) part = find_component(place.table->key(), type_id<NodalDisplacement>());
  if (part == nullptr) return {};
  const float* block = place.table->block(place.row / lane_count);
  return {block + place.table->column(part->id) * lane_count + place.row % lane_count,
          static_cast<std::uint32_t>(part->value / 3)};
}

}  // namespace mobil::inline v0_3
