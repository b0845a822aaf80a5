#include "demo/lab/frontier/frontier.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <utility>

#include <mobil/engine/jobs.h>
#include <mobil/muscle_table.h>
#include "demo/program/must.h"
#include "systems/bellies/belly_library.h"

namespace mobil {
namespace {

FrontierLevel elements(const char* name, Method method, const Cells& cells, std::optional<double> dt_s = {}) {
  FrontierLevel level{name, {}};
  level.method.choice.method = method;
  level.method.choice.cells = cells;
  level.method.choice.dt_s = dt_s;
  return level;
}

FrontierLevel fixed(const char* name, Method method, const Cells& cells, double dt_s) {
  FrontierLevel level = elements(name, method, cells, dt_s);
  level.method.fixed_step = true;
  return level;
}

FrontierLevel modes(const char* name, std::uint32_t count, const Cells& cells, bool corrected = true,
                    bool moving = true) {
  FrontierLevel level{name, {}};
  level.method.choice.method = Method::modal;
  level.method.choice.modal = {count, moving, corrected, cells};
  return level;
}

constexpr Cells coarse_cells = {2, 2, 8}, middle_cells = {4, 4, 16}, fine_cells = {8, 8, 32};

std::vector<FrontierLevel> short_levels() {
  std::vector<FrontierLevel> all;
  all.push_back(fixed("explicit-central", Method::explicit_central, coarse_cells, 0.002));
  all.back().mark = "the paper's choice: 81 nodes, 2 ms";
  all.push_back(fixed("explicit-central", Method::explicit_central, coarse_cells, 0.003));
  all.push_back(elements("explicit-central", Method::explicit_central, coarse_cells));
  all.push_back(elements("explicit-central", Method::explicit_central, middle_cells));
  all.push_back(elements("explicit-central", Method::explicit_central, {4, 4, 20}));
  all.back().mark = "the paper's 525 nodes";
  all.push_back(elements("implicit-central", Method::implicit_central, coarse_cells));
  for (const int parts : {1, 2, 4}) {
    all.push_back(elements("newmark", Method::newmark, coarse_cells, frontier_tick_s / parts));
  }
  all.push_back(elements("static", Method::statics, coarse_cells));
  all.push_back(modes("modal-static", 12, middle_cells, true, false));
  for (const std::uint32_t count : {2U, 4U, 6U, 8U, 12U, 16U, 20U, 24U, 32U}) {
    all.push_back(modes("modal", count, middle_cells));
  }
  return all;
}

struct Answers {
  std::vector<FrontierError> error;                          // of each level
  std::vector<std::vector<FrontierIndividual>> individuals;  // empty if it could not be stepped
  FrontierReference reference;
};

Answers answers_of(const FrontierRequest& request, const FrontierDrive& drive, bool loads,
                   std::vector<std::string>& why, const std::function<void()>& step) {
  auto reference = attempt([&] { return make_reference(drive, request.reference, loads); });
  if (!reference)
    throw Stopped(fmt::format("the reference of {}: {}", muscle_name(drive.muscle), reference.error().message));
  Answers all{{}, {}, std::move(*reference)};
  BellyLibrary library;
  for (const FrontierLevel& level : request.levels) {
    step();
    all.error.emplace_back();
    all.individuals.emplace_back();
    const auto done = attempt([&] {
      auto individuals = frontier_individuals(drive, level.method, loads, library);
      all.error.back().add(answer_of(drive, level.method, individuals, loads), all.reference.truth, drive.walks);
      all.individuals.back() = std::move(individuals);
    });
    why.push_back(done ? "" : done.error().message);
  }
  all.reference.truth = {};
  return all;
}

std::string cells_text(const Cells& cells) {
  return fmt::format("{}x{}x{}", cells[0], cells[1], cells[2]);
}

FrontierRow row_of(const FrontierLevel& level, bool loads) {
  FrontierRow row;
  row.method = level.name;
  row.cells = cells_text(level.method.cells());
  row.mark = level.mark;
  row.loads = loads;
  row.nodes = node_count(level.method.cells());
  row.modes = level.method.modal() ? level.method.choice.modal.modes : 0;
  return row;
}

/// Answers of each scene and muscle, on the requested number of threads.
struct AnswerTable {
  AnswerTable(const FrontierRequest& of, std::span<const FrontierDrive> all, std::size_t count)
      : request(of), drives(all), answers(count), why(count) {}

  const FrontierRequest& request;
  std::span<const FrontierDrive> drives;
  std::vector<std::optional<Result<Answers>>> answers;
  std::vector<std::vector<std::string>> why;
  std::atomic<std::size_t> done = 0;
  std::mutex telling;

