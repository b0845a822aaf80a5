#include "systems/muscles/finite_shape_effect.h"

#include <algorithm>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/components/fade.h>
#include <mobil/rows.h>
#include "systems/deformation/finite_shape.h"
#include "systems/deformation/modal.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_finite_shape {

ShapeBlock block_of(const FiniteShape& shape, const BellyScale<Lanes<float>>& scale, const EndDrive<Lanes<float>>& end,
                    const Maybe<Activation>& activation) {
  return {shape, scale, end.to, activation.block == nullptr ? nullptr : &activation.block->activation};
}

/// Shows bellies of methods whose displacements are their state.
void show(const Table& table, Shared<FiniteShape> shape, const BellyScale<Lanes<float>>& scale,
          const EndDrive<Lanes<float>>& end, Maybe<Activation> activation, Field<const NodalDisplacement> computed,
          Field<ShownDisplacement> shown) {
  if (!shows_apart(table.key())) return;
  const ShapeBlock block = block_of(*shape, scale, end, activation);
  add_shape(block, blend_of(block), true, computed.data, shown.data);
}

/// Shows modal bellies. Places them with their vibration about the linear solution of the load beyond the tables, which
/// is mostly zero, and adds the shape.
void show_in_place(Shared<FiniteShape> shape, Shared<ModalBasis> basis, const BellyScale<Lanes<float>>& scale,
                   const EndDrive<Lanes<float>>& end, Maybe<Activation> activation, Maybe<FrameLoad> frame,
                   MaybeField<const ModalState> state, Field<const ModalShape> rest,
                   Field<NodalDisplacement> displacement) {
  const ShapeBlock block = block_of(*shape, scale, end, activation);
  const ShapeBlend blend = blend_of(block);
  const EndDrive<Lanes<float>> beyond{blend.beyond_m, blend.beyond_m};
  const ModalBlock belly{*basis, scale, const_cast<float*>(state.data), nullptr, frame.block};  // only read here
  const ControlPoints points{rest.data, displacement.data, false, rest.next};
  const bool within = std::ranges::all_of(blend.beyond_m.lane, [](float beyond_m) { return beyond_m == 0.0F; });
  if (state.data == nullptr && frame.block == nullptr && within) {  // at rest, except the shape
    std::fill_n(displacement.data, std::size_t{displacement.words} * lane_count, 0.0F);
  } else if (state.data == nullptr) {
    place_static(belly, points, {FarEnd::held, beyond});
  } else {
    place_control_points(belly, points, {FarEnd::held, beyond});
  }
  add_shape(block, blend, false, displacement.data, displacement.data);
}

void report(Shared<FiniteShape>, Shared<MuscleTemplate> control, const BellyScale<Lanes<float>>& scale,
            Field<const NodalDisplacement> computed, MaybeField<const ShownDisplacement> shown,
            BellyReport<Lanes<float>>& report) {
  report_volume(*control, scale, shown.data == nullptr ? computed.data : shown.data, report.volume_ratio);
}

Module module() {
  return {
      .name = "finite shape", .parts = {component_id(Shared<FiniteShape>{})}, .systems = [](ScheduleBuilder& systems) {
        systems.add("finite shape", &show)
            .add("finite shape, modal", &show_in_place)
            .after("bellies")
            .add("finite shape, volume", &report)
            .after("fade")
            .after("bellies");
      }};
}

bool wanted(const MuscleKind& kind) {
  return kind.finite.resource != nullptr;
}

void parts(const MuscleKind& kind, std::vector<ComponentId>& to) {
  to.push_back(component_id(kind.finite));
}

/// Does nothing: the effect has no state, and the first tick shows it. Until then see shape_offset.
void begin(const EffectStart&, RowValues&) {}

}  // namespace of_finite_shape
}  // namespace

bool shows_apart(const MuscleKind& kind) {
  return kind.finite.resource != nullptr && kind.method.method != Method::modal;
}
bool shows_apart(const Archetype& key) {
  return find_component(key, type_id<FiniteShape>()) != nullptr &&
         find_component(key, type_id<ModalShape>()) == nullptr;
}

BellyMotion shape_offset(const NextBelly& next, float activation) {
  const FiniteShape& shape = *next.belly.finite;
  const std::size_t width = shape.even.size();
  const auto scale = broadcast(next.belly.plan.scale);
  BellyLoad within = next.load;  // without the frame's load
  within.frame.reset();
  const auto place = [&](float end_m, float& within_m) {
    std::vector<Lanes<float>> at(width);
    Lanes<float> end, pulls;
    std::ranges::fill(end.lane, end_m);
    std::ranges::fill(pulls.lane, activation);
    const ShapeBlock block{shape, scale, end, &pulls};
    const ShapeBlend blend = blend_of(block);
    add_shape(block, blend, false, at[0].lane, at[0].lane);
    within_m = blend.within_m[0];
    return at;
  };
  const auto before = place(next.load.from, within.from), now = place(next.load.to, within.to);
  BellyMotion offset = deformation_method(next.choice.method)->at_rest({next.belly, next.choice, next.line, within});
  for (std::size_t i = 0; i < width; ++i) {
    offset.displacement[i] = now[i][0] - offset.displacement[i];
    offset.velocity[i] = (now[i][0] - before[i][0]) / next.load.tick_s - offset.velocity[i];
  }
  return offset;
}

constinit const MuscleEffect finite_shape_effect = {&of_finite_shape::module, &of_finite_shape::wanted,
                                                    &of_finite_shape::begin, &of_finite_shape::parts};

}  // namespace mobil::inline v0_3
