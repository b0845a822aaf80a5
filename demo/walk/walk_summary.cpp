#include "demo/walk/walk_summary.h"

#include <fmt/format.h>

#include <mobil/body_composition.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/schedule.h>
#include <mobil/systems/muscles/muscle_step.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "demo/program/json.h"

namespace mobil {
namespace {

/// Returns the shortest decimal that reads as this number, 0.1 instead of 0.10000000149.
double decimal(float value) {
  return std::stod(fmt::format("{}", value));
}

Json muscles_json(const Simulation& simulation, const Person& person) {
  Json muscles = Json::array();
  for (const PersonMuscle& own : person.muscles) {
    for (const Side side : {Side::right, Side::left}) {
      const Entity entity = own.entity[side];
      const auto line = simulation.get<LineOfAction>(entity);
      if (!line) continue;
      const Method method = own.method.method;
      const bool stepped = method == Method::explicit_central || method == Method::implicit_central ||
                           method == Method::newmark || method == Method::finite;
      const bool limited = stepped && method != Method::newmark;
      const World& world = simulation.world();
      const std::uint64_t steps = world.get<Substeps>(entity).value_or(
          world.get<SolvedSteps>(entity).value_or(world.get<FiniteSteps>(entity).value_or(1)));
      const double critical = limited ? critical_step_s(world, entity, own.plan.scale).value_or(0.0) : 0.0;
      const MusclePlan& plan = own.plan;
      muscles.push_back({{"group", muscle_name(plan.muscle)},
                         {"side", side == Side::right ? "right" : "left"},
                         {"method", method_name[static_cast<std::size_t>(method)]},
                         {"nodes", nodal_displacement(simulation.world(), entity).nodes},
                         {"modes", method == Method::modal ? Json(own.method.modal.modes) : Json()},
                         {"rest_length_m", line->rest_length_m},
                         {"belly_length_m", plan.belly_length_m},
                         {"section_m2", plan.section_m2},
                         {"stiffness_n_per_m", line->stiffness_n_per_m},
                         {"dt_s", stepped ? Json(simulation.tick_s() / static_cast<double>(steps)) : Json()},
                         {"critical_dt_s", limited ? Json(critical) : Json()},
                         {"substeps_per_tick", stepped ? Json(steps) : Json()}});
    }
  }
  return muscles;
}

}  // namespace

std::string summary_json(const WalkOptions& options, const Simulation& simulation, const Person& person,
                         const WalkOutcome& outcome, const std::vector<MuscleFidelity>& exported) {
  const BodyRequest& body = person.body.request;
  Json summary;
  summary["body"] = {{"height_m", decimal(body.height_m)},
                     {"mass_kg", decimal(body.mass_kg)},
                     {"biotype", {decimal(body.biotype.endo), decimal(body.biotype.meso), decimal(body.biotype.ecto)}},
                     {"constitution", constitution_name[static_cast<std::size_t>(body.constitution)]},
                     {"sex", sex_name[static_cast<std::size_t>(body.sex)]},
                     {"age_y", decimal(body.age_y)},
                     {"hip_height_m", decimal(person.body.hip_height_m)},
                     {"notes", body_notes(person.body)}};
  Json parameters = Json::object();
  for (const GaitParameter& p : gait_parameters) parameters[std::string(p.name)] = decimal(outcome.gait.style.*p.value);
  Json changes = Json::array();
  for (const StyleChange& change : outcome.style_changes) {
    const bool in_table = change.parameter < gait_parameters.size();
    changes.push_back({{"parameter", in_table ? gait_parameters[change.parameter].name : "step_length_m"},
                       {"asked", decimal(change.asked)},
                       {"walked", decimal(change.walked)},
                       {"why", described(change)}});
  }
  Json passed = Json::array();
  for (const LimitPassed& limit : outcome.limits_passed)
    passed.push_back({{"limit", described(limit.furthest)},
                      {"first_s", limit.first_s},
                      {"last_s", limit.last_s},
                      {"ticks", limit.ticks}});
  summary["gait"] = {{"speed_m_s", decimal(outcome.gait.speed_m_s)},
                     {"step_length_m", decimal(outcome.gait.step_length_m)},
                     {"clamped_steps", outcome.clamped_steps},
                     {"step_frequency_hz", decimal(outcome.gait.step_frequency_hz)},
                     {"double_support_cycle", decimal(outcome.gait.double_support_cycle)},
                     {"parameters", parameters},
                     {"style_changes", changes},
                     {"limits_passed", passed}};
  if (options.script) summary["script"] = {{"file", options.script->path}, {"changes", outcome.changes}};
  summary["drive"] = options.muscles.drive == Drive::force ? "force" : "displacement";
  summary["method"] = method_name[static_cast<std::size_t>(options.muscles.method)];
  summary["element"] = element_name[static_cast<std::size_t>(options.muscles.element)];
  summary["inertia"] = options.muscles.inertia;
  summary["fat"] = options.fat;
  summary["contact"] = options.contact;
  summary["anatomy"] = options.anatomy ? Json(options.anatomy->string()) : Json("built-in");
  if (options.anatomy) summary["anatomy_said"] = outcome.anatomy_said;

  const double simulated = outcome.simulated_s;
  const double ticks = outcome.ticks;
  Json stages = Json::object(), cost = Json::array();
  const auto systems = simulation.schedule().systems();
  const auto& timings = outcome.stages;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const bool ran = timings[i].seconds > 0;
    stages[systems[i].name] = {{"us_per_tick", 1e6 * timings[i].seconds / ticks},
                               {"times_faster_than_real_time", ran ? Json(simulated / timings[i].seconds) : Json()}};
    cost.push_back({{"name", systems[i].name},
                    {"ms_per_tick", 1e3 * timings[i].seconds / ticks},
                    {"entities", static_cast<double>(timings[i].rows) / ticks}});
  }
  summary["time"] = {{"simulated_s", simulated},
                     {"ticks", outcome.ticks},
                     {"tick_s", simulation.tick_s()},
                     {"simulation_wall_s", outcome.simulation_s},
                     {"us_per_tick", 1e6 * outcome.simulation_s / ticks},
                     {"times_faster_than_real_time", simulated / outcome.simulation_s},
                     {"command_wall_s", outcome.wall_s},
                     {"stages", stages}};
  summary["systems"] = cost;
  summary["muscles"] = muscles_json(simulation, person);
  Json glb = Json::array();
  for (const auto& muscle : exported) {
    glb.push_back({{"name", muscle.name},
                   {"morph_targets", muscle.morph_targets},
                   {"max_error_m", muscle.max_error_m},
                   {"rms_error_m", muscle.rms_error_m}});
  }
  summary["glb"] = glb;
  return summary.dump(2) + "\n";
}

}  // namespace mobil
