// NaN, too large and too small numbers in one lane of a block, and the effect on its fifteen neighbours.

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <limits>
#include <utility>

#include <mobil/engine/jobs.h>
#include "demo/lab/robustness/robustness_bellies.h"

namespace mobil {
namespace {

constexpr std::array<Method, 4> methods = {Method::explicit_central, Method::implicit_central, Method::newmark,
                                           Method::statics};

std::string_view name(Method method) {
  return method_name[static_cast<std::size_t>(method)];
}

/// All inputs of a block.
struct Inputs {
  Bellies bellies;
  EndDrive<Lanes<float>> end{};
  EndTraction<Lanes<float>> traction{};
  std::uint32_t substeps = 1;

  FarFaceDrive drive() const {
    const FarEnd way = bellies.muscle.options.far_end;
    return way == FarEnd::free ? FarFaceDrive(traction) : FarFaceDrive(way, end);
  }

  void tick() { bellies.tick(drive(), substeps, static_cast<float>(robustness_tick_s)); }

  /// Returns every word that one lane reads.
  std::vector<Lanes<float>*> words() {
    std::vector<Lanes<float>*> all = {&bellies.scale.across, &bellies.scale.along};
    const auto add = [&](Vec3<Lanes<float>>& v) { all.insert(all.end(), {&v.x, &v.y, &v.z}); };
    if (bellies.muscle.options.far_end == FarEnd::free) {
      add(traction.from_n);
      add(traction.to_n);
    } else {
      all.insert(all.end(), {&end.from, &end.to});
    }
    add(bellies.frame->constant_from);
    add(bellies.frame->constant_to);
    for (Mat3<Lanes<float>>* m : {&bellies.frame->gradient_from, &bellies.frame->gradient_to}) {
      add(m->x);
      add(m->y);
      add(m->z);
    }
    const std::size_t middle = bellies.displacement.size() / 2;
    all.insert(all.end(), {&bellies.displacement[middle], &bellies.displacement.back(), &bellies.velocity[middle],
                           &bellies.velocity.back()});
    return all;
  }
};

Inputs make_inputs(Method method, FarEnd end, const Cells& cells, double damping_per_s, double foundation_hz) {
  MuscleOptions options{end, damping_per_s, 0.5, 2};
  options.mass = method == Method::implicit_central ? Mass::consistent : Mass::lumped;
  options.foundation_hz = foundation_hz;
  auto made = must(make_muscle_template(spindle(cells), Material{}, options));
  Inputs inputs{Bellies(std::move(made))};
  Bellies& bellies = inputs.bellies;
  make_sixteen_sizes(bellies);
  shake(bellies, 1e-3F);
  const auto substeps = substeps_of(bellies, robustness_tick_s);
  inputs.substeps = method == Method::statics ? 1 : substeps;
  if (method != Method::explicit_central) bellies.solve_by(method, options.mass, robustness_tick_s / inputs.substeps);
  bellies.frame.emplace();
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto part = static_cast<float>(l) / lane_count;
    bellies.frame->constant_from.y[l] = bellies.frame->constant_to.y[l] = -9.81F;
    bellies.frame->gradient_from.x.z[l] = bellies.frame->gradient_to.z.x[l] = 20 * part;
    inputs.end.to[l] = (inputs.bellies.muscle.options.far_end == FarEnd::held ? 0.01F : 0.3F) * part;
    inputs.traction.to_n.z[l] = 0.3F * part;
  }
  return inputs;
}

std::size_t different_reports(const BellyReport<Lanes<float>>& a, const BellyReport<Lanes<float>>& b,
                              std::size_t but_lane) {
  std::size_t different = 0;
  for (Lanes<float> BellyReport<Lanes<float>>::*field :
       {&BellyReport<Lanes<float>>::elongation_m, &BellyReport<Lanes<float>>::reaction_n,
        &BellyReport<Lanes<float>>::volume_ratio, &BellyReport<Lanes<float>>::kinetic_energy_j,
        &BellyReport<Lanes<float>>::strain_energy_j})
    different += different_lanes(a.*field, b.*field, but_lane);
  return different;
}

std::size_t subnormals(const Bellies& bellies) {
  std::size_t count = 0;
  for (const auto* column : {&bellies.displacement, &bellies.velocity}) {
    for (const auto& lanes : *column) {
      count += static_cast<std::size_t>(
          std::ranges::count_if(lanes.lane, [](float x) { return std::fpclassify(x) == FP_SUBNORMAL; }));
    }
  }
  return count;
}

double largest_difference(const Bellies& a, const Bellies& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.displacement.size(); ++i) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double difference =
          std::fabs(static_cast<double>(a.displacement[i][l]) - static_cast<double>(b.displacement[i][l]));
      if (!(difference <= largest)) largest = difference;
    }
  }
  return largest;
}

}  // namespace

