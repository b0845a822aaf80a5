#pragma once
// A test program that includes this has an operator new that counts, and that refuses where it is asked to.

#include <atomic>
#include <cstddef>

namespace mobil {
extern std::atomic<std::size_t> heap_requests;
extern std::atomic<std::size_t> heap_refuse_at;  // and from that request on
extern std::atomic<std::size_t> heap_lent;       // bytes now in use, what the allocator rounds up to included
}  // namespace mobil
