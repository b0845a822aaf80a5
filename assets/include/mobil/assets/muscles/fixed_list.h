#pragma once
// A list stored in its owner, so that a row of a table can contain it at compile time.

#include <array>
#include <cstddef>
#include <initializer_list>

namespace mobil::inline v0_3 {

/// List of up to `capacity` items. More items at compile time are a compile error.
template <class T, std::size_t capacity>
class FixedList {
 public:
  constexpr FixedList() = default;
  constexpr FixedList(std::initializer_list<T> items) : size_(items.size()) {
    for (std::size_t i = 0; i < size_; ++i) item_.at(i) = items.begin()[i];
  }

  constexpr std::size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr const T* data() const { return item_.data(); }
  constexpr const T* begin() const { return data(); }
  constexpr const T* end() const { return data() + size_; }
  constexpr const T& front() const { return item_[0]; }
  constexpr const T& back() const { return item_[size_ - 1]; }
  constexpr const T& operator[](std::size_t i) const { return item_[i]; }

 private:
  std::array<T, capacity> item_{};
  std::size_t size_ = 0;
};

}  // namespace mobil::inline v0_3