void robustness_nan(RobustnessRun& run) {
  constexpr std::array<float, 3> bad = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                                        -std::numeric_limits<float>::infinity()};
  double part = 0;
  for (const Method method : methods) {
    std::size_t tried = 0, sick = 0, different = 0, compared = 0;
    for (const FarEnd end : {FarEnd::held, FarEnd::sliding, FarEnd::free}) {
      auto clean = make_inputs(method, end, {2, 2, 4}, 8, 7);
      clean.tick();
      const Inputs start = clean;
      clean.tick();
      clean.tick();
      const std::size_t count = clean.words().size();
      for (std::size_t word = 0; word < count; ++word) {
        for (const float value : bad) {
          const std::size_t lane = 7 * ++tried % lane_count;
          Inputs poisoned = start;
          poisoned.words()[word]->lane[lane] = value;
          poisoned.tick();
          poisoned.tick();
          different += different_words(clean.bellies, poisoned.bellies, lane) +
                       different_reports(clean.bellies.report, poisoned.bellies.report, lane);
          compared += (lane_count - 1) * (2 * clean.bellies.displacement.size() + 5);
          if (!poisoned.bellies.finite(lane)) ++sick;
        }
      }
      run.progress(++part / 12);
    }
    run.at_most(fmt::format("not-a-number, infinity or minus infinity in one lane of every input of a block by {}: "
                            "scales, far face, frame, displacement, velocity; three kinds of far face",
                            name(method)),
                "words of the fifteen neighbours that are not the same bits", 0, static_cast<double>(different),
                "lanes never meet",
                fmt::format("of {}, in {} cases; {} of the sick lanes ended without a number", compared, tried, sick));
  }
}

void robustness_explosion(RobustnessRun& run) {
  constexpr std::size_t sick = 6;
  for (const Method method : methods) {
    auto sound = make_inputs(method, FarEnd::free, {2, 2, 8}, 0, 7);
    Inputs exploding = sound;
    std::string how = "at a tenth of its size, its step three and more times too long";
    if (method == Method::explicit_central || method == Method::implicit_central) {
      exploding.bellies.scale.across[sick] = exploding.bellies.scale.along[sick] = 0.1F;
    } else {
      how = "pulled with 1e38 N";
      exploding.traction.from_n.z[sick] = exploding.traction.to_n.z[sick] = 1e38F;
    }
    std::size_t different = 0;
    double reach = 0;
    const int ticks = run.quick ? 30 : 300;
    for (int tick = 0; tick < ticks; ++tick) {
      sound.tick();
      exploding.tick();
      different += different_words(sound.bellies, exploding.bellies, sick) +
                   different_reports(sound.bellies.report, exploding.bellies.report, sick);
      const double far = exploding.bellies.reach_m(sick);
      if (!(far <= reach)) reach = far;
    }
    const std::string tried = fmt::format("one lane by {} {}, {} ticks", name(method), how, ticks);
    run.at_most(tried, "words of the fifteen neighbours that are not the same bits, over all ticks", 0,
                static_cast<double>(different), "lanes never meet");
    run.at_least(tried, "how far it flew, m", 1e6, std::isnan(reach) ? std::numeric_limits<double>::infinity() : reach,
                 "else nothing was tried; no number counts as infinitely far");
  }
}

void robustness_denormals(RobustnessRun& run) {
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark}) {
    auto flushed = make_inputs(method, FarEnd::held, {2, 2, 4}, 40, 0);
    flushed.bellies.frame.reset();
    flushed.end = {};
    Inputs plain = flushed;
    std::size_t with = 0, without = 0;
    double apart = 0;
    int ticks_with_subnormals = 0;
    constexpr int ticks = 720;  // twelve seconds: the slowest part of the ring is divided by e^100 or more
    for (int tick = 0; tick < ticks; ++tick) {
      {
        const FloatMode mode;
        flushed.tick();
      }
      plain.tick();
      with += subnormals(flushed.bellies);
      const std::size_t now = subnormals(plain.bellies);
      without += now;
      if (now > 0) ++ticks_with_subnormals;
      const double difference = largest_difference(flushed.bellies, plain.bellies);
      if (!(difference <= apart)) apart = difference;
    }
    const std::string tried = fmt::format(
        "a ring by {} that dies away within {} ticks, as systems run it and without that", name(method), ticks);
    run.at_most(tried, "subnormal numbers left by the ticks as systems run them", 0, static_cast<double>(with),
                "systems take them for zero, so that no tick takes a hundred times as long");
    // squares of conjugate gradients must not underflow: they ignore forces below some 1e-19 N
    const bool solves = method == Method::newmark;
    if (!solves) {
      run.at_least(tried, "subnormal numbers left without that", 1, static_cast<double>(without),
                   "else nothing was tried", fmt::format("in {} ticks", ticks_with_subnormals));
    }
    run.at_most(
        tried, "largest difference between the two motions, m", solves ? 1e-16 : 1e-34, apart,
        solves ? "its conjugate gradients square the forces, take those below some 1e-19 N for none and leave what "
                 "they would move"
               : "what is taken for zero is below 1.2e-38, and a motion is a sum of some thousand of such");
  }
}

}  // namespace mobil