  void make(std::size_t at) {
    const std::size_t muscles = drives.size();
    const auto step = [this] {
      const std::scoped_lock lock(telling);
      request.progress("answers",
                       static_cast<double>(++done) / static_cast<double>(answers.size() * request.levels.size()));
    };
    answers[at] =
        attempt([&] { return answers_of(request, drives[at % muscles], request.scenes[at / muscles], why[at], step); });
  }
};

/// Returns the muscles that a level lacks, and the reason.
std::string left_out(const FrontierLevel& level, const FrontierRow& row, const std::string& muscles,
                     const std::string& why) {
  const auto& dt_s = level.method.choice.dt_s;
  return fmt::format("{} of {} nodes{}{} is without {}: {}", row.method, row.nodes,
                     dt_s ? fmt::format(" at {:.3g} ms", *dt_s * 1e3) : "", row.loads ? " with the frame's loads" : "",
                     muscles, why);
}

bool nearer(double error_a, double cost_a, double error_b, double cost_b) {
  return error_a <= error_b && cost_a <= cost_b && (error_a < error_b || cost_a < cost_b);
}

}  // namespace

FrontierRequest short_frontier() {
  FrontierRequest request;
  request.levels = short_levels();
  return request;
}

FrontierRequest long_frontier() {
  FrontierRequest request;
  request.seconds = 2.7;
  request.reference = {16, 16, 64};
  request.rounds = 15;
  request.call_s = 0.05;
  request.levels = short_levels();
  auto& all = request.levels;
  all.push_back(elements("explicit-central", Method::explicit_central, fine_cells));
  all.push_back(elements("explicit-central", Method::explicit_central, {8, 8, 40}));
  all.back().mark = "the paper's 3321 nodes";
  for (const int parts : {1, 4})
    all.push_back(elements("newmark", Method::newmark, middle_cells, frontier_tick_s / parts));
  all.push_back(elements("static", Method::statics, middle_cells));
  all.push_back(elements("implicit-central", Method::implicit_central, middle_cells));
  for (const std::uint32_t count : {4U, 8U, 12U, 16U, 24U, 32U}) {
    all.push_back(modes("modal-plain", count, middle_cells, false));
  }
  for (const std::uint32_t count : {4U, 8U, 10U, 12U, 16U, 24U, 32U}) all.push_back(modes("modal", count, fine_cells));
  return request;
}

Frontier measure_frontier(const FrontierRequest& request) {
  request.progress("walks", 0);
  const auto drives = record_walks(request.muscles, request.walks, request.seconds);
  const std::size_t muscles = drives.size(), count = request.scenes.size() * muscles;
  AnswerTable table(request, drives, count);
  const Threads threads(request.threads);
  in_parallel(threads.jobs(), count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at) table.make(at);
  });
  for (const auto& answers : table.answers) {
    if (!*answers) throw Stopped(answers->error().message);
  }

  Frontier frontier;
  frontier.request = request;
  frontier.machine = describe_machine();
  for (std::size_t scene = 0; scene < request.scenes.size(); ++scene) {
    const bool loads = request.scenes[scene];
    const auto answers = [&](std::size_t m) -> Answers& { return **table.answers[scene * muscles + m]; };
    FrontierChange change;
    change.loads = loads;
    FrontierError mesh, fewer;
    for (std::size_t m = 0; m < muscles; ++m) {
      const FrontierReference& own = answers(m).reference;
      mesh.add(own.mesh);
      fewer.add(own.modes);
    }
    change.mesh = mesh.relative();
    change.modes = fewer.relative();
    frontier.change.push_back(change);

    std::vector<FrontierRow> rows(request.levels.size());
    std::vector<std::vector<std::vector<FrontierIndividual>>> individuals(rows.size());
    std::vector<FrontierPriced> priced;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      rows[r] = row_of(request.levels[r], loads);
      FrontierError error;
      std::string why, without;
      for (std::size_t m = 0; m < muscles; ++m) {
        const FrontierError& own = answers(m).error[r];
        error.add(own);
        rows[r].error_of_muscle.push_back(own.relative());
        individuals[r].push_back(std::move(answers(m).individuals[r]));
        if (const std::string& reason = table.why[scene * muscles + m][r]; !reason.empty()) {
          why = reason;
          without += fmt::format("{}{}", without.empty() ? "" : ", ", muscle_name(request.muscles[m]));
        }
      }
      if (!why.empty()) frontier.notes.push_back(left_out(request.levels[r], rows[r], without, why));
      if (error.reference_square == 0) continue;
      rows[r].error = error.relative();
      rows[r].error_max_m = error.largest_m;
      rows[r].uncertain = rows[r].error < 10 * change.own();
      priced.push_back({&request.levels[r], individuals[r], &rows[r]});
    }
    price(priced, drives, loads, frontier);
    for (const FrontierPriced& p : priced) frontier.rows.push_back(std::move(*p.row));
  }
  mark_frontier(frontier.rows);
  return frontier;
}

void mark_frontier(std::vector<FrontierRow>& rows) {
  for (FrontierRow& row : rows) {
    row.on_frontier = row.points_on_frontier = true;
    for (const FrontierRow& other : rows) {
      if (other.loads != row.loads) continue;
      if (nearer(other.error, other.cost_us, row.error, row.cost_us)) row.on_frontier = false;
      if (nearer(other.error, other.points_us, row.error, row.points_us)) row.points_on_frontier = false;
    }
  }
}

const FrontierRow* cheapest_within(std::span<const FrontierRow> rows, bool loads, bool points, double error) {
  const FrontierRow* best = nullptr;
  const auto cost = [&](const FrontierRow& row) { return points ? row.points_us : row.cost_us; };
  for (const FrontierRow& row : rows) {
    if (row.loads != loads || !(row.error <= error)) continue;
    if (best == nullptr || cost(row) < cost(*best)) best = &row;
  }
  return best;
}

}  // namespace mobil
