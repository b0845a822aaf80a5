#pragma once
// Gives a test program an operator new that counts requests and can refuse them.

#include <atomic>
#include <cstddef>

namespace mobil {
extern std::atomic<std::size_t> heap_requests;
extern std::atomic<std::size_t> heap_refuse_at;  // refuses that request and all later ones
extern std::atomic<std::size_t> heap_lent;       // bytes in use, including the allocator's rounding
}  // namespace mobil
