#include "demo/view/view_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <mobil/components/gait.h>
#include <mobil/forces.h>
#include <mobil/lod.h>
#include <mobil/muscle_table.h>
#include <mobil/step_report.h>
#include <mobil/systems/accuracy/accuracy_table.h>
#include <mobil/systems/accuracy/lod_table.h>

namespace mobil {
namespace {

constexpr float lane_apart_m = 1.1F, apart_m = 1.6F, street_m = 60;
constexpr std::uint64_t crowd_number = 1'000'000;  // the person's figures have smaller numbers

LegMuscles muscles_of(const ViewChoice& choice) {
  LegMuscles muscles;
  muscles.method = choice.method[0];
  muscles.modal.modes = choice.modes;
  muscles.modal.control_points = muscles.modal.reported = true;
  muscles.activation = choice.activation;
  muscles.inertia = choice.inertia;
  return muscles;
}

/// Returns the people of a street. All people of a lane walk in one direction at one speed, so that they never meet.
std::vector<SpawnRequest> street(std::size_t count) {
  std::mt19937 random(7);
  const auto next = [&] { return static_cast<float>(random() % 65536) / 65536; };
  const std::size_t lanes = std::max<std::size_t>(2, (count + 36) / static_cast<std::size_t>(street_m / apart_m));
  std::vector<SpawnRequest> people;
  for (std::size_t lane = 0; people.size() < count; ++lane) {
    const float side = lane % 2 == 0 ? 1 : -1;
    const float x = side * ((side > 0 ? 2.9F : 1.7F) + lane_apart_m * static_cast<float>(lane / 2));
    const float speed = 1 + 0.6F * next();
    const std::size_t left = count - people.size(),
                      here = lane + 1 < lanes ? (left + lanes - lane - 1) / (lanes - lane) : left;
    const float gap = std::max(apart_m, street_m / static_cast<float>(here));
    for (std::size_t i = 0; i < here; ++i) {
      SpawnRequest& one = people.emplace_back();
      one.body.height_m = 1.55F + 0.35F * next();
      one.body.mass_kg = one.body.height_m * one.body.height_m * (20 + 7 * next());
      one.gait.speed_m_s = speed;
      one.x_m = x;
      one.z_m = gap * (static_cast<float>(i) + 0.3F * next()) - street_m / 2;
      one.heading_rad = lane % 4 < 2 ? 0 : std::numbers::pi_v<float>;
    }
  }
  return people;
}

bool same_body(const BodyRequest& a, const BodyRequest& b) {
  return a.height_m == b.height_m && a.mass_kg == b.mass_kg && a.constitution == b.constitution && a.sex == b.sex;
}

bool same_gait(const GaitRequest& a, const GaitRequest& b) {
  return a.speed_m_s == b.speed_m_s && a.step_length_m == b.step_length_m &&
         a.step_frequency_hz == b.step_frequency_hz &&
         std::ranges::all_of(gait_parameters,
                             [&](const GaitParameter& p) { return a.style.*p.value == b.style.*p.value; });
}

template <std::size_t N>
void push(std::array<float, N>& trace, float value) {
  std::copy(trace.begin() + 1, trace.end(), trace.begin());
  trace.back() = value;
}

}  // namespace

bool same_choice(const ViewChoice& a, const ViewChoice& b) {
  return same_body(a.body, b.body) && same_gait(a.gait, b.gait) && a.method == b.method && a.modes == b.modes &&
         a.activation == b.activation && a.inertia == b.inertia && a.forces == b.forces && a.people == b.people &&
         a.choose == b.choose && a.tolerance_px == b.tolerance_px && a.budget_s == b.budget_s;
}

Result<ViewScene> ViewScene::make(const ViewChoice& choice) {
  ViewScene scene;
  auto person = scene.spawned(choice);
  if (!person) return tl::unexpected(person.error());
  scene.person_ = *person;
  scene.choice_ = choice;
  if (auto done = scene.set_crowd(choice.people); !done) return tl::unexpected(done.error());
  if (auto done = scene.set_choosing(choice); !done) return tl::unexpected(done.error());
  return scene;
}

Result<Entity> ViewScene::spawned(const ViewChoice& choice) const {
  SpawnRequest request{choice.body, choice.gait};
  request.muscles = muscles_of(choice);
  request.muscles->activation = ExcitationSource::none;  // until forces are enabled
  if (person_ != Entity{}) request.z_m = place().z;
  Entity person;
  if (auto done = simulation_->spawn({&request, 1}, {&person, 1}); !done) return tl::unexpected(done.error());
  const auto rest = [&]() -> Result<void> {
    if (choice.forces || choice.activation == ExcitationSource::moments) {
      if (auto done = simulation_->enable(person, Feature::forces); !done) return done;
    }
    if (choice.activation != ExcitationSource::none) {
      if (auto done = simulation_->set_muscles(person, muscles_of(choice)); !done) return done;
    }
    return set_methods(person, choice);
  }();
  if (!rest) {
    (void)simulation_->despawn(person);
    return tl::unexpected(rest.error());
  }
  return person;
}

Result<void> ViewScene::set_methods(Entity person, const ViewChoice& choice) const {
  for (std::size_t g = 0; g < view_groups; ++g) {
    MuscleMethod method{choice.method[g], muscles_of(choice).modal};
    if (same_method(simulation_->method(person, static_cast<Muscle>(g)), method)) continue;
    if (auto done = simulation_->set_method(person, static_cast<Muscle>(g), method); !done) return done;
  }
  return {};
}

Result<void> ViewScene::set_crowd(std::size_t people) {
  const std::vector<SpawnRequest> asked = street(people);
  std::vector<Entity> come(people);
  if (auto done = simulation_->spawn(asked, come); !done) return done;
  (void)simulation_->despawn(crowd_);  // they exist
  crowd_ = std::move(come);
  lane_m_.clear();
  drawn_.assign(1, {person_, number_, true});
  for (std::size_t i = 0; i < crowd_.size(); ++i) {
    lane_m_.push_back(asked[i].x_m);
    drawn_.push_back({crowd_[i], crowd_number + i, false});
  }
  if (choosing_) {
    if (auto done = simulation_->lod().manage(crowd_); !done) return done;
  }
  return {};
}

void ViewScene::stop_choosing() {
  if (!choosing_) return;
  for (const Entity entity : crowd_) {
    (void)simulation_->lod().release(entity);
    (void)simulation_->set_muscles(entity, std::nullopt);
  }
  (void)simulation_->lod().release(person_);
  choosing_ = false;
  chosen_.reset();
}

Result<void> ViewScene::set_choosing(const ViewChoice& choice) {
  if (!choice.choose) {
    stop_choosing();
    return set_methods(person_, choice);
  }
  if (!choosing_) {
    LodOptions options;
    options.leg_muscles = muscles_of(choice);
    if (auto done = simulation_->lod().set_options(options); !done) return done;
    choosing_ = true;
    if (auto done = simulation_->lod().manage(person_); !done) return done;
    if (auto done = simulation_->lod().manage(crowd_); !done) return done;
  }
  return {};
}

Result<void> ViewScene::set(const ViewChoice& choice) {
  const bool anew = !same_body(choice.body, choice_.body) || choice.activation != choice_.activation ||
                    choice.inertia != choice_.inertia;
  if (anew) {
    auto person = spawned(choice);
    if (!person) return tl::unexpected(person.error());
    stop_choosing();
    (void)simulation_->despawn(person_);
    gone_ = number_++;
    person_ = *person;
    drawn_[0] = {person_, number_, true};
    trace_ = {};
  } else {
    if (!same_gait(choice.gait, choice_.gait)) {
      if (auto done = simulation_->set_gait(person_, choice.gait); !done) return done;
    }
    if (choice.forces != choice_.forces && choice.activation != ExcitationSource::moments) {
      auto done = simulation_->enable(person_, Feature::forces, choice.forces);
      if (!done) return done;
    }
  }
  if (choice.people != choice_.people) {
    if (auto done = set_crowd(choice.people); !done) return done;
  }
  choice_ = choice;
  return set_choosing(choice);
}

Result<void> ViewScene::look(const Camera& camera, int width, int height) {
  const Vec3<float> to = {camera.target.x - camera.eye.x, camera.target.y - camera.eye.y,
                          camera.target.z - camera.eye.z};
  const float high = std::tan(camera.vertical_fov_deg * std::numbers::pi_v<float> / 360);
  LodScene needs;
  needs.tolerance_px = choice_.tolerance_px;
  needs.camera = Viewpoint{camera.eye,
                           to,
                           std::atan(high * std::hypot(1.0F, static_cast<float>(width) / static_cast<float>(height))),
                           2 * std::atan(high) / static_cast<float>(height),
                           3,
                           street_m};
  needs.compact_unseen = true;
  if (choice_.budget_s > 0) needs.budget_s = choice_.budget_s;
  return simulation_->lod().set_scene(needs);
}

void ViewScene::tick(const Camera& camera, int width, int height) {
  if (choosing_) (void)look(camera, width, height);
  simulation_->tick();
  if (choosing_) chosen_ = simulation_->lod().report();
  sample();
  if (simulation_->ticks() % 60 == 0) keep_near();  // not each tick: poses of compact people are computed on request
}

Vec3<float> ViewScene::place() const {
  const auto pose = simulation_->get<Pose>(person_);
  return pose ? pose->position_m[0] : Vec3<float>{0, 0, 0};
}

ViewMethod ViewScene::method(std::size_t group) const {
  static const LodTable lod_table(accuracy_table());
  ViewMethod is{simulation_->method(person_, static_cast<Muscle>(group)), 0, 0};
  const auto size = simulation_->get<BodySize>(person_);
  const auto gait = simulation_->get<Gait>(person_);
  if (!size || !gait) return is;
  const bool active = choice_.activation != ExcitationSource::none;
  const LevelCase of{static_cast<std::uint32_t>(group), LodTable::speed_step(gait->speed_m_s, size->leg_scale_m),
                     choice_.inertia, true, active};
  for (std::uint32_t level = 0; level < level_count; ++level) {
    const LodLevel& way = levels_of(active)[level];
    if (way.method != is.method.method) continue;
    if (way.method == Method::modal && (way.modes != is.method.modal.modes || way.moving != is.method.modal.moving))
      continue;
    is.error_m = lod_table.error_m(of, level, size->leg_scale_m);
    is.cost_us = lod_table.cost_us(of, level);
    break;
  }
  return is;
}

void ViewScene::sample() {
  constexpr float degrees = 180 / std::numbers::pi_v<float>;
  if (const auto joints = simulation_->get<JointAngles>(person_)) {
    push(trace_.hip_deg, degrees * joints->hip_flexion[Side::right]);
    push(trace_.knee_deg, degrees * joints->knee_flexion[Side::right]);
    push(trace_.ankle_deg, degrees * joints->ankle_dorsiflexion[Side::right]);
  }
  const auto ground = simulation_->get<GroundReaction>(person_);
  const float weight_n = choice_.body.mass_kg * 9.81F;
  push(trace_.right_load, ground ? ground->force_n[Side::right].y / weight_n : 0);
  push(trace_.left_load, ground ? ground->force_n[Side::left].y / weight_n : 0);
  for (std::size_t g = 0; g < view_groups; ++g) {
    const Entity muscle = simulation_->muscle(person_, static_cast<Muscle>(g), Side::right);
    const auto line = simulation_->get<LineOfAction>(muscle);
    push(trace_.elongation_mm[g], line ? 1000 * (line->length_m - line->rest_length_m) : 0);
  }
}

/// Moves people who are too far behind or ahead to the other end of the street.
void ViewScene::keep_near() {
  const float z = place().z;
  for (std::size_t i = 0; i < crowd_.size(); ++i) {
    const auto pose = simulation_->get<Pose>(crowd_[i]);
    if (!pose) continue;
    const float off = pose->position_m[0].z - z;
    if (std::abs(off) < 0.6F * street_m) continue;
    const auto state = simulation_->get<GaitState>(crowd_[i]);
    (void)simulation_->place(crowd_[i], lane_m_[i], pose->position_m[0].z - std::copysign(1.2F * street_m, off),
                             state->heading_rad);
  }
}

}  // namespace mobil
