// Parts common to the modal kernels: a block's inputs, and the amounts of the modes. For inclusion only inside
// Highway's targets.

#if defined(MOBIL_SYSTEMS_DEFORMATION_REDUCED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_REDUCED_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_REDUCED_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_REDUCED_INL_H_
#endif

#include <array>

#include "engine/wide-inl.h"
#include "systems/deformation/modal.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

inline constexpr std::size_t max_inputs = 3 + frame_inputs;

/// Drives and loads of a block, in the order of a basis's inputs.
struct ModalInputs {
  std::size_t count = 0;
  std::array<const Lanes<float>*, max_inputs> from{}, to{};

  HWY_INLINE void add(const Lanes<float>* start, const Lanes<float>* finish) {
    from[count] = start;
    to[count] = finish;
    ++count;
  }
  HWY_INLINE void add(const Vec3<Lanes<float>>& start, const Vec3<Lanes<float>>& finish) {
    add(&start.x, &finish.x);
    add(&start.y, &finish.y);
    add(&start.z, &finish.z);
  }
};

HWY_INLINE ModalInputs modal_inputs(const FarFaceDrive& end, const FrameLoad<Lanes<float>>* frame) {
  ModalInputs inputs;
  for (std::size_t axis = end.way == FarEnd::free ? 0 : 2; axis < 3; ++axis) inputs.add(end.from[axis], end.to[axis]);
  if (frame != nullptr) {
    inputs.add(frame->constant_from, frame->constant_to);
    inputs.add(frame->gradient_from.x, frame->gradient_to.x);
    inputs.add(frame->gradient_from.y, frame->gradient_to.y);
    inputs.add(frame->gradient_from.z, frame->gradient_to.z);
  }
  return inputs;
}

/// Two numbers from a word of each lane.
struct WidePair {
  Wide even, odd;
};

HWY_INLINE WidePair load_pair(const float* p) {
  WidePair pair;
  for (std::size_t i = 0; i < vector_count; ++i) {
    const auto word = hn::BitCast(WordTag{}, hn::Load(FloatTag{}, p + i * vector_lanes));
    pair.even.part[i] = hn::BitCast(FloatTag{}, hn::ShiftLeft<16>(word));
    pair.odd.part[i] = hn::BitCast(FloatTag{}, hn::And(word, hn::Set(WordTag{}, 0xFFFF0000U)));
  }
  return pair;
}

/// Returns the number of inputs whose P a motion stores in full. The others are stored in pairs.
HWY_INLINE std::size_t full_inputs(std::size_t count) {
  return count > frame_inputs ? count - frame_inputs : count;
}

/// Prefetches sixteen lanes into the second-level cache. The first level has too few slots for pending loads.
HWY_INLINE void fetch(const float* p) {
  __builtin_prefetch(p, 0, 2);
}

/// Prefetches `rows` rows of sixteen lanes from each of `runs` places `apart` rows apart, in small portions.
class Ahead {
 public:
  HWY_INLINE Ahead(const float* begin, std::size_t runs, std::size_t rows, std::size_t apart)
      : at_(begin), runs_(begin == nullptr ? 0 : runs), rows_(rows), left_(rows), skipped_(apart - rows) {}

  std::size_t rows() const { return runs_ * rows_; }  // before the first fetch

  HWY_INLINE void fetch_some(std::size_t count) {
    for (std::size_t i = 0; i < count && runs_ > 0; ++i, at_ += lane_count) {
      fetch(at_);
      if (--left_ > 0) continue;
      left_ = rows_;
      at_ += skipped_ * lane_count;
      --runs_;
    }
  }

 private:
  const float* at_;
  std::size_t runs_, rows_, left_, skipped_;
};

/// Pointers to the arrays of `shape` that follow the rows.
struct ModalTail {
  const float *omega, *participation, *reaction, *drag;
};

HWY_INLINE ModalTail modal_tail(const float* shape, std::size_t modes, std::size_t inputs) {
  const float* const omega = shape + modes * (modes + inputs) * lane_count;
  const float* const participation = omega + modes * lane_count;
  const float* const reaction = participation + modes * lane_count;
  return {omega, participation, reaction, reaction + inputs * lane_count};
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
