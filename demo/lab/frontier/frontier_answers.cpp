
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "assets/fem/muscle_template.h"
#include "assets/reduction/modal_basis.h"
#include "demo/lab/effects/accuracy_measure.h"
#include "demo/lab/frontier/frontier.h"
#include "demo/program/must.h"
#include "systems/bellies/belly_library.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/modal.h"

namespace mobil {
namespace {

/// Lanes that are stepped in the same way.
struct Group {
  const FrontierIndividual* individual;
  std::uint32_t lanes = 0;  // bits
};

std::vector<Group> groups_of(const std::vector<FrontierIndividual>& individuals) {
  std::vector<Group> groups;
  for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
    const FrontierIndividual& own = individuals[lane];
    auto known = std::ranges::find_if(groups, [&](const Group& g) { return g.individual->alike(own); });
    if (known == groups.end()) known = groups.insert(groups.end(), {&own});
    known->lanes |= 1U << lane;
  }
  return groups;
}

/// Returns the minimum number of ticks that is an integer number of steps.
std::size_t meeting(double dt_s) {
  for (std::size_t ticks = 1; ticks <= 60; ++ticks) {
    const double steps = static_cast<double>(ticks) * frontier_tick_s / dt_s;
    if (std::abs(steps - std::round(steps)) < 1e-6) return ticks;
  }
  throw Stopped(
      fmt::format("frontier: steps of {} s never meet ticks of {:.6g} s; give another step", dt_s, frontier_tick_s));
}

/// Start of a group's calls, and the calls that give samples.
struct Calendar {
  double call_s = frontier_tick_s;
  std::size_t calls = 1;  // between samples, `stride` ticks
  FrontierAnswer* answer;

  /// Calls advance(from_s, to_s), and take(sample) at each sample.
  template <class Advance, class Take>
  void go(Advance&& advance, Take&& take) const {
    const std::size_t samples = answer->samples();
    for (std::size_t stretch = 0, sample = 0; sample < samples; ++stretch) {
      const double start_s = static_cast<double>(stretch * answer->stride) * frontier_tick_s;
      if (stretch * answer->stride >= answer->first) take(answer->displacement_m.data() + sample++ * point_width);
      for (std::size_t call = 0; call < calls; ++call) {
        const double from_s = start_s + static_cast<double>(call) * call_s;
        advance(from_s, from_s + call_s);
      }
    }
  }
};

void answer_by_elements(const FrontierDrive& drive, const FrontierMethod& method, const Group& group, bool loads,
                        const Calendar& calendar) {
  const MuscleTemplate& shape = *group.individual->shape;
  const auto points = frontier_mesh(drive.muscle, frontier_points);
  const FrontierSampler sampler(shape.mesh, points);
  std::vector<Lanes<float>> displacement(nodal_width(shape.mesh.cells)), velocity(displacement.size());
  std::vector<Lanes<float>> scratch(scratch_floats(shape, method.choice.method) / lane_count + 1);
  const std::uint32_t steps = method.fixed_step ? 1 : group.individual->steps;
  calendar.go(
      [&](double from_s, double to_s) {
        const auto end = drive.end(from_s, to_s);
        const auto load = loads ? drive.load(from_s, to_s) : FrameLoad<Lanes<float>>{};
        BellyReport<Lanes<float>> unused;
        const BellyBlock block{shape,  drive.scale,           displacement.data()->lane, velocity.data()->lane,
                               unused, Stiffness::individual, loads ? &load : nullptr,   false};
        const auto call_s = static_cast<float>(calendar.call_s);
        if (group.individual->solver == nullptr) {
          deform_explicit(block, {FarEnd::held, end}, steps, call_s, scratch.data()->lane);
        } else {
          deform_implicit(block, *group.individual->solver, {FarEnd::held, end}, steps, call_s, scratch.data()->lane);
        }
      },
      [&](Lanes<float>* to) { sampler.sample(displacement.data()->lane, group.lanes, to); });
}

/// Returns sixteen individuals' numbers, one in each lane. Lanes outside the group repeat its individual.
std::vector<Lanes<float>> in_lanes(const std::vector<FrontierIndividual>& individuals,
                                   std::vector<float> FrontierIndividual::*numbers, const Group& group) {
  std::vector<Lanes<float>> all((group.individual->*numbers).size());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const bool own = (group.lanes >> lane & 1) != 0;
    const std::vector<float>& of = (own ? individuals[lane] : *group.individual).*numbers;
    for (std::size_t i = 0; i < all.size(); ++i) all[i][lane] = of[i];
  }
  return all;
}

