// Bad elements: accepted ones still work, refused ones are named.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "demo/lab/robustness/robustness_bellies.h"

namespace mobil {
namespace {

/// Moves a random node until the worst element has about this scaled Jacobian.
HexahedralMesh sliver(std::mt19937& random, double quality) {
  const Cells cells = {2, 2, 4};
  const HexahedralMesh block = make_block(cells, 0.015).value();
  const auto node = static_cast<std::size_t>(uniform(random, 0, 0.999) * static_cast<double>(block.node.size()));
  const Vec3<double> way = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
  const auto moved = [&](double by) {
    HexahedralMesh mesh = block;
    auto& p = mesh.node[node];
    p = {p.x + by * way.x, p.y + by * way.y, p.z + by * way.z};
    return mesh;
  };
  double low = 0, high = 0.2;  // beyond any node's neighbours, in any direction
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (smallest_scaled_jacobian(moved(middle)) > quality ? low : high) = middle;
  }
  return moved(low);
}

/// Returns the force that a uniform strain leaves on interior nodes, over the largest force of one node's row. By
/// equilibrium it is 0, regardless of the elements' shape (the patch test).
double patch_residual(const HexahedralMesh& mesh, const StiffnessTerms& terms) {
  const auto strained = [](const Vec3<double>& p) {
    return std::array{0.01 * p.x + 0.003 * p.y, 0.002 * p.x - 0.02 * p.y + 0.005 * p.z, 0.004 * p.y + 0.03 * p.z};
  };
  const Cells& cells = mesh.cells;
  double worst = 0;
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const bool inside = i > 0 && i < cells[0] && j > 0 && j < cells[1] && k > 0 && k < cells[2];
    if (!inside) return;
    std::array<double, 3> force{}, size{};
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const auto b = stiffness_block(terms.pair[node_index(cells, i, j, k) * stencil_size + slot], 1, 1);
      const auto u = strained(mesh.node[m]);
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          force[r] += b[3 * r + c] * u[c];
          size[r] += std::fabs(b[3 * r + c] * u[c]);
        }
      }
    });
    for (std::size_t r = 0; r < 3; ++r) {
      const double part = std::fabs(force[r]) / size[r];
      keep_worst(worst, part);
    }
  });
  return worst;
}

struct MeshFigures {
  WorstProbe probe;
  double patch = 0;       // worst patch residual
  double lane_drift = 0;  // worst relative change of a lane's energy
  double min_step_s = 1e300, min_quality = 1;
  std::size_t refused = 0;

  void take(const HexahedralMesh& mesh, Element element, FarEnd end, std::uint32_t steps) {
    const auto terms = assemble(mesh, Material{}, element);
    if (!terms) {
      ++refused;  // inverted inside, between sound corners
      if (terms.error().message.starts_with("element ")) return;
      throw Stopped(terms.error().message);
    }
    min_quality = std::min(min_quality, smallest_scaled_jacobian(mesh));
    const double residual = patch_residual(mesh, *terms);
    if (!(residual <= patch)) patch = residual;
    const auto tried = probe_limit(mesh, *terms, {.method = Method::explicit_central, .end = end}, steps);
    probe.take(tried);
    min_step_s = std::min(min_step_s, tried.limit_s);

    MuscleOptions options{end, 0, 0.7, 1.5};
    options.element = element;
    Bellies bellies(must(make_muscle_template(mesh, Material{}, options)));
    make_sixteen_sizes(bellies);
    shake(bellies, 1e-3F);
    double limit = 1e300;
    for (std::size_t l = 0; l < lane_count; ++l) {
      limit = std::min(limit, critical_step(bellies.muscle.critical_steps, static_cast<double>(bellies.scale.across[l]),
                                            static_cast<double>(bellies.scale.along[l]))
                                  .value());
    }
    const EndTraction<Lanes<float>> slack{};
    const EndDrive<Lanes<float>> still{};
    const FarFaceDrive drive = end == FarEnd::free ? FarFaceDrive(slack) : FarFaceDrive(end, still);
    const auto tick = static_cast<float>(0.9 * limit * steps);
    bellies.tick(drive, 1, tick / static_cast<float>(steps));
    std::array<double, lane_count> first{};
    for (std::size_t l = 0; l < lane_count; ++l) first[l] = bellies.energy_j(l);
    bellies.tick(drive, steps, tick);
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double change = std::fabs(bellies.energy_j(l) / first[l] - 1);
      if (!(change <= lane_drift)) lane_drift = change;
    }
  }
};

