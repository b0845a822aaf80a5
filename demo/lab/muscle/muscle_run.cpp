#include "demo/lab/muscle/muscle_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "assets/reduction/modal_basis.h"
#include "demo/lab/reference/reference.h"
#include "demo/program/progress.h"
#include "systems/deformation/deformation.h"
#include "systems/deformation/finite.h"
#include "systems/deformation/modal.h"

namespace mobil {
namespace {

/// A belly at rest at t = 0 that is stepped from one load to the next.
class Belly {
 public:
  Belly() = default;
  virtual ~Belly() = default;
  Belly(const Belly&) = delete;
  Belly& operator=(const Belly&) = delete;
  virtual void step(const Vec3<double>& now, const Vec3<double>& next) = 0;
  virtual double displacement(std::uint32_t node, std::size_t axis) = 0;
};

Result<ReferenceBelly> make_reference(const MuscleRequest& request) {
  const MuscleOptions& o = request.muscle.options;
  // At rest finite strain has no elastic force either, so it starts like explicit central differences.
  const Method method = request.method == Method::finite ? Method::explicit_central : request.method;
  return ReferenceBelly::make(request.muscle.mesh, request.muscle.terms,
                              {method, o.mass, o.far_end, request.dt_s, o.damping_per_s, o.stiffness_damping_s,
                               2 * std::numbers::pi * o.foundation_hz});
}

class DoubleBelly : public Belly {
 public:
  DoubleBelly(const MuscleRequest& request, ReferenceBelly belly)
      : gravity_(request.gravity_m_s2), belly_(std::move(belly)) {
    belly_.start(load(force_at(request.load, 0)));
  }
  void step(const Vec3<double>& now, const Vec3<double>& next) override { belly_.step(load(now), load(next)); }
  double displacement(std::uint32_t node, std::size_t axis) override { return belly_.displacement()[3 * node + axis]; }

 private:
  ReferenceLoad load(const Vec3<double>& force) const { return {force, gravity_, {}}; }
  Vec3<double> gravity_;
  ReferenceBelly belly_;
};

void spread(const Vec3<double>& value, Vec3<Lanes<float>>& lanes) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    lanes.x[l] = static_cast<float>(value.x);
    lanes.y[l] = static_cast<float>(value.y);
    lanes.z[l] = static_cast<float>(value.z);
  }
}

/// One belly in all sixteen lanes of the walk's kernels.
class SingleBelly : public Belly {
 public:
  explicit SingleBelly(const MuscleRequest& request)
      : request_(request),
        displacement_(nodal_width(request.muscle.mesh.cells)),
        velocity_(nodal_width(request.muscle.mesh.cells)),
        scratch_((scratch_floats(request.muscle, request.method) + lane_count - 1) / lane_count) {
    for (std::size_t l = 0; l < lane_count; ++l) scale_.across[l] = scale_.along[l] = 1;
    const Vec3<double>& g = request.gravity_m_s2;
    weighed_ = g.x != 0 || g.y != 0 || g.z != 0;
    spread(g, frame_.constant_from);
    spread(g, frame_.constant_to);
  }

  void set_velocity(std::size_t at, double value) {
    for (float& v : velocity_[at].lane) v = static_cast<float>(value);
  }

  void step(const Vec3<double>& now, const Vec3<double>& next) override {
    EndTraction<Lanes<float>> traction{};
    spread(now, traction.from_n);
    spread(next, traction.to_n);
    const BellyBlock block{request_.muscle,
                           scale_,
                           displacement_.data()->lane,
                           velocity_.data()->lane,
                           report_,
                           Stiffness::shared,
                           weighed_ ? &frame_ : nullptr,
                           false};
    const auto dt = static_cast<float>(request_.dt_s);
    float* const scratch = scratch_.empty() ? nullptr : scratch_.data()->lane;
    if (request_.solver) {
      deform_implicit(block, *request_.solver, traction, 1, dt, scratch);
    } else if (request_.method == Method::finite) {
      deform_finite(block, traction, nullptr, 1, dt, scratch);
    } else {
      deform_explicit(block, traction, 1, dt, scratch);
    }
  }
  double displacement(std::uint32_t node, std::size_t axis) override {
    return static_cast<double>(displacement_[3 * node + axis][0]);
  }

