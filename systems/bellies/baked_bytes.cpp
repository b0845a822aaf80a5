#include "systems/bellies/baked_bytes.h"

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

using BakedHeader = std::array<std::uint64_t, 4>;  // magic, maker, length with this header, hash of the contents

}  // namespace

std::vector<std::byte> sealed(const BakeWriter& contents, std::uint64_t magic, std::uint64_t maker) {
  const auto& bytes = contents.bytes;
  const BakedHeader header = {magic, maker, sizeof header + bytes.size(), hash_bytes(bytes.data(), bytes.size())};
  std::vector<std::byte> all(sizeof header + bytes.size());
  std::memcpy(all.data(), header.data(), sizeof header);
  std::memcpy(all.data() + sizeof header, bytes.data(), bytes.size());
  return all;
}

Result<std::span<const std::byte>> opened(std::span<const std::byte> baked, std::uint64_t magic,
                                          std::uint64_t (*maker)(), std::string_view what) {
  BakedHeader header{};
  if (baked.size() >= sizeof header) std::memcpy(header.data(), baked.data(), sizeof header);
  if (header[0] != magic) return fail(fmt::format("these are no baked {}; give what `bake` made", what));
  const auto contents = baked.subspan(sizeof header);
  if (header[2] != baked.size() || header[3] != hash_bytes(contents.data(), contents.size()))
    return fail(fmt::format("the baked {} were cut or altered; bake them again", what));
  if (header[1] != maker()) {
    return fail(
        fmt::format("these {} were baked by another version, or on another kind of processor; bake them again", what));
  }
  return contents;
}

}  // namespace mobil::inline v0_3