void tell(RobustnessRun& run, const std::string& tried, const MeshFigures& f) {
  const std::string figures =
      fmt::format("least scaled Jacobian {:.2g}, least critical step {:.2g} s{}", f.min_quality, f.min_step_s,
                  f.refused > 0 ? fmt::format(", {} refused by name", f.refused) : "");
  run.at_most(tried, "force left inside by a uniform strain, of the forces that cancel", 1e-11, f.patch,
              "patch test, all three elements; in double rounding grows with 1/Jacobian", figures);
  add_rows(run, tried, f.probe);
  run.at_most(tried + ", sixteen sizes in lanes at 0.9 of it", "change of energy in parts of itself", 1e-4,
              f.lane_drift, "conserved; single precision, ten times what was measured");
}

HexahedralMesh stretched(double aspect) {
  HexahedralMesh mesh = make_block({2, 2, 8}, 0.01).value();
  for (auto& p : mesh.node) p.z *= aspect;
  return mesh;
}

/// Relative errors of static lanes, all identical, after some ticks under one load.
struct StaticError {
  double pulled;  // elongation against F·L/(E·A), which is exact for every element where ν = 0
  double bent;    // the tip's sideways displacement against double precision
};

StaticError static_error(double aspect, Element element) {
  MuscleOptions options{FarEnd::free, 0, 1, 1};
  options.element = element;
  const Material material{1000, 10000, 0};
  const HexahedralMesh mesh = stretched(aspect);
  Bellies bellies(must(make_muscle_template(mesh, material, options)));
  bellies.stiffness = Stiffness::shared;
  bellies.solve_by(Method::statics, Mass::lumped, 1);
  constexpr float load_n = 0.1F;
  EndTraction<Lanes<float>> pull{}, bend{};
  for (std::size_t l = 0; l < lane_count; ++l) pull.to_n.z[l] = bend.to_n.x[l] = load_n;
  constexpr int ticks = 20;
  for (int tick = 0; tick < ticks; ++tick) bellies.tick(pull, 1, 1);
  const auto load = static_cast<double>(load_n);
  const double exact = load * 0.08 * aspect / (material.young_pa * 0.02 * 0.02);
  StaticError error{std::fabs(static_cast<double>(bellies.report.elongation_m[5]) / exact - 1), 0};
  for (int tick = 0; tick < ticks; ++tick) bellies.tick(bend, 1, 1);
  auto reference =
      must(ReferenceBelly::make(mesh, bellies.muscle.terms, {.method = Method::statics, .end = FarEnd::free}));
  reference.start({{load, 0, 0}, {}, {}});
  const std::size_t tip = 3 * std::size_t{insertion_centre(mesh.cells).front()};
  error.bent = std::fabs(static_cast<double>(bellies.displacement[tip][5]) / reference.displacement()[tip] - 1);
  return error;
}

/// Returns the elements with a corner whose three edges are left-handed or flat, computed from the node numbers alone.
std::vector<std::uint32_t> folded(const HexahedralMesh& mesh) {
  std::vector<std::uint32_t> found;
  const std::uint32_t nx = mesh.cells[0], ny = mesh.cells[1], nz = mesh.cells[2];
  for (std::uint32_t e = 0; e < nx * ny * nz; ++e) {
    const std::uint32_t i = e % nx, j = e / nx % ny, k = e / nx / ny;
    bool bad = false;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      const std::uint32_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
      const auto at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return mesh.node[((k + z) * (ny + 1) + j + y) * (nx + 1) + i + x];
      };
      const auto edge = [](const Vec3<double>& to, const Vec3<double>& from) {
        return std::array{to.x - from.x, to.y - from.y, to.z - from.z};
      };
      const auto u = edge(at(1, b, c), at(0, b, c)), v = edge(at(a, 1, c), at(a, 0, c)),
                 w = edge(at(a, b, 1), at(a, b, 0));
      const double volume =
          u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
      if (!(volume > 0)) bad = true;
    }
    if (bad) found.push_back(e);
  }
  return found;
}

}  // namespace