 private:
  const MuscleRequest& request_;
  std::vector<Lanes<float>> displacement_, velocity_, scratch_;
  BellyScale<Lanes<float>> scale_{};
  FrameLoad<Lanes<float>> frame_{};
  bool weighed_ = false;
  BellyReport<Lanes<float>> report_{};
};

/// One belly in all sixteen lanes, in the block's own modes.
class ModalOne : public Belly {
 public:
  static Result<std::unique_ptr<ModalOne>> make(const MuscleRequest& request) {
    auto own = make_modal_belly(*request.basis, 1, 1);
    if (!own) return tl::unexpected(own.error());
    return std::unique_ptr<ModalOne>(new ModalOne(request, *own));
  }

  void step(const Vec3<double>& now, const Vec3<double>& next) override {
    EndTraction<Lanes<float>> traction{};
    spread(now, traction.from_n);
    spread(next, traction.to_n);
    deform_modal(block_, traction, static_cast<float>(dt_s_));
    place_control_points(block_, {shape_.data()->lane, displacement_.data()->lane}, traction);
  }
  double displacement(std::uint32_t node, std::size_t axis) override {
    return static_cast<double>(displacement_[3 * node + axis][0]);
  }

  /// Returns the modal coordinates of the displacement.
  std::vector<float> coordinates() const {
    std::vector<float> shown;
    for (const Lanes<float>& lanes : displacement_) shown.push_back(lanes[0]);
    double q[max_modes];
    fit_coordinates(basis_, 0, shown, q);
    return {q, q + basis_.modes};
  }

 private:
  ModalOne(const MuscleRequest& request, const ModalBelly& own)
      : basis_(*request.basis),
        dt_s_(request.dt_s),
        state_(modal_state_width(basis_.modes)),
        motion_(modal_motion_width(basis_.modes, basis_.inputs)),
        shape_(modal_shape_width(basis_.modes, basis_.inputs)),
        displacement_(nodal_width(request.muscle.mesh.cells)) {
    for (std::size_t l = 0; l < lane_count; ++l) scale_.across[l] = scale_.along[l] = 1;
    spread(request.gravity_m_s2, frame_.constant_from);
    spread(request.gravity_m_s2, frame_.constant_to);
    const double damping = request.muscle.options.damping_per_s;
    std::vector<float> row(motion_.size());
    write_motion(own, damping, dt_s_, row);
    fill(row, motion_);
    row.resize(shape_.size());
    write_shape(own, damping, row);
    fill(row, shape_);
    // at rest at t = 0, regardless of the load then
    const Vec3<double> f = force_at(request.load, 0), &g = request.gravity_m_s2;
    std::vector<double> input = {f.x, f.y, f.z, g.x, g.y, g.z};
    input.resize(basis_.inputs);
    const std::vector<float> still(displacement_.size());
    row.resize(state_.size());
    fit_state(basis_, own, input, std::vector<double>(basis_.inputs), still, still, row);
    fill(row, state_);
  }

  static void fill(const std::vector<float>& row, std::vector<Lanes<float>>& block) {
    for (std::size_t i = 0; i < block.size(); ++i) std::fill_n(block[i].lane, lane_count, row[i]);
  }

  const ModalBasis& basis_;
  double dt_s_;
  std::vector<Lanes<float>> state_, motion_, shape_, displacement_;
  BellyScale<Lanes<float>> scale_{};
  FrameLoad<Lanes<float>> frame_{};
  ModalBlock block_{basis_, scale_, state_.data()->lane, motion_.data()->lane, basis_.inputs > 3 ? &frame_ : nullptr};
};

