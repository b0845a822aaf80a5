#include "demo/lab/bench/bench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

#include <mobil/mpi_transport.h>
#include "demo/lab/bench/bench_crowd.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/json.h"
#include "demo/program/named_entries.h"
#include "demo/program/progress.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

constexpr std::size_t small_crowd_size = 512;

BenchCrowd* made_once(std::shared_ptr<BenchCrowd>& crowd, std::size_t people) {
  if (crowd == nullptr) crowd = std::make_shared<BenchCrowd>(people);
  return crowd.get();
}

struct Bench {
  std::string_view name;
  void (*run)(BenchRun&);
};

constexpr std::array benches = {Bench{"machine", &bench_machine},
                                Bench{"gait", &bench_gait},
                                Bench{"kinematics", &bench_kinematics},
                                Bench{"lines", &bench_lines},
                                Bench{"activation", &bench_activation},
                                Bench{"skinning", &bench_skinning},
                                Bench{"skin", &bench_skin},
                                Bench{"avoidance", &bench_avoidance},
                                Bench{"table1", &bench_table1},
                                Bench{"fem", &bench_fem},
                                Bench{"modal", &bench_modal},
                                Bench{"paper_figures", &bench_paper_figures},
                                Bench{"crowd", &bench_crowds},
                                Bench{"threads", &bench_threads},
                                Bench{"lod", &bench_lod},
                                Bench{"cluster", &bench_cluster}};

struct BenchText {
  std::vector<std::string> names;
  std::string people = "10000";
  std::optional<std::string> json;
  bool quick = false;
};

/// Returns the benches to run, in the order above, and stores the run's own options.
std::vector<Bench> read_request(const BenchText& text, BenchRun& run) {
  auto chosen = must(choose_named(benches, text.names, "bench"));
  constexpr std::size_t most = 200'000;
  const auto people = parse_count(text.people, 1, most);
  if (!people) throw Stopped(fmt::format("--people '{}' must be a whole number from 1 to {}", text.people, most));
  run.people = *people;
  run.quick = text.quick;
  if (text.json) must(check_result_place("--json", *text.json));
  if (started_as_rank() && (chosen.size() != 1 || chosen.front().run != &bench_cluster))
    throw Stopped("under mpirun cluster alone is measured; give mpirun -n 2 mobil bench cluster");
  return chosen;
}

std::string percent(const std::optional<double>& fraction) {
  return fraction ? fmt::format("{:.0f} %", 100 * *fraction) : "";
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "";
}

void print_table(const BenchRun& run) {
  const Machine& m = run.machine;
  print_output("{}, {} cores; caches {} kB, {} kB, {} MB; {} by {} ({})\n\n", m.cpu, m.cores, m.l1_bytes >> 10,
             m.l2_bytes >> 10, m.l3_bytes >> 20, m.target, m.compiler, m.flags);
  constexpr auto row = "{:<45} {:>8} {:>8} {:>8}  {:<8} {:>7} {:>9}  {}\n";
  print_output(row, "", "best", "median", "CPU", "unit", "of peak", "of memory", "bound by");
  for (const BenchResult& r : run.results) {
    print_output(row, r.name, number(r.value), number(r.median), number(r.cpu), r.unit, percent(r.of_peak),
               percent(r.of_bandwidth), r.bound);
  }
  for (const std::string& note : run.notes) print_output("{}\n", note);
}

/// Returns one entry of the results. Further keys can be added; these stay.
Json entry(const std::string& name, double value, std::string_view unit) {
  return {{"name", name}, {"value", value}, {"unit", unit}};
}

std::string to_json(const BenchRun& run) {
  const Machine& m = run.machine;
  Json json;
  json["machine"] = machine_json(m);
  json["machine"].update(
      {{"l1_bytes", m.l1_bytes}, {"l2_bytes", m.l2_bytes}, {"l3_bytes", m.l3_bytes}, {"clock_ghz", m.clock_ghz}});
  json["crowd"] = {{"people", run.people}, {"seed", BenchCrowd::seed}};
  auto& results = json["results"] = Json::array();
  for (const BenchResult& r : run.results) {
    auto& told = results.push_back(entry(r.name, r.value, r.unit));
    if (r.median) told["median"] = *r.median;
    if (r.cpu) told["cpu"] = *r.cpu;
    const std::string stem = r.name.substr(0, r.name.rfind('.'));
    if (r.of_peak) results.push_back(entry(stem + ".peak_fraction", *r.of_peak, "1"));
    if (r.of_bandwidth) results.push_back(entry(stem + ".bandwidth_fraction", *r.of_bandwidth, "1"));
  }
  return json.dump(2) + "\n";
}

