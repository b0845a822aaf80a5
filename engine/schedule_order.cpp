#include "engine/schedule_order.h"

#include <algorithm>
#include <optional>
#include <string>

namespace mobil::inline v0_3 {
namespace {
using Mode = Access::Mode;

/// A relation between systems: (a, b) means that a runs before b.
class Relation {
 public:
  explicit Relation(std::size_t count) : count_(count), before_(count * count, false) {}
  void set(std::size_t a, std::size_t b) { before_[a * count_ + b] = true; }
  bool operator()(std::size_t a, std::size_t b) const { return before_[a * count_ + b]; }
  std::size_t count() const { return count_; }

 private:
  std::size_t count_;
  std::vector<bool> before_;
};

std::string quoted(const System& system) {
  return "'" + system.name + "'";
}

/// Returns the relation given by the systems' `after`.
Result<Relation> explicit_order(std::span<const System> systems) {
  Relation before(systems.size());
  for (std::size_t b = 0; b < systems.size(); ++b) {
    for (const std::string& name : systems[b].after) {
      bool there = false;
      for (std::size_t a = 0; a < systems.size(); ++a) {
        if (systems[a].name != name && systems[a].alternatives != name) continue;
        before.set(a, b);
        there = true;
      }
      if (!there) {
        return fail("schedule: system " + quoted(systems[b]) + " is to run after '" + name +
                    "', which was never added; add it or drop the after");
      }
    }
  }
  return before;
}

Relation transitive(Relation r) {
  for (std::size_t k = 0; k < r.count(); ++k) {
    for (std::size_t i = 0; i < r.count(); ++i) {
      for (std::size_t j = 0; j < r.count(); ++j) {
        if (r(i, k) && r(k, j)) r.set(i, j);
      }
    }
  }
  return r;
}

std::optional<Error> own_contradiction(const System& system) {
  for (const Access& a : system.accesses) {
    for (const Access& b : system.accesses) {
      if (&a != &b && a.mode == Mode::write && b.mode != Mode::none && a.id == b.id) {
        return Error{"schedule: system " + quoted(system) + " takes " + std::string(a.name) +
                     " twice and writes it; let one reference do both, or split the system"};
      }
    }
  }
  return std::nullopt;
}

/// Returns a cycle among the systems that are not done, as text. Each of them waits for another, so one exists.
std::string circle(std::span<const System> systems, const Relation& before, const std::vector<bool>& done) {
  std::vector<std::size_t> path;  // each waits for the next
  std::size_t at = static_cast<std::size_t>(std::find(done.begin(), done.end(), false) - done.begin());
  while (std::find(path.begin(), path.end(), at) == path.end()) {
    path.push_back(at);
    std::size_t a = 0;
    while (done[a] || !before(a, at)) ++a;
    at = a;
  }
  path.push_back(at);
  std::string text;
  for (auto step = std::find(path.begin(), path.end(), at); step != path.end(); ++step) {
    text += (text.empty() ? "" : " waits for ") + quoted(systems[*step]);
  }
  return text;
}
}  // namespace

Result<std::vector<std::size_t>> schedule_order(std::span<const System> systems) {
  const std::size_t count = systems.size();
  for (std::size_t a = 0; a < count; ++a) {
    if (auto error = own_contradiction(systems[a])) return tl::unexpected(*error);
    for (std::size_t b = 0; b < a; ++b) {
      if (systems[a].name == systems[b].name) {
        return fail("schedule: two systems are named " + quoted(systems[a]) + "; rename one");
      }
    }
  }
  auto spelled_out = explicit_order(systems);
  if (!spelled_out) return tl::unexpected(spelled_out.error());
  const Relation stated = transitive(*spelled_out);

  Relation before = *spelled_out;
  for (std::size_t w = 0; w < count; ++w) {
    for (std::size_t r = 0; r < count; ++r) {
      if (r == w) continue;
      for (const Access& write : systems[w].accesses) {
        if (write.mode != Mode::write) continue;
        for (const Access& other : systems[r].accesses) {
          if (other.mode == Mode::none || other.id != write.id || stated(w, r) || stated(r, w)) continue;
          if (other.mode == Mode::write) {
            if (!systems[w].alternatives.empty() && systems[w].alternatives == systems[r].alternatives) continue;
            return fail("schedule: systems " + quoted(systems[w]) + " and " + quoted(systems[r]) + " both write " +
                        std::string(write.name) + "; say which comes second with .after(…)");
          }
          if (other.mode == Mode::previous) {
            before.set(r, w);
          } else {
            before.set(w, r);
          }
        }
      }
    }
  }

  std::vector<std::size_t> order;
  std::vector<bool> done(count, false);
  while (order.size() < count) {
    const auto ready = [&](std::size_t s) {
      if (done[s]) return false;
      for (std::size_t a = 0; a < count; ++a) {
        if (!done[a] && before(a, s)) return false;
      }
      return true;
    };
    std::size_t next = 0;
    while (next < count && !ready(next)) ++next;
    if (next == count) {
      return fail("schedule: " + circle(systems, before, done) +
                  "; let one read last tick's value (Previous<…>) or order them with .after(…)");
    }
    done[next] = true;
    order.push_back(next);
  }
  return order;
}

std::vector<SystemRange> schedule_passes(std::span<const System> ordered) {
  const auto meet = [](const System& a, Mode of_a, const System& b, Mode of_b) {
    return std::any_of(a.accesses.begin(), a.accesses.end(), [&](const Access& x) {
      return x.mode == of_a && std::any_of(b.accesses.begin(), b.accesses.end(),
                                           [&](const Access& y) { return y.mode == of_b && y.id == x.id; });
    });
  };
  std::vector<SystemRange> passes;
  for (std::size_t s = 0; s < ordered.size(); ++s) {
    bool joins = !passes.empty() && !ordered[s].choose && !ordered[passes.back().first].choose;
    for (std::size_t other = joins ? passes.back().first : s; joins && other < s; ++other) {
      joins = !meet(ordered[other], Mode::write, ordered[s], Mode::lookup) &&
              !meet(ordered[other], Mode::lookup, ordered[s], Mode::write);
    }
    if (joins) {
      passes.back().last = s + 1;
    } else {
      passes.push_back({s, s + 1});
    }
  }
  return passes;
}

}  // namespace mobil::inline v0_3