/// Returns the recording for a GLB of a modal run, still without frames.
BasisRecording begin_recording(const MuscleRequest& request) {
  const ModalBasis& basis = *request.basis;
  const std::size_t width = nodal_width(request.muscle.mesh.cells), row = basis.modes + std::size_t{1};
  BasisRecording recording{
      request.muscle.mesh, std::vector<std::vector<float>>(basis.modes), {}, static_cast<float>(request.dt_s)};
  for (std::size_t v = 0; v < basis.modes; ++v) {
    for (std::size_t i = 0; i < width; ++i) recording.target[v].push_back(basis.shape[i * row + 1 + v]);
  }
  return recording;
}

bool loaded_at_start(const MuscleRequest& request) {
  const auto any = [](const Vec3<double>& v) { return v.x != 0 || v.y != 0 || v.z != 0; };
  return any(force_at(request.load, 0)) || any(request.gravity_m_s2);
}

/// Sets the state at rest. With central differences the half-step velocity before t = 0 is part of it: −½Δt·M⁻¹·f(0).
/// With static, the first row is the deflection under the first load.
Result<void> start_at_rest(const MuscleRequest& request, SingleBelly& belly) {
  const auto force = force_at(request.load, 0);
  if (request.method == Method::statics) belly.step(force, force);
  const bool half_a_step_back = request.method == Method::explicit_central ||
                                request.method == Method::implicit_central || request.method == Method::finite;
  if (!half_a_step_back || !loaded_at_start(request)) return {};
  auto reference = make_reference(request);
  if (!reference) return tl::unexpected(reference.error());
  reference->start({force, request.gravity_m_s2, {}});
  const auto velocity = reference->velocity();
  for (std::size_t i = 0; i < velocity.size(); ++i) belly.set_velocity(i, velocity[i]);
  return {};
}

Result<std::unique_ptr<Belly>> make_belly(const MuscleRequest& request) {
  if (request.in_double) {
    auto belly = make_reference(request);
    if (!belly) return tl::unexpected(belly.error());
    return std::make_unique<DoubleBelly>(request, std::move(*belly));
  }
  if (request.basis) return ModalOne::make(request);
  auto belly = std::make_unique<SingleBelly>(request);
  if (auto ok = start_at_rest(request, *belly); !ok) return tl::unexpected(ok.error());
  return belly;
}

}  // namespace

Result<MuscleRun> run_muscle(const MuscleRequest& request) {
  const auto belly = make_belly(request);
  if (!belly) return tl::unexpected(belly.error());
  const auto centre = insertion_centre(request.muscle.mesh.cells);
  const auto mean = [&](std::size_t axis) {
    double sum = 0;
    for (const auto n : centre) sum += (*belly)->displacement(n, axis);
    return sum / static_cast<double>(centre.size());
  };
  MuscleRun result;
  result.csv = "time_s,u_x_m,u_y_m,u_z_m\n";
  auto* const modal = request.glb.empty() ? nullptr : dynamic_cast<ModalOne*>(belly->get());
  if (modal != nullptr) result.recording = begin_recording(request);
  ProgressBar progress("stepping", request.steps);
  for (std::size_t step = 0;; ++step) {
    const double time = static_cast<double>(step) * request.dt_s;
    const double u[3] = {mean(0), mean(1), mean(2)};
    const double size = std::hypot(u[0], u[1], u[2]);
    if (!std::isfinite(size)) {
      result.lost_at_s = time;
      return result;
    }
    if (size > result.peak_m) {
      result.peak_m = size;
      result.peak_time_s = time;
    }
    fmt::format_to(std::back_inserter(result.csv), "{:.9g},{:.9g},{:.9g},{:.9g}\n", time, u[0], u[1], u[2]);
    if (modal != nullptr) result.recording.weight.push_back(modal->coordinates());
    if (step == request.steps) return result;
    const double next = static_cast<double>(step + 1) * request.dt_s;
    (*belly)->step(force_at(request.load, time), force_at(request.load, next));
    progress.at(step + 1);
  }
}

}  // namespace mobil