void answer_by_modes(const FrontierDrive& drive, const FrontierMethod& method,
                     const std::vector<FrontierIndividual>& individuals, const Group& group, bool loads,
                     const Calendar& calendar) {
  const ModalBasis& basis = *group.individual->basis;
  const auto motion = in_lanes(individuals, &FrontierIndividual::motion, group);
  const auto shape = in_lanes(individuals, &FrontierIndividual::points, group);
  std::vector<Lanes<float>> state(modal_state_width(basis.modes)), displacement(point_width);
  EndDrive<Lanes<float>> end{};
  FrameLoad<Lanes<float>> load{};
  const ModalBlock block{basis, drive.scale, state.data()->lane, motion.data()->lane, loads ? &load : nullptr};
  calendar.go(
      [&](double from_s, double to_s) {
        end = drive.end(from_s, to_s);
        if (loads) load = drive.load(from_s, to_s);
        if (method.moving()) deform_modal(block, {FarEnd::held, end}, static_cast<float>(calendar.call_s));
      },
      [&](Lanes<float>* to) {
        const ControlPoints points{shape.data()->lane, displacement.data()->lane};
        if (method.moving()) {
          place_control_points(block, points, {FarEnd::held, end});
        } else {
          place_static(block, points, {FarEnd::held, end});
        }
        for (std::size_t i = 0; i < point_width; ++i) {
          for (std::size_t l = 0; l < lane_count; ++l) {
            if ((group.lanes >> l & 1) != 0) to[i][l] = displacement[i][l];
          }
        }
      });
}

constexpr std::uint32_t fewer_modes = 24, modes_of_a_coarse_mesh = 16;

Cells half(const Cells& cells) {
  return {cells[0] / 2, cells[1] / 2, cells[2] / 2};
}

/// Returns sixteen individuals with modes of their own sizes, extrapolated from a mesh and one of half its cells.
std::vector<FrontierIndividual> own_modes(const FrontierDrive& drive, const Cells& cells, std::uint32_t modes,
                                          bool loads) {
  LegMuscles choice;
  choice.inertia = loads;
  std::vector<FrontierIndividual> all(lane_count);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    for (std::size_t before = 0; before < lane && all[lane].basis == nullptr; ++before) {
      const bool same = drive.scale.across[before] == drive.scale.across[lane] &&
                        drive.scale.along[before] == drive.scale.along[lane];
      if (same) all[lane] = all[before];
    }
    if (all[lane].basis != nullptr) continue;
    all[lane].basis = reference_basis(drive.plan[lane], choice, cells, modes);
  }
  return all;
}

FrontierAnswer answer_with(const FrontierDrive& drive, std::vector<FrontierIndividual> individuals, std::uint32_t modes,
                           bool loads) {
  FrontierMethod method;
  method.choice.method = Method::modal;
  std::map<const ModalBasis*, std::shared_ptr<const ModalBasis>> cut;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    FrontierIndividual& own = individuals[lane];
    auto& basis = cut[own.basis.get()];
    if (basis == nullptr) basis = std::make_shared<const ModalBasis>(truncated(*own.basis, modes));
    const auto belly = must(make_modal_belly(*basis, static_cast<double>(drive.scale.across[lane]),
                                             static_cast<double>(drive.scale.along[lane])));
    set_modes(own, basis, belly, method.choice.damping_per_s);
  }
  return answer_of(drive, method, individuals, loads);
}

}  // namespace

std::size_t FrontierAnswer::samples() const {
  return displacement_m.size() / point_width;
}

