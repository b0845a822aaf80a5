#include "demo/lab/compare/compare_muscles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <mobil/assets/files/csv_table.h>
#include <mobil/components/leg_muscles.h>
#include <mobil/engine/access.h>
#include <mobil/engine/geometry.h>
#include <mobil/systems/muscles/person.h>
#include "demo/lab/compare/compare_walk.h"
#include "demo/lab/compare/reference_tables.h"
#include "demo/program/must.h"

namespace mobil {
namespace {

using namespace geometry;

constexpr double muscle_tick_s = 1.0 / 120, emg_delay_s = 0.075;

// Bergmann et al. 2001 is a mean of four people. Patil et al. state the largest of all peaks at that speed.
constexpr ImplantPeak measured_peaks[] = {{at_hip, 1.11, 2.38, "Bergmann 2001"},
                                          {at_hip, 0.28, 2.80, "Bergmann 1993"},
                                          {at_hip, 1.39, 4.80, "Bergmann 1993"},
                                          {at_knee, NAN, 2.61, "Kutzner 2010"},
                                          {at_knee, 2.01, 5.10, "Patil 2013"}};

double to_value(float v) {
  return static_cast<double>(v);
}

/// A walker whose lines of action alone are simulated.
Entity moment_walker(Simulation& simulation, const BodyRequest& body, const GaitRequest& gait) {
  const Entity person = must(simulation.spawn(body, barefoot(body, gait)));
  LegMuscles choice;
  choice.method = Method::none;
  choice.muscles = muscle_members();
  choice.activation = ExcitationSource::moments;
  must(simulation.enable(person, Feature::forces));
  must(simulation.set_muscles(person, choice));
  return person;
}

std::array<float, leg_moment_count> moments_of(const LegMoments<float>& m) {
  return {m.hip, m.hip_abduction, m.hip_rotation, m.knee, m.ankle};
}

/// Returns the tension of each line of the right leg in this tick, N.
std::vector<double> tensions(const Simulation& simulation, Entity person) {
  const auto design = must(simulation.get<LegDesign>(person));
  const AskedForces& asked = *LookupPublished<AskedForces>(simulation.world()).find(person);
  std::vector<double> all;
  for (std::size_t i = 0; i < leg_member_count; ++i)
    all.push_back(to_value(asked.leg[Side::right].of_most[i] * design.member[i].force_n));
  return all;
}

/// Values of one quantity in the ticks of a stride.
using Values = std::vector<double>;

/// An instant whose acceleration is known one tick later.
struct Instant {
  Pose<float> pose;
  GroundReaction<float> ground;
  std::vector<double> tension_n;
  double phase;
};

CycleCurve delayed(const CycleCurve& curve, double by_cycles) {
  constexpr std::size_t count = cycle_points - 1;
  CycleCurve later{};
  for (std::size_t i = 0; i < cycle_points; ++i) {
    const double at = static_cast<double>(i) - by_cycles * count + count, whole = std::floor(at), part = at - whole;
    const auto k = static_cast<std::size_t>(whole);
    later[i] = (1 - part) * curve[k % count] + part * curve[(k + 1) % count];
  }
  return later;
}

double rms_of(const CycleCurve& curve) {
  return rms_distance(curve, CycleCurve{});
}

/// Returns the electromyograms of a table; those of columns with the suffix _sd have a deviation. `task` selects rows.
std::vector<Emg> read_emg(std::string_view file, std::string_view source, std::string_view task, double delay_cycles) {
  const auto found = std::ranges::find(reference_tables(), file, &ReferenceTable::name);
  const std::string_view required[] = {"percent_gait"};
  const CsvTable table = must(parse_csv(found->text, file, required));
  std::vector<Emg> all;
  for (const std::string& name : table.header) {
    const auto muscle = find_muscle(name == "biceps_femoris" ? "biceps_femoris_long_head" : name);
    if (!muscle) continue;
    Emg emg{std::string(source), *muscle, {}};
    std::size_t i = 0;
    for (std::size_t row = 0; row < table.row.size() && i < cycle_points; ++row) {
      if (!task.empty() && cell(table, row, "task") != task) continue;
      emg.curve.mean[i] = number(number_cell(table, row, name)).value();
      emg.curve.sd[i++] = number(number_cell(table, row, name + "_sd")).value_or(0);
    }
    emg.curve = {delayed(emg.curve.mean, delay_cycles), delayed(emg.curve.sd, delay_cycles)};
    all.push_back(std::move(emg));
  }
  return all;
}

}  // namespace

double MuscleStride::residual(std::size_t moment_number) const {
  return rms_of(left[moment_number]) / rms_of(moment[moment_number]);
}

double MuscleStride::peak(std::size_t joint) const {
  return std::ranges::max(contact[joint]);
}

MuscleStride walk_muscles(const BodyRequest& body, const GaitRequest& gait) {
  Simulation simulation(SimulationOptions{.tick_s = muscle_tick_s});
  const Entity entity = moment_walker(simulation, body, gait);
  const Person person = *simulation.person(entity);
  const double mass_kg = to_value(body.mass_kg), weight_n = mass_kg * gravity_m_s2;
  Values phase, contact_phase;
  std::array<Values, leg_moment_count> moment, left;
  std::array<Values, leg_joint_count> contact;
  std::map<Muscle, Values> activation;
  std::vector<Instant> last;
  over_steady_cycle(simulation, entity, [&](double now) {
    phase.push_back(now);
    const auto asked = must(simulation.get<JointMoments>(entity));
    const auto rest = moments_of(must(simulation.get<MomentReserve>(entity)).left_nm[Side::right]);
    const float all[] = {asked.hip_nm[Side::right], asked.hip_abduction_nm[Side::right],
                         asked.hip_rotation_nm[Side::right], asked.knee_nm[Side::right], asked.ankle_nm[Side::right]};
    for (std::size_t k = 0; k < leg_moment_count; ++k) {
      moment[k].push_back(to_value(all[k]) / mass_kg);
      left[k].push_back(to_value(rest[k]) / mass_kg);
    }
    for (const MuscleRef& own : simulation.muscles(entity))
      activation[own.muscle].push_back(to_value(must(simulation.get<Activation>(own.entity[Side::right])).excitation));
    last.push_back({must(simulation.get<Pose>(entity)), must(simulation.get<GroundReaction>(entity)),
                    tensions(simulation, entity), now});
    if (last.size() < 3) return;
    const Instant& middle = last[1];
    const JointForces whole =
        intersegmental_forces(person.body, {last[0].pose, middle.pose, last[2].pose}, middle.ground, muscle_tick_s);
    const JointForces through = contact_forces(person.body, middle.pose, whole, middle.tension_n);
    contact_phase.push_back(middle.phase);
    for (std::size_t j = 0; j < leg_joint_count; ++j) contact[j].push_back(length(through[j]) / weight_n);
    last.erase(last.begin());
  });
  MuscleStride stride{};
  stride.speed_m_s = to_value(person.gait.speed_m_s);
  stride.cycle_s = 2 / to_value(person.gait.step_frequency_hz);
  for (std::size_t k = 0; k < leg_moment_count; ++k) {
    stride.moment[k] = sample_cycle(phase, moment[k]);
    stride.left[k] = sample_cycle(phase, left[k]);
  }
  for (std::size_t j = 0; j < leg_joint_count; ++j) stride.contact[j] = sample_cycle(contact_phase, contact[j]);
  for (const auto& [muscle, values] : activation) stride.muscle.push_back({muscle, sample_cycle(phase, values)});
  return stride;
}

std::vector<Emg> delayed_emg(double cycle_s) {
  const double delay = emg_delay_s / cycle_s;
  std::vector<Emg> all = read_emg("santuz_emg.csv", "Santuz", "", delay);
  for (Emg& emg : read_emg("bovi2011_emg.csv", "Bovi 2011", "free", delay)) all.push_back(std::move(emg));
  return all;
}

double emg_correlation(const MuscleStride& stride, const Emg& emg) {
  return correlation(std::ranges::find(stride.muscle, emg.muscle, &MuscleCurve::muscle)->activation, emg.curve.mean);
}

std::span<const ImplantPeak> implant_peaks() {
  return measured_peaks;
}

const MuscleStride& MuscleComparison::at(float speed_m_s) const {
  return *std::ranges::min_element(
      strides, {}, [&](const MuscleStride& s) { return std::abs(s.speed_m_s - static_cast<double>(speed_m_s)); });
}

MuscleComparison compare_muscles(const BodyRequest& body, const GaitStyle& style) {
  MuscleComparison comparison;
  for (const float speed : muscle_speeds_m_s) {
    GaitRequest gait;
    gait.speed_m_s = pace_of(body) * speed;
    gait.style = style;
    comparison.strides.push_back(walk_muscles(body, gait));
  }
  comparison.emg = delayed_emg(comparison.at(emg_speed_m_s).cycle_s);
  return comparison;
}

}  // namespace mobil
