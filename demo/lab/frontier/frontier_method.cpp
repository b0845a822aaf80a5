#include "demo/lab/frontier/frontier_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include <mobil/systems/muscles/person.h>
#include "assets/surfaces/muscle_lattice.h"
#include "demo/program/must.h"

namespace mobil {
namespace {

constexpr double ramp_s = 1, calm_s = 0.5;  // time to grow to the walk, and to ring down
constexpr double walked_before_s = 2;       // strides that are not recorded

/// Returns a ramp from 0 to 1 with three derivatives that are zero at both ends.
double ramp(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * x * (35 + x * (-84 + x * (70 - 20 * x)));
}

float mixed(float a, float b, double part) {
  return static_cast<float>(static_cast<double>(a) + part * (static_cast<double>(b) - static_cast<double>(a)));
}

void scale_into(const Vec3<float>& a, float by, Vec3<Lanes<float>>& to, std::size_t lane) {
  to.x[lane] = by * a.x;
  to.y[lane] = by * a.y;
  to.z[lane] = by * a.z;
}

struct Moment {
  std::size_t tick;
  double part;
};

/// Returns the moment of a time; times past the end count as the end.
Moment moment(double time_s, std::size_t ticks) {
  const double at = std::clamp(time_s / frontier_tick_s, 0.0, static_cast<double>(ticks));
  const auto tick = std::min(static_cast<std::size_t>(at), ticks - 1);
  return {tick, at - static_cast<double>(tick)};
}

void mix(const Lanes<float>& a, const Lanes<float>& b, double part, Lanes<float>& to) {
  for (std::size_t l = 0; l < lane_count; ++l) to[l] = mixed(a[l], b[l], part);
}
void mix(const Vec3<Lanes<float>>& a, const Vec3<Lanes<float>>& b, double part, Vec3<Lanes<float>>& to) {
  mix(a.x, b.x, part, to.x);
  mix(a.y, b.y, part, to.y);
  mix(a.z, b.z, part, to.z);
}

/// Records one walker's muscles in one lane of each drive.
void record(const FrontierWalk& walk, std::size_t lane, std::vector<FrontierDrive>& drives) {
  Simulation simulation({.tick_s = frontier_tick_s});
  const auto person = must(simulation.spawn(walk.body, {.speed_m_s = walk.speed_m_s}));
  LegMuscles choice;
  choice.muscles.reset();
  for (const FrontierDrive& drive : drives) choice.muscles.set(static_cast<std::size_t>(drive.muscle));
  choice.inertia = true;
  must(simulation.set_muscles(person, choice));
  const Person who = *simulation.person(person);
  for (FrontierDrive& drive : drives) {
    const auto own = std::ranges::find(who.muscles, drive.muscle, [](const PersonMuscle& m) { return m.plan.muscle; });
    drive.plan[lane] = own->plan;
    drive.scale.across[lane] = own->plan.scale.across;
    drive.scale.along[lane] = own->plan.scale.along;
  }
  for (int i = 0; i < std::lround(walked_before_s / frontier_tick_s); ++i) simulation.tick();
  for (std::size_t t = 0; t <= drives.front().ticks(); ++t) {
    simulation.tick();
    const auto part = static_cast<float>(ramp(static_cast<double>(t) * frontier_tick_s / ramp_s));
    for (FrontierDrive& drive : drives) {
      const Entity muscle = simulation.muscle(person, drive.muscle, Side::right);
      const auto end = simulation.get<EndDrive>(muscle);
      const auto load = simulation.get<FrameLoad>(muscle);
      if (!end || !load) throw Stopped("frontier: a muscle is gone from its walker");
      drive.end_m[t][lane] = part * end->to;
      FrontierFrame& frame = drive.frame[t];
      scale_into(load->constant_to, part, frame.constant, lane);
      scale_into(load->gradient_to.x, part, frame.gradient.x, lane);
      scale_into(load->gradient_to.y, part, frame.gradient.y, lane);
      scale_into(load->gradient_to.z, part, frame.gradient.z, lane);
    }
  }
}

void repeat(FrontierDrive& drive, std::size_t from, std::size_t to) {
  drive.plan[to] = drive.plan[from];
  const auto copy = [&](Lanes<float>& of) { of[to] = of[from]; };
  const auto copy_all = [&](Vec3<Lanes<float>>& of) {
    copy(of.x);
    copy(of.y);
    copy(of.z);
  };
  copy(drive.scale.across);
  copy(drive.scale.along);
  for (Lanes<float>& end : drive.end_m) copy(end);
  for (FrontierFrame& frame : drive.frame) {
    copy_all(frame.constant);
    copy_all(frame.gradient.x);
    copy_all(frame.gradient.y);
    copy_all(frame.gradient.z);
  }
}

}  // namespace

EndDrive<Lanes<float>> FrontierDrive::end(double from_s, double to_s) const {
  EndDrive<Lanes<float>> all;
  const auto at = [&](double time_s, Lanes<float>& to) {
    const Moment m = moment(time_s, ticks());
    mix(end_m[m.tick], end_m[m.tick + 1], m.part, to);
  };
  at(from_s, all.from);
  at(to_s, all.to);
  return all;
}

FrameLoad<Lanes<float>> FrontierDrive::load(double from_s, double to_s) const {
  FrameLoad<Lanes<float>> all;
  const auto at = [&](double time_s, Vec3<Lanes<float>>& constant, Mat3<Lanes<float>>& gradient) {
    const Moment m = moment(time_s, ticks());
    const FrontierFrame &a = frame[m.tick], &b = frame[m.tick + 1];
    mix(a.constant, b.constant, m.part, constant);
    mix(a.gradient.x, b.gradient.x, m.part, gradient.x);
    mix(a.gradient.y, b.gradient.y, m.part, gradient.y);
    mix(a.gradient.z, b.gradient.z, m.part, gradient.z);
  };
  at(from_s, all.constant_from, all.gradient_from);
  at(to_s, all.constant_to, all.gradient_to);
  return all;
}

std::vector<FrontierWalk> frontier_walks() {
  const auto body = [](float height_m, float mass_kg, Constitution constitution) {
    BodyRequest request;
    request.height_m = height_m;
    request.mass_kg = mass_kg;
    request.constitution = constitution;
    return request;
  };
  const BodyRequest bodies[] = {body(1.62F, 55, Constitution::average), body(1.70F, 62, Constitution::thin),
                                body(1.80F, 80, Constitution::average), body(1.75F, 88, Constitution::athletic),
                                body(1.90F, 110, Constitution::heavy)};
  std::vector<FrontierWalk> walks;
  for (const float speed : {1.4F, 0.9F, 2.0F}) {
    for (const BodyRequest& request : bodies) walks.push_back({request, speed});
  }
  walks.push_back({bodies[2], 1.2F});
  return walks;
}

std::vector<FrontierDrive> record_walks(std::span<const Muscle> muscles, std::span<const FrontierWalk> walks,
                                        double seconds) {
  if (walks.empty() || walks.size() > lane_count || muscles.empty()) {
    throw Stopped(fmt::format("frontier: {} walks of {} muscles; give 1 to {} walks of at least one muscle",
                              walks.size(), muscles.size(), lane_count));
  }
  if (!(seconds >= frontier_tick_s && seconds <= 3600)) {
    throw Stopped(fmt::format("frontier: {} s are to be compared; give {:.3g} to 3600 s", seconds, frontier_tick_s));
  }
  const auto ticks_of = [](double s) { return static_cast<std::size_t>(std::lround(s / frontier_tick_s)); };
  const std::size_t first = ticks_of(ramp_s + calm_s), ticks = first + ticks_of(seconds);
  std::vector<FrontierDrive> drives;
  for (const Muscle muscle : muscles) {
    drives.push_back({muscle, walks.size(), std::vector<MusclePlan>(lane_count), {}, {}, {}, first});
    drives.back().end_m.resize(ticks + 1);
    drives.back().frame.resize(ticks + 1);
  }
  for (std::size_t lane = 0; lane < walks.size(); ++lane) record(walks[lane], lane, drives);
  for (FrontierDrive& drive : drives) {
    for (std::size_t lane = walks.size(); lane < lane_count; ++lane) repeat(drive, lane % walks.size(), lane);
  }
  return drives;
}

HexahedralMesh frontier_mesh(Muscle muscle, const Cells& cells) {
  return must(bend_block(cells, muscle_lattice(muscle), reference_belly_m(muscle), belly_grading));
}

void set_modes(FrontierIndividual& own, std::shared_ptr<const ModalBasis> basis, const ModalBelly& belly,
               double damping_per_s) {
  own.motion.resize(modal_motion_width(basis->modes, basis->inputs));
  own.points.resize(modal_shape_width(basis->modes, basis->inputs));
  write_motion(belly, damping_per_s, frontier_tick_s, own.motion);
  write_shape(belly, damping_per_s, own.points);
  own.basis = std::move(basis);
}

std::vector<FrontierIndividual> frontier_individuals(const FrontierDrive& drive, const FrontierMethod& method,
                                                     bool loads, BellyLibrary& library) {
  LegMuscles choice = method.choice;
  choice.muscles.reset();
  choice.muscles.set(static_cast<std::size_t>(drive.muscle));
  choice.inertia = loads;
  std::vector<FrontierIndividual> all(lane_count);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    auto belly = library.belly(drive.plan[lane], choice, frontier_tick_s);
    if (!belly) throw Stopped(fmt::format("{}: {}", muscle_name(drive.muscle), belly.error().message));
    FrontierIndividual& own = all[lane];
    own.shape = belly->shape->shape;
    own.steps = belly->steps;
    own.solver = std::move(belly->solver);
    if (belly->basis != nullptr) set_modes(own, belly->basis, *belly->motions, choice.damping_per_s);
  }
  return all;
}

}  // namespace mobil
