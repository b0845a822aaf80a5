// `mobil-lab fit-run`: fits the table of running steps to measured running and writes it as source.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>

#include <mobil/assets/files/output_file.h>
#include <mobil/engine/error.h>
#include "demo/lab/run_fit/run_source.h"
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/must.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

namespace table = run_table;

struct RunFitText {
  std::string out;
  std::size_t threads = 0;
};

void print_run(const RunFitNode& node, double length) {
  const RunShape shape = fitted(tabled(node.shape));
  const RunQuality q = run_quality(node.task, node.targets, std::nullopt, shape);
  print_note("{:>5.2f} {:>5.2f} {:>6.2f}  {:.1f} {:.1f} {:.1f}  {:.3f} {:.3f}  {:.3f} {:.3f} {:.3f}  ",
             node.task.speed_m_s, length, node.cost, q.match[0].rms, q.match[1].rms, q.match[2].rms,
             q.match[4].correlation, q.match[5].correlation, q.match[6].correlation, q.match[7].correlation,
             q.match[8].correlation);
  print_note("{:.3f} {:.2f} {:.3f} {:.3f} {:.2f} ", q.pitch_rms, q.pitch_max, q.roll_rms, q.yaw_flight_rms, q.free_max);
  for (const double m : {q.outside_m, q.aside_m, q.slack_m, q.clearance_m, q.rise_m}) print_note("{:>6.1f}", 1000 * m);
  print_note(" {:>5.1f}\n", q.lean_deg);
}

void print_runs(const std::vector<RunFitNode>& nodes) {
  print_note("\n{:>5} {:>5} {:>6}  {:<11}  {:<11}  {:<17}  {:<27} {:>6}{:>6}{:>6}{:>6}{:>6} {:>5}\n", "m/s", "length",
             "cost", "angles, deg", "forces, r", "moments, r", "pitch, roll, yaw, free", "CoP", "aside", "slack",
             "clear", "rise", "lean");
  for (std::size_t i = 0; i < nodes.size(); ++i) print_run(nodes[i], table::length[i % table::length_count]);
  print_note(
      "pitch, roll, yaw: moments left over, N m/kg: rms and maximum, rms, rms in flight; the free moment's maximum\n");
  print_note("CoP: most that the centre of pressure is beyond the sole; aside: from the foot's line, mm\n");
}

void run_run_fit(const RunFitText& text) {
  const Threads threads(static_cast<int>(text.threads));
  const auto nodes = fit_runs(threads.jobs(), [](std::string_view stage, double cost) {
    show(fmt::format("{}: sum of squares {:.2f}", stage, cost));
  });
  show("");
  must(write_file(text.out, run_source(nodes)));
  print_runs(nodes);
  say_where(fmt::format("look at {}", text.out));
}

}  // namespace

Subcommand run_fit_command() {
  auto text = std::make_shared<RunFitText>();
  Subcommand command{.name = "fit-run"};
  command.footer =
      "For those who change the library: some minutes. Prints how near each running step is to what it was fitted to.\n"
      "Example: mobil fit-run --out assets/gait/run_table.cpp";
  add_options(command, {{"--out", &text->out, "Source file to write"},
                        {"--threads", &text->threads, "0: as many as the machine has"}});
  command.run = [text] { return exit_status_of("fit-run", attempt([&] { run_run_fit(*text); })); };
  return command;
}

}  // namespace mobil
