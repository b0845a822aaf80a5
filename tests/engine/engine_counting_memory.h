#pragma once
// A memory resource that counts its allocations.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory_resource>
#include <new>
#include <utility>

namespace mobil {

class CountingMemory : public std::pmr::memory_resource {
 public:
  std::size_t lent() const { return lent_.size(); }
  std::size_t lent_bytes() const { return lent_bytes_; }
  std::size_t requests = 0;
  std::size_t refuse_after = SIZE_MAX;  // requests that are still granted

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    EXPECT_GT(bytes, 0U) << "an empty request, which some hosts' heaps do not survive";
    if (refuse_after == 0) throw std::bad_alloc();
    if (refuse_after != SIZE_MAX) --refuse_after;
    ++requests;
    void* memory = std::pmr::new_delete_resource()->allocate(bytes, alignment);
    lent_[memory] = {bytes, alignment};
    lent_bytes_ += bytes;
    return memory;
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    EXPECT_TRUE(lent_.contains(memory) && lent_[memory] == std::pair(bytes, alignment));
    lent_.erase(memory);
    lent_bytes_ -= bytes;
    std::pmr::new_delete_resource()->deallocate(memory, bytes, alignment);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  std::map<void*, std::pair<std::size_t, std::size_t>> lent_;
  std::size_t lent_bytes_ = 0;
};

}  // namespace mobil