FrontierSampler::FrontierSampler(const HexahedralMesh& mesh, const HexahedralMesh& points) {
  const Cells &fine = mesh.cells, &coarse = points.cells;
  if (fine[0] % coarse[0] != 0 || fine[1] % coarse[1] != 0) {
    throw Stopped(
        fmt::format("frontier: a mesh of {}x{}x{} cells has not the control points of {}x{}x{} across; take"
                    " multiples",
                    fine[0], fine[1], fine[2], coarse[0], coarse[1], coarse[2]));
  }
  for_each_node(coarse, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const double z = points.node[node_index(coarse, i, j, k)].z;
    const auto node = [&](std::uint32_t at) {
      return node_index(fine, i * (fine[0] / coarse[0]), j * (fine[1] / coarse[1]), at);
    };
    std::uint32_t at = 0;
    while (at + 1 < fine[2] && mesh.node[node(at + 1)].z < z) ++at;
    const double low = mesh.node[node(at)].z, high = mesh.node[node(at + 1)].z;
    double part = std::clamp((z - low) / (high - low), 0.0, 1.0);
    if (std::min(part, 1 - part) < 1e-4) part = std::round(part);
    place_.push_back({node(at), node(at + 1), static_cast<float>(part)});
  });
}

void FrontierSampler::sample(const float* displacement, std::uint32_t lanes, Lanes<float>* to) const {
  for (const Place& place : place_) {
    for (std::size_t c = 0; c < 3; ++c, ++to) {
      const float* const a = displacement + lane_count * (3 * std::size_t{place.before} + c);
      const float* const b = displacement + lane_count * (3 * std::size_t{place.after} + c);
      for (std::size_t l = 0; l < lane_count; ++l) {
        if ((lanes >> l & 1) != 0) (*to)[l] = (1 - place.part) * a[l] + place.part * b[l];
      }
    }
  }
}

FrontierAnswer answer_of(const FrontierDrive& drive, const FrontierMethod& method,
                         const std::vector<FrontierIndividual>& individuals, bool loads) {
  FrontierAnswer answer;
  Calendar calendar{.answer = &answer};
  if (method.fixed_step) {
    calendar.call_s = *method.choice.dt_s;
    answer.stride = meeting(calendar.call_s);
    calendar.calls =
        static_cast<std::size_t>(std::lround(static_cast<double>(answer.stride) * frontier_tick_s / calendar.call_s));
  }
  answer.first = (drive.first + answer.stride - 1) / answer.stride * answer.stride;
  answer.displacement_m.resize(((drive.ticks() - answer.first) / answer.stride + 1) * point_width);
  for (const Group& group : groups_of(individuals)) {
    if (method.modal()) {
      answer_by_modes(drive, method, individuals, group, loads, calendar);
    } else {
      answer_by_elements(drive, method, group, loads, calendar);
    }
  }
  return answer;
}

void FrontierError::add(const FrontierAnswer& answer, const FrontierAnswer& truth, std::size_t walks) {
  for (std::size_t s = 0; s < answer.samples(); ++s) {
    const std::size_t t = answer.first + s * answer.stride - truth.first;
    for (std::size_t n = 0; n < point_width; n += 3) {
      for (std::size_t l = 0; l < walks; ++l) {
        double distance = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          const auto is = static_cast<double>(answer.displacement_m[s * point_width + n + c][l]);
          const auto should = static_cast<double>(truth.displacement_m[t * point_width + n + c][l]);
          distance += (is - should) * (is - should);
          reference_square += should * should;
        }
        square += distance;
        largest_m = std::max(largest_m, std::sqrt(distance));
      }
    }
  }
}

void FrontierError::add(const FrontierError& other) {
  square += other.square;
  reference_square += other.reference_square;
  largest_m = std::max(largest_m, other.largest_m);
}

double FrontierError::relative() const {
  if (reference_square == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(square / reference_square);
}

FrontierReference make_reference(const FrontierDrive& drive, const Cells& cells, bool loads) {
  const std::uint32_t coarse_modes = cells[0] < 8 ? modes_of_a_coarse_mesh : max_modes;
  const auto fine = own_modes(drive, cells, max_modes, loads);
  const auto coarse = own_modes(drive, half(cells), coarse_modes, loads);
  auto truth = answer_with(drive, fine, max_modes, loads);
  const auto fewer = answer_with(drive, fine, fewer_modes, loads);
  const auto coarser = answer_with(drive, coarse, coarse_modes, loads);
  FrontierReference reference{std::move(truth), {}, {}};
  reference.mesh.add(coarser, reference.truth, drive.walks);
  reference.modes.add(fewer, reference.truth, drive.walks);
  return reference;
}

}  // namespace mobil
