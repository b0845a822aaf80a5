#pragma once
// Sixteen modal bellies with random parameters, and their expected results.

#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "assets/fem/muscle_template.h"
#include "assets/reduction/modal_basis.h"
#include "systems/deformation/modal.h"

namespace mobil {

/// Solves z̈ + α·ż + ω²·z = ω²·s, with s linear over a step, by the roots of its characteristic polynomial.
struct ClosedForm {
  double omega, damping;
  double z = 0, speed = 0;

  void step(double from, double to, double time_s) {
    const double rate = (to - from) / time_s, lag = damping / (omega * omega) * rate;
    const std::complex<double> split = std::sqrt(std::complex<double>(damping * damping / 4 - omega * omega));
    const std::complex<double> root[2] = {-damping / 2 + split, -damping / 2 - split};
    const double y = z - from + lag, v = speed - rate;
    const std::complex<double> first = (v - root[1] * y) / (root[0] - root[1]), second = y - first;
    const std::complex<double> grown[2] = {first * std::exp(root[0] * time_s), second * std::exp(root[1] * time_s)};
    z = to - lag + (grown[0] + grown[1]).real();
    speed = rate + (root[0] * grown[0] + root[1] * grown[1]).real();
  }
};

using Columns = std::vector<Lanes<float>>;

struct ModalDrive;

struct ModalBodies {
  struct Sum {
    double value = 0, terms = 0;  // sum of magnitudes
  };

  ModalBasis basis;
  BellyScale<Lanes<float>> scale{};
  double damping;
  std::array<std::array<double, lane_count>, max_modes> omega{};
  std::array<std::array<std::array<double, lane_count>, 3 + frame_inputs>, max_modes> participation{};
  Columns state, motion, shape, displacement;

  ModalBodies(std::uint32_t modes, FarEnd end, bool frame, double damping_per_s, const Cells& cells = {2, 2, 8})
      : damping(damping_per_s) {
    basis.options.far_end = end;
    basis.options.frame_loads = frame;
    basis.options.control_cells = cells;
    basis.options.modes = basis.modes = modes;
    basis.inputs = input_count(end, frame);
    state.resize(modal_state_width(modes));
    motion.resize(modal_motion_width(modes, basis.inputs));
    shape.resize(modal_shape_width(modes, basis.inputs));
    displacement.resize(std::size_t{3} * node_count(cells));
    fill(shape, 101, 1);
    std::mt19937 random(103);
    std::uniform_real_distribution<double> even(-1, 1);
    basis.shape.resize(displacement.size() * (modes + 1));
    for (float& x : basis.shape) x = static_cast<float>(even(random));
    if (end != FarEnd::held) {
      for (std::size_t i = 0; i < basis.shape.size(); i += modes + 1) basis.shape[i] = 0;
    }
    for (std::size_t j = 0; j < modes; ++j) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        omega[j][l] = 20 * std::pow(60.0, (static_cast<double>(j) + 0.5 + 0.4 * even(random)) / modes);
        for (std::size_t i = 0; i < basis.inputs; ++i) participation[j][i][l] = std::round(64 * even(random)) / 64;
      }
    }
    for (std::size_t l = 0; l < lane_count; ++l) scale.across[l] = scale.along[l] = 1;
  }

  static void fill(Columns& columns, unsigned seed, double size) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> even(static_cast<float>(-size), static_cast<float>(size));
    for (auto& lanes : columns) {
      for (float& x : lanes.lane) x = even(random);
    }
  }

  void write_motion(double tick_s) {
    std::size_t at = 0;
    for (std::size_t j = 0; j < basis.modes; ++j) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        const double w = omega[j][l], decay = std::exp(-damping / 2 * tick_s), square = w * w - damping * damping / 4;
        const double turn = std::sqrt(std::abs(square));
        const double cosine = square > 0 ? std::cos(turn * tick_s) : std::cosh(turn * tick_s);
        const double sine = (square > 0 ? std::sin(turn * tick_s) : std::sinh(turn * tick_s)) / turn;
        motion[at][l] = static_cast<float>(decay * (cosine + damping / 2 * sine));
        motion[at + 1][l] = static_cast<float>(decay * w * sine);
        motion[at + 2][l] = static_cast<float>(damping / w);
        const std::size_t ends = input_count(basis.options.far_end, false);
        for (std::size_t i = 0; basis.inputs > 1 && i < ends; ++i) {
          motion[at + 3 + i][l] = static_cast<float>(participation[j][i][l]);
        }
        for (std::size_t i = ends; i < basis.inputs; i += 2) {  // two inputs a word
          std::uint32_t word = 0;
          for (const std::size_t part : {std::size_t{1}, std::size_t{0}}) {
            const auto number = static_cast<float>(participation[j][i + part][l]);
            word = word << 16 | std::bit_cast<std::uint32_t>(number) >> 16;
          }
          motion[at + 3 + ends + (i - ends) / 2][l] = std::bit_cast<float>(word);
        }
      }
      at += motion.size() / basis.modes;
    }
  }

  /// Returns s of a motion under these inputs; with one input, divided by its P.
  double rest(const Columns& inputs, std::size_t j, std::size_t l) const {
    if (basis.inputs == 1) return static_cast<double>(inputs[0][l]);
    double s = 0;
    for (std::size_t i = 0; i < basis.inputs; ++i) s += participation[j][i][l] * static_cast<double>(inputs[i][l]);
    return s;
  }

  std::array<double, 2> kept(std::size_t j, std::size_t l) const {
    return {static_cast<double>(state[2 * j][l]), static_cast<double>(state[2 * j + 1][l])};
  }

  ModalBlock block(const FrameLoad<Lanes<float>>& frame) {
    return {basis, scale, state.data()->lane, motion.data()->lane, basis.options.frame_loads ? &frame : nullptr};
  }

  /// Returns the lanes that started at rest.
  std::uint32_t tick(const ModalDrive& drive, double tick_s);
  BellyReport<Lanes<float>> report(const ModalDrive& drive, const MuscleTemplate& control, double tick_s);
  void place(const ModalDrive& drive, bool at_rest);
  std::vector<Sum> expected_displacement(const ModalDrive& drive, std::size_t l, bool at_rest) const;
};

