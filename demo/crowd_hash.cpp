#include "demo/crowd_hash.h"

#include <vector>

namespace mobil {
namespace {

std::uint64_t hashed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15;
  return hash ^ hash >> 29;
}

void hash_row(const World& world, Entity entity, std::vector<std::uint32_t>& words, std::uint64_t& hash) {
  const auto place = world.find(entity);
  if (!place) return;
  for (const KeyPart& part : place.table->key()) {
    if (part.kind != PartKind::component && part.kind != PartKind::field) continue;
    if (part.id == type_id<MuscleOwner<float>>()) continue;
    words.resize(part.value);
    const auto width = static_cast<std::uint32_t>(part.value);
    place.table->read(place.row, place.table->column(part.id), width, words.data());
    for (const std::uint32_t word : words) hash = hashed(hash, word);
  }
}

}  // namespace

std::uint64_t crowd_hash(const CrowdScene& scene) {
  const Simulation& simulation = scene.simulation();
  std::vector<std::uint32_t> words;
  std::uint64_t hash = 0;
  for (const CrowdWalker& walker : scene.walkers()) {
    hash = hashed(hash, walker.number);
    hash_row(simulation.world(), walker.entity, words, hash);
    for (std::size_t m = 0; m < muscle_group_count; ++m) {
      for (const Side side : {right, left}) {
        hash_row(simulation.world(), simulation.muscle(walker.entity, static_cast<Muscle>(m), side), words, hash);
      }
    }
  }
  return hash;
}

}  // namespace mobil
