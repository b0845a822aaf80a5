#include <mobil/engine/globals.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {
constexpr std::size_t value_alignment = 16;
}

Globals::~Globals() {
  for (const Value& value : values_)
    values_.get_allocator().resource()->deallocate(value.bytes, value.part.first.size(), value_alignment);
}

void Globals::add(const GlobalPart& part) {
  if (!find(part.id).empty()) return;
  values_.push_back({part, nullptr});
  try {
    values_.back().bytes =
        static_cast<std::byte*>(values_.get_allocator().resource()->allocate(part.first.size(), value_alignment));
  } catch (...) {
    values_.pop_back();
    throw;
  }
  std::ranges::copy(part.first, values_.back().bytes);
}

std::span<std::byte> Globals::find(std::uint64_t id) const {
  for (const Value& value : values_)
    if (value.part.id == id) return {value.bytes, value.part.first.size()};
  return {};
}

std::byte* Globals::at(std::uint64_t id, std::string_view name) const {
  const auto bytes = find(id);
  if (bytes.empty())
    throw std::logic_error("global: no module names " + std::string(name) + "; list it in Module::globals");
  return bytes.data();
}

bool Globals::changed(std::uint64_t id) const {
  for (const Value& value : values_)
    if (value.part.id == id) return !std::ranges::equal(value.part.first, find(id));
  return false;
}

std::uint64_t Globals::hash() const {
  std::uint64_t sum = 0;
  for (const Value& value : values_)
    if (changed(value.part.id)) sum += mix64(value.part.id ^ hash_bytes(value.bytes, value.part.first.size()));
  return sum;
}

}  // namespace mobil::inline v0_3