/// Inputs of a tick, each from its value after the last tick to a new random value.
struct ModalDrive {
  const ModalBodies& bodies;
  std::mt19937 random;
  Columns from, to;

  ModalDrive(const ModalBodies& of, unsigned seed) : bodies(of), random(seed), from(of.basis.inputs), to(from) {}
  ModalDrive(const ModalDrive&) = default;

  void advance() {
    std::uniform_real_distribution<float> even(-0.1F, 0.1F);
    from = to;
    for (auto& lanes : to) {
      for (float& x : lanes.lane) x = 0.9F * x + even(random);
    }
  }

  /// Calls f(end, frame).
  template <class F>
  void give(F&& f) const {
    const auto vector = [](const Columns& columns, std::size_t at) {
      return Vec3<Lanes<float>>{columns[at], columns[at + 1], columns[at + 2]};
    };
    const FarEnd way = bodies.basis.options.far_end;
    const std::size_t ends = way == FarEnd::free ? 3 : 1;
    FrameLoad<Lanes<float>> frame{};
    if (bodies.basis.options.frame_loads) {
      frame.constant_from = vector(from, ends);
      frame.constant_to = vector(to, ends);
      frame.gradient_from = {vector(from, ends + 3), vector(from, ends + 6), vector(from, ends + 9)};
      frame.gradient_to = {vector(to, ends + 3), vector(to, ends + 6), vector(to, ends + 9)};
    }
    if (way == FarEnd::free) {
      f(FarFaceDrive(EndTraction<Lanes<float>>{vector(from, 0), vector(to, 0)}), frame);
    } else {
      f(FarFaceDrive(way, EndDrive<Lanes<float>>{from[0], to[0]}), frame);
    }
  }
};

inline std::uint32_t ModalBodies::tick(const ModalDrive& drive, double tick_s) {
  std::uint32_t restarted = 0;
  drive.give([&](const FarFaceDrive& end, const FrameLoad<Lanes<float>>& frame) {
    restarted = deform_modal(block(frame), end, static_cast<float>(tick_s));
  });
  return restarted;
}

inline void ModalBodies::place(const ModalDrive& drive, bool at_rest) {
  drive.give([&](const FarFaceDrive& end, const FrameLoad<Lanes<float>>& frame) {
    ModalBlock given = block(frame);
    const ControlPoints points{shape.data()->lane, displacement.data()->lane};
    if (!at_rest) return place_control_points(given, points, end);
    given.state = nullptr;
    given.motion = nullptr;
    place_static(given, points, end);
  });
}

inline BellyReport<Lanes<float>> ModalBodies::report(const ModalDrive& drive, const MuscleTemplate& control,
                                                     double tick_s) {
  BellyReport<Lanes<float>> told{};
  drive.give([&](const FarFaceDrive& end, const FrameLoad<Lanes<float>>& frame) {
    const ControlPoints points{shape.data()->lane, displacement.data()->lane};
    report_modal(block(frame), control, points, end, static_cast<float>(tick_s), told);
  });
  return told;
}

inline std::vector<ModalBodies::Sum> ModalBodies::expected_displacement(const ModalDrive& drive, std::size_t l,
                                                                        bool at_rest) const {
  const std::size_t count = basis.modes, inputs = basis.inputs;
  const bool held = basis.options.far_end == FarEnd::held;
  std::vector<Sum> amount(count + 1);
  const auto add = [](Sum& sum, double factor, const Sum& part) {
    sum.value += factor * part.value;
    sum.terms += std::abs(factor) * part.terms;
  };
  const auto number = [](float x) { return Sum{static_cast<double>(x), std::abs(static_cast<double>(x))}; };
  if (held) amount[0] = number(drive.to[0][l]);
  for (std::size_t k = 0; k < count; ++k) {
    const Lanes<float>* row = shape.data() + k * (count + inputs);
    for (std::size_t j = 0; !at_rest && j < count; ++j) {
      add(amount[k + 1], static_cast<double>(row[j][l]), number(state[2 * j][l]));
    }
    for (std::size_t i = 0; i < inputs; ++i) {
      add(amount[k + 1], static_cast<double>(row[count + i][l]), number(drive.to[i][l]));
    }
  }
  const Cells& cells = basis.options.control_cells;
  std::vector<Sum> u(displacement.size());
  const std::size_t far = std::size_t{3} * first_insertion_node(cells);
  for (std::size_t i = std::size_t{3} * plane_nodes(cells); i < (held ? far : u.size()); ++i) {
    for (std::size_t k = 0; k <= count; ++k) {
      add(u[i], static_cast<double>(basis.shape[i * (count + 1) + k]), amount[k]);
    }
  }
  for (std::size_t i = far + 2; held && i < u.size(); i += 3) u[i] = amount[0];
  return u;
}

}  // namespace mobil
