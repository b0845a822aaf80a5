#include "demo/crowd/city_shard.h"

#include <utility>

#include <mobil/shard_bytes.h>
#include "demo/measure/measure.h"

namespace mobil {
namespace {

template <class Orders>
Result<Orders> read_orders(std::span<const std::byte> commands) {
  Orders orders{};
  if (commands.empty()) return orders;
  PlainReader reader(commands);
  reader.take(orders);
  if (!reader.whole()) return fail("these are no orders to this crowd");
  return orders;
}

void count(const RelevanceReport& report, CityCounts& counts) {
  counts.switched += report.switched;
  counts.refused += report.refused;
  counts.woken += report.woken;
  counts.slept += report.slept;
  counts.begun += report.begun;
}

class CrowdShard : public CityShard {
 public:
  CrowdShard(std::unique_ptr<CrowdScene> scene, std::size_t humans, CityCounts& counts)
      : scene_(std::move(scene)), humans_(humans), counts_(counts) {}

  Simulation& simulation() override { return scene_->simulation(); }
  std::uint32_t ticks() const override { return std::as_const(*scene_).simulation().ticks(); }
  void tick() override { scene_->tick(); }
  std::uint64_t state_sum() const override { return std::as_const(*scene_).simulation().state_sum(); }
  Result<std::vector<std::byte>> save() const override { return scene_->save(); }
  Result<void> restore(std::span<const std::byte> saved) override { return scene_->restore(saved); }

  Result<void> populate() override {
    if (auto done = scene_->resize(humans_); !done) return done;
    return scene_->settle({}, false);
  }

  Result<void> apply(std::span<const std::byte> commands) override {
    const auto orders = read_orders<CrowdOrders>(commands);
    if (!orders) return tl::unexpected(orders.error());
    const double start = wall_now_s();
    const auto decided = scene_->decide(*orders);
    if (!decided) return tl::unexpected(decided.error());
    const double ready = wall_now_s();
    count(scene_->choose_methods(), counts_);
    counts_.host_s += ready - start;
    counts_.relevance_s += wall_now_s() - ready;
    counts_.spawned += decided->spawned;
    counts_.despawned += decided->despawned;
    counts_.turned += decided->turned;
    counts_.changed_speed += decided->changed_speed;
    return {};
  }

  CityState state() const override {
    CityState state{.people = scene_->walkers().size(), .bytes = scene_->bytes_of_people()};
    state.awake = state.people;
    for (const CrowdWalker& walker : scene_->walkers()) state.seen += walker.near ? 1 : 0;
    state.muscles_by_rung = scene_->muscles_by_rung();
    return state;
  }

  std::vector<CrowdCamera::Drawn> people() const override {
    std::vector<CrowdCamera::Drawn> all;
    for (const CrowdWalker& walker : scene_->walkers()) all.push_back({walker.entity, walker.number, walker.near});
    return all;
  }

 private:
  std::unique_ptr<CrowdScene> scene_;
  std::size_t humans_;
  CityCounts& counts_;
};

class AliveShard : public CityShard {
 public:
  AliveShard(std::unique_ptr<AliveScene> scene, CityCounts& counts) : scene_(std::move(scene)), counts_(counts) {}

  Simulation& simulation() override { return scene_->simulation(); }
  std::uint32_t ticks() const override { return std::as_const(*scene_).simulation().ticks(); }
  Result<void> populate() override { return scene_->populate(); }
  void tick() override { scene_->tick(); }
  std::uint64_t state_sum() const override { return std::as_const(*scene_).simulation().state_sum(); }
  Result<std::vector<std::byte>> save() const override { return scene_->save(); }
  Result<void> restore(std::span<const std::byte> saved) override { return scene_->restore(saved); }

  Result<void> apply(std::span<const std::byte> commands) override {
    const auto orders = read_orders<Viewpoint>(commands);
    if (!orders) return tl::unexpected(orders.error());
    const double start = wall_now_s();
    const auto asked = scene_->decide(*orders);
    if (!asked) return tl::unexpected(asked.error());
    const double ready = wall_now_s();
    const RelevanceReport report = scene_->choose();
    if (report.refused > 0) return fail(report.refusal);
    count(report, counts_);
    counts_.host_s += ready - start;
    counts_.relevance_s += wall_now_s() - ready;
    counts_.asked += *asked;
    return {};
  }

  CityState state() const override {
    const AliveScene::Count now = scene_->count();
    return {.people = scene_->people(), .bytes = scene_->bytes_of_people(), .awake = now.awake, .seen = now.seen};
  }

  std::vector<CrowdCamera::Drawn> people() const override { return scene_->seen(); }

 private:
  std::unique_ptr<AliveScene> scene_;
  CityCounts& counts_;
};

}  // namespace

void add(CityState& to, const CityState& more) {
  to.people += more.people;
  to.bytes += more.bytes;
  to.awake += more.awake;
  to.seen += more.seen;
  for (std::size_t r = 0; r < to.muscles_by_rung.size(); ++r) to.muscles_by_rung[r] += more.muscles_by_rung[r];
}

Cluster::Make city_shards(const CrowdOptions& options, const Simulation& library, CityCounts& counts) {
  return [&](std::uint32_t shard) -> Result<std::unique_ptr<Shard>> {
    if (options.alive) {
      AliveRequest request = *options.alive;
      request.shard = shard;
      request.shards = options.cluster.shards;
      request.library = &library;
      auto scene = AliveScene::make_empty(request);
      if (!scene) return tl::unexpected(scene.error());
      return std::make_unique<AliveShard>(std::move(*scene), counts);
    }
    CrowdRequest request = options.crowd;
    request.shard = shard;
    request.shards = options.cluster.shards;
    request.library = &library;
    auto scene = CrowdScene::make_empty(request);
    if (!scene) return tl::unexpected(scene.error());
    return std::make_unique<CrowdShard>(std::move(*scene), options.crowd.humans, counts);
  };
}

}  // namespace mobil
