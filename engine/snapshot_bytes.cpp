#include "engine/snapshot_bytes.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <string>

#include <mobil/engine/interrupt.h>
#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

constexpr std::uint64_t magic = 0x70616e736c69626d;  // "mbilsnap" in bytes
constexpr std::uint32_t format_version = 8;
constexpr std::uint32_t byte_order = 0x01020304;

struct Header {
  std::uint64_t magic;
  std::uint32_t version, byte_order;
  std::uint64_t bytes, seal;
  std::uint64_t front, world, blocks;
  std::uint64_t spare;
};
static_assert(sizeof(Header) == SnapshotLayout::header_bytes);

std::uint64_t seal_of(Header header, std::span<const std::byte> seals) {
  header.seal = 0;
  return mix64(hash_bytes(&header, sizeof(header)) ^ mix64(hash_bytes(seals.data(), seals.size())));
}

struct Sealing {
  const SnapshotLayout& layout;
  std::span<std::byte> out;
  void (*fill)(void*, std::size_t, std::size_t);
  void* context;

  void run(std::size_t begin, std::size_t end) const {
    for (std::size_t c = begin; c < end; ++c) {
      check_interrupt();
      const std::size_t from = SnapshotLayout::header_bytes + c * SnapshotLayout::chunk_bytes;
      const std::size_t to = std::min(from + SnapshotLayout::chunk_bytes, layout.seals_at());
      const std::size_t first = std::max(from, layout.blocks_at());
      const std::size_t last = std::min<std::size_t>(to, layout.blocks_at() + layout.blocks);
      if (fill != nullptr && first < last) fill(context, first - layout.blocks_at(), last - layout.blocks_at());
      const std::uint64_t hash = hash_bytes(&out[from], to - from);
      std::memcpy(&out[layout.seals_at() + 8 * c], &hash, 8);
    }
  }
};

struct Checking {
  const SnapshotLayout& layout;
  std::span<const std::byte> in;
  std::atomic<bool> sound = true;

  void run(std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      check_interrupt();
      const std::size_t from = SnapshotLayout::header_bytes + c * SnapshotLayout::chunk_bytes;
      const std::size_t to = std::min(from + SnapshotLayout::chunk_bytes, layout.seals_at());
      std::uint64_t hash;
      std::memcpy(&hash, &in[layout.seals_at() + 8 * c], 8);
      if (hash != hash_bytes(&in[from], to - from)) sound = false;
    }
  }
};

/// Reads the layout from a header of that many bytes; returns false if it is invalid.
bool read_layout(const Header& header, std::size_t bytes, SnapshotLayout& layout) {
  layout = {header.front, header.world, header.blocks};
  for (const std::uint64_t part : {header.front, header.world, header.blocks}) {
    if (part > bytes) return false;
  }
  return layout.bytes() == bytes;
}

}  // namespace

void seal_snapshot(const SnapshotLayout& layout, std::span<std::byte> out, const Jobs& jobs,
                   void (*fill)(void*, std::size_t, std::size_t), void* context) {
  const std::size_t world_end = layout.world_at() + layout.world, blocks_end = layout.blocks_at() + layout.blocks;
  std::memset(&out[world_end], 0, layout.blocks_at() - world_end);
  std::memset(&out[blocks_end], 0, layout.seals_at() - blocks_end);
  Sealing sealing{layout, out, fill, context};
  in_parallel(jobs, layout.chunks(), [&](std::size_t begin, std::size_t end) { sealing.run(begin, end); });
  Header header{magic, format_version, byte_order, layout.bytes(), 0, layout.front, layout.world, layout.blocks, 0};
  header.seal = seal_of(header, out.subspan(layout.seals_at(), 8 * layout.chunks()));
  std::memcpy(out.data(), &header, sizeof(header));
}

Result<OpenSnapshot> open_snapshot(std::span<const std::byte> in, const Jobs& jobs) {
  constexpr const char* give = "; give one that `save` made, whole";
  Header header{};
  if (in.size() < sizeof(header))
    return fail("a snapshot begins with " + std::to_string(sizeof(header)) + " bytes, and there are " +
                std::to_string(in.size()) + give);
  std::memcpy(&header, in.data(), sizeof(header));
  if (header.magic != magic) return fail(std::string("these bytes are no snapshot") + give);
  if (header.byte_order != byte_order)
    return fail("the snapshot was made on a machine of another byte order; restore it on one like that");
  if (header.version != format_version)
    return fail("the snapshot has format version " + std::to_string(header.version) + ", and this program reads " +
                std::to_string(format_version) + "; restore it with the program that made it");
  if (header.bytes != in.size())
    return fail("the snapshot is cut or padded: it says " + std::to_string(header.bytes) + " bytes, and there are " +
                std::to_string(in.size()) + give);
  SnapshotLayout layout;
  if (!read_layout(header, in.size(), layout)) return fail(std::string("the snapshot's header is damaged") + give);
  Checking checking{layout, in};
  in_parallel(jobs, layout.chunks(), [&](std::size_t begin, std::size_t end) { checking.run(begin, end); });
  if (!checking.sound || header.seal != seal_of(header, in.subspan(layout.seals_at(), 8 * layout.chunks())))
    return fail(std::string("the snapshot was altered or damaged: its checksum does not fit") + give);
  return OpenSnapshot{in.subspan(layout.front_at(), layout.front), in.subspan(layout.world_at(), layout.world),
                      in.subspan(layout.blocks_at(), layout.blocks)};
}

}  // namespace mobil::inline v0_3