int bench(const BenchText& text) {
  BenchRun run;
  const auto chosen = attempt([&] { return read_request(text, run); });
  if (!chosen) return first_by_environment() ? complain("bench", chosen.error().message) : 2;
  if (!first_by_environment()) return attempt([&] { bench_cluster(run); }) ? 0 : 1;
  run.machine = describe_machine();
  show("measuring the machine");
  measure_machine(run.machine);
  if (chosen->front().name != benches.front().name) bench_machine(run);  // reference for the others
  for (const Bench& one : *chosen) {
    show(fmt::format("measuring {}", one.name));
    if (auto done = attempt([&] { one.run(run); }); !done)
      return complain("bench", fmt::format("{}: {}", one.name, done.error().message), 1);
  }
  show("");
  print_table(run);
  return text.json ? exit_status_of("bench", write_result("--json", *text.json, to_json(run))) : 0;
}

}  // namespace

BenchCrowd* BenchRun::crowd() {
  return made_once(crowd_, people);
}

BenchCrowd* BenchRun::small_crowd() {
  if (people <= small_crowd_size) return nullptr;
  return made_once(small_crowd_, small_crowd_size);
}

BenchResult& BenchRun::add_time(std::string name, const Measured& time, double items, double unit_s, std::string unit) {
  const double scale = 1 / (items * unit_s);
  BenchResult& result = add_figure(std::move(name), time.best_s * scale, std::move(unit), "");
  result.median = time.median_s * scale;
  if (time.cpu_s) result.cpu = *time.cpu_s * scale;
  return result;
}

BenchResult& BenchRun::add_figure(std::string name, double value, std::string unit, std::string bound) {
  return results.emplace_back(
      BenchResult{.name = std::move(name), .value = value, .unit = std::move(unit), .bound = std::move(bound)});
}

std::string at_peak(const Machine& machine, double seconds) {
  return fmt::format("instructions; {:.0f} multiply-adds at peak take as long",
                     seconds * machine.fma_peak_gflops * 1e9 / 2);
}

void bench_machine(BenchRun& run) {
  const Machine& machine = run.machine;
  run.add_figure("machine.fma_peak_gflops", machine.fma_peak_gflops, "Gflop/s",
                 fmt::format("one core, single precision: {:.1f} operations a cycle of {:.2f} GHz",
                             machine.fma_peak_gflops / machine.clock_ghz, machine.clock_ghz))
      .median = machine.fma_peak_median_gflops;
  run.add_figure("machine.bandwidth_gbps", machine.bandwidth_gbps, "GB/s", "one core, triad").median =
      machine.bandwidth_median_gbps;
  run.add_figure("machine.bandwidth_all_cores_gbps", machine.all_cores_bandwidth_gbps, "GB/s",
                 fmt::format("{} cores at once", machine.cores))
      .median = machine.all_cores_bandwidth_median_gbps;
}

Subcommand bench_command() {
  auto text = std::make_shared<BenchText>();
  Subcommand command{.name = "bench"};
  command.footer =
      "Best: the least time (the highest rate) of the repeats, one thread; with --json it is the value. CPU: the\n"
      "least time that the thread had a processor; well below the best, other programs were at work. Of peak, of\n"
      "memory: operations and bytes in the best time, over what one core does at most; above 100 % the caches serve.\n"
      "crowd: people with eight muscles along 12 modes, nobody looking; a tenth as many as --people, as many, ten\n"
      "times as many (200000 at most). Its names: crowd.N.us_per_person_tick, crowd.N.compact.us_per_person_tick,\n"
      "crowd.large_over_small, crowd.compact.large_over_small, crowd.us_per_spawn.\n"
      "threads: the crowd by 1, 2, 4, … threads, and a model of more; its names: threads.unseen.N.speedup,\n"
      "threads.unseen.N.speedup_predicted, threads.unseen.N.fork_us, threads.unseen.serial_share, threads.compact.….\n"
      "cluster: messages between ranks, ticks with and without exchange, and a model of more ranks; --people on each.\n"
      "It measures two threads, or what mpirun starts: mpirun -n 2 mobil bench cluster.\n"
      "Example: mobil bench gait kinematics --people 2000 --json bench.json";
  command.options = {
      named_option(benches, text->names, "measure"),
      {"--people", &text->people, "How many walk, 1 to 200000, all different"},
      {"--quick", &text->quick, "One short round of fem, paper_figures and crowd: all figures, but not to be quoted"},
      {"--json", &text->json, "File for the figures"}};
  command.run = [text] { return bench(*text); };
  return command;
}

}  // namespace mobil