void robustness_slivers(RobustnessRun& run) {
  std::mt19937 random(20250607);
  MeshFigures figures;
  const int count = run.quick ? 3 : 20;
  for (int i = 0; i < count; ++i) {
    const double quality = std::pow(10, uniform(random, -2.98, -1.5));
    const HexahedralMesh mesh = sliver(random, quality);
    for (const Element element : all_elements) {
      const FarEnd end = i % 2 == 0 ? FarEnd::free : FarEnd::held;
      figures.take(mesh, element, end, run.quick ? 500 : 3000);
    }
    run.progress((i + 1.0) / count);
  }
  tell(run, fmt::format("{} blocks, a node moved until an element all but folds", count), figures);
}

void robustness_aspect(RobustnessRun& run) {
  MeshFigures figures;
  double pulled = 0, bent = 0;
  const std::vector<double> aspects =
      run.quick ? std::vector{0.01, 100.0} : std::vector{0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0};
  double done_part = 0;
  for (const double aspect : aspects) {
    for (const Element element : all_elements) {
      figures.take(stretched(aspect), element, FarEnd::free, run.quick ? 500 : 3000);
      const auto error = static_error(aspect, element);
      if (!(error.pulled <= pulled)) pulled = error.pulled;
      if (!(error.bent <= bent)) bent = error.bent;
    }
    run.progress(++done_part / static_cast<double>(aspects.size()));
  }
  const std::string tried = "2x2x8 blocks of elements 100 times wider than long to 100 times longer than wide";
  tell(run, tried, figures);
  run.at_most(tried + ", pulled in static lanes at a Poisson's ratio of 0, twenty ticks",
              "elongation against F L / (E A), relative", 1e-5, pulled,
              "exact for all three elements; single precision, ten times what was measured");
  run.at_most(tried + ", bent in static lanes, twenty ticks",
              "the tip's displacement against double precision, relative", 1e-4, bent,
              "the factor is made in double; single precision, ten times what was measured");
}

void robustness_inverted(RobustnessRun& run) {
  const HexahedralMesh sound = spindle({3, 2, 5});
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  std::size_t tried = 0, named = 0;
  std::string example, missed;
  const auto take = [&](const HexahedralMesh& mesh, const std::vector<std::uint32_t>& guilty) {
    ++tried;
    const auto refused = assemble(mesh, Material{});
    const auto tells = [&](std::uint32_t e) {
      return refused.error().message.find(element_label(mesh.cells, e)) != std::string::npos;
    };
    if (!refused && std::ranges::any_of(guilty, tells)) {
      ++named;
      example = refused.error().message;
    } else {
      missed = refused ? "accepted" : refused.error().message;
    }
  };
  for (std::size_t n = 0; n < sound.node.size(); ++n) {
    const auto [nx, ny, nz] = sound.cells;
    const std::size_t i = n % (nx + 1), j = n / (nx + 1) % (ny + 1), k = n / (nx + 1) / (ny + 1);
    HexahedralMesh through = sound;  // past its neighbour
    const std::size_t step = i > 0 ? n - 1 : n + 1;
    const auto &from = sound.node[n], &to = sound.node[step];
    through.node[n] = {from.x + 1.7 * (to.x - from.x), from.y + 1.7 * (to.y - from.y), from.z + 1.7 * (to.z - from.z)};
    take(through, folded(through));
    std::vector<std::uint32_t> touching;
    for (std::uint32_t e = 0; e < element_count(sound.cells); ++e) {
      const std::size_t ei = e % nx, ej = e / nx % ny, ek = e / nx / ny;
      if ((i == ei || i == ei + 1) && (j == ej || j == ej + 1) && (k == ek || k == ek + 1)) touching.push_back(e);
    }
    for (const double value : bad) {
      for (double Vec3<double>::*axis : {&Vec3<double>::x, &Vec3<double>::y, &Vec3<double>::z}) {
        HexahedralMesh mesh = sound;
        mesh.node[n].*axis = value;
        take(mesh, touching);
      }
    }
  }
  run.at_most(fmt::format("every one of {} nodes pushed through its neighbour, or not a number, or infinite",
                          sound.node.size()),
              "meshes not refused with a folded element's name", 0, static_cast<double>(tried - named),
              "an inverted element makes energy out of nothing",
              missed.empty() ? fmt::format("{} refused, as in \"{}\"", named, example) : missed);
}

}  // namespace mobil
