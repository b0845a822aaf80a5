#include "demo/lab/frontier/frontier_ways.h"

#include <algorithm>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include "assets/finite/control_points.h"
#include "demo/measure/measure.h"
#include "demo/program/must.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/finite.h"
#include "systems/deformation/finite_shape.h"
#include "systems/deformation/reduced.h"

namespace mobil {
namespace {

using Words = std::vector<Lanes<float>>;

Words alike_words(const std::vector<float>& row) {
  Words words(row.size());
  for (std::size_t w = 0; w < row.size(); ++w) std::ranges::fill(words[w].lane, row[w]);
  return words;
}

void set_lanes(Lanes<float>& lanes, double x) {
  std::ranges::fill(lanes.lane, static_cast<float>(x));
}

Belly living_belly(Muscle muscle, const LivingWay& way, BellyLibrary& library) {
  auto plan = must(make_muscle_plan(*make_body({}), muscle));
  plan.scale = {1, 1};
  return must(library.belly(plan, way.choice, living_tick_s));
}

/// Sixteen alike.
class LivingBellies {
 public:
  LivingBellies(const Belly& belly, const LegMuscles& choice)
      : belly_(belly),
        choice_(choice),
        length_m_(belly.shape->shape->mesh.node.back().z - belly.shape->shape->mesh.node.front().z),
        points_(nodal_width(choice.cells)),
        shown_(points_.size()) {
    set_lanes(scale_.across, 1), set_lanes(scale_.along, 1);
    if (choice.method == Method::reduced) {
      motion_ = alike_words(belly.motion);
      shape_ = alike_words(belly.rest_shape);
      state_.resize(reduced_state_width(belly.basis->vectors));
    } else {
      velocity_.resize(points_.size());
      scratch_.resize(scratch_floats(*belly.shape->shape, choice.method) / lane_count + 1);
    }
  }

  void tick(const WalkLoad& to) {
    constexpr auto tick_s = static_cast<float>(living_tick_s);
    end_.from = end_.to;
    set_lanes(end_.to, -to.shortening * length_m_);
    frame_.constant_from = frame_.constant_to;
    set_lanes(frame_.constant_to.x, to.push.constant_m_s2[0]);
    set_lanes(frame_.constant_to.y, to.push.constant_m_s2[1]);
    set_lanes(frame_.constant_to.z, to.push.constant_m_s2[2]);
    set_lanes(activation_, to.activation);
    const FarFaceDrive drive(FarEnd::held, end_);
    if (choice_.method == Method::reduced) {
      const ReducedBlock block{*belly_.basis, scale_, state_[0].lane, motion_[0].lane, &frame_};
      const ControlPoints points{shape_[0].lane, points_[0].lane};
      if (!choice_.reduced.moving) {
        place_static(block, points, drive);
      } else {
        if (choice_.reduced.tuned) {
          deform_tuned(block, drive, activation_, tick_s);
        } else {
          deform_reduced(block, drive, tick_s);
        }
        place_control_points(block, points, drive);
      }
    } else {
      BellyReport<Lanes<float>> unused;
      const BellyBlock block{*belly_.shape->shape,
                             scale_,
                             points_[0].lane,
                             velocity_[0].lane,
                             unused,
                             Stiffness::individual,
                             &frame_,
                             false};
      if (choice_.method == Method::finite) {
        deform_finite(block, drive, &activation_, belly_.steps, tick_s, scratch_[0].lane);
      } else {
        deform_explicit(block, drive, belly_.steps, tick_s, scratch_[0].lane);
      }
    }
    if (!has_finite_shape(choice_)) return;
    const ShapeBlock block{*belly_.finite, scale_, end_.to, &activation_};
    add_shape(block, blend_of(block), true, points_[0].lane, shown_[0].lane);
  }

  std::vector<double> shown() const {
    std::vector<double> points;
    for (const auto& u : has_finite_shape(choice_) ? shown_ : points_) points.push_back(double{u[0]});
    return choice_.cells == living_points ? points : sampled_points(choice_.cells, living_points, points);
  }

 private:
  const Belly& belly_;
  const LegMuscles& choice_;
  double length_m_;
  BellyScale<Lanes<float>> scale_{};
  EndDrive<Lanes<float>> end_{};
  FrameLoad<Lanes<float>> frame_{};
  Lanes<float> activation_{};
  Words points_, shown_, velocity_, scratch_, state_, motion_, shape_;
};

}  // namespace

std::vector<LivingWay> living_ways() {
  LegMuscles choice;
  choice.inertia = true;
  choice.activation = ExcitationSource::host;
  choice.finite_shape = false;
  choice.method = Method::reduced;
  choice.reduced.moving = false;
  std::vector<LivingWay> ways = {{"static", choice}};
  const auto shaped = [&] {
    ways.push_back(ways.back());
    ways.back().name += ", finite shape";
    ways.back().choice.finite_shape = true;
  };
  shaped();
  choice.method = Method::ecd;
  ways.push_back({"ecd, 81 nodes", choice});
  shaped();
  choice.method = Method::reduced;
  choice.reduced.moving = true;
  ways.push_back({"reduced-12", choice});
  shaped();
  for (const std::uint32_t vectors : {4U, 12U, 32U}) {
    choice.reduced.vectors = vectors;
    choice.reduced.tuned = true;
    ways.push_back({"reduced-" + std::to_string(vectors) + ", tuned", choice});
    ways.back().choice.finite_shape = true;
    ways.back().name += ", finite shape";
  }
  choice.method = Method::finite;
  ways.push_back({"finite, 81 nodes", choice});
  choice.cells = close_up_cells;
  ways.push_back({"finite, 425 nodes", choice});
  return ways;
}

LivingPoints living_points_of(Muscle muscle, const LivingWay& way, std::span<const WalkLoad> loads,
                              BellyLibrary& library) {
  const auto belly = living_belly(muscle, way, library);
  LivingBellies bellies(belly, way.choice);
  LivingPoints points;
  for (const WalkLoad& load : loads) {
    bellies.tick(load);
    points.push_back(bellies.shown());
  }
  return points;
}

double living_cost_us(Muscle muscle, const LivingWay& way, BellyLibrary& library) {
  constexpr std::size_t blocks = 64;
  const auto belly = living_belly(muscle, way, library);
  std::vector<LivingBellies> all(blocks, LivingBellies(belly, way.choice));
  double sway = 0.02;
  const Measured ticking = measure_short([&] {
    sway = -sway;
    for (LivingBellies& one : all) one.tick({sway, 0.3, {{0, 9.8 * sway, 0}, {}}});
  });
  return 1e6 * ticking.best_s / (blocks * lane_count);
}

}  // namespace mobil
