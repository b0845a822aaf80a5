#include "demo/program/console.h"
#include "demo/schedule/schedule_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include "demo/program/commands.h"

namespace mobil {
namespace {

constexpr double row_height = 17, column_width = 15, mark = 9, margin = 12, letter_width = 6.1;
constexpr double legend_height = 40;
constexpr double slope = 0.5;  // of the columns' names: sine of 30°, their angle from the vertical

/// A column: the systems that access it, and their modes.
struct Touched {
  struct By {
    std::size_t system;
    Access::Mode mode;
  };

  std::uint64_t id;
  std::string_view name;
  std::vector<By> by;

  std::size_t first_writer() const {
    const auto writer = std::ranges::find(by, Access::Mode::write, &By::mode);
    return writer == by.end() ? 0 : 1 + writer->system;
  }
};

std::vector<Touched> touched_by(std::span<const System> systems) {
  std::vector<Touched> all;
  for (std::size_t s = 0; s < systems.size(); ++s) {
    for (const Access& access : systems[s].accesses) {
      if (access.mode == Access::Mode::none) continue;
      auto at = std::ranges::find(all, access.id, &Touched::id);
      if (at == all.end()) at = all.insert(at, {access.id, plain_name(access.name), {}});
      at->by.push_back({s, access.mode});
    }
  }
  std::ranges::stable_sort(all, {}, &Touched::first_writer);
  return all;
}

class Picture {
 public:
  explicit Picture(const Schedule& schedule)
      : systems_(schedule.systems()),
        before_(schedule.before()),
        after_(schedule.after()),
        passes_(schedule.passes()),
        columns_(touched_by(schedule.systems())) {
    std::size_t longest = 0, longest_column = 0;
    for (const System& system : systems_) longest = std::max(longest, system.name.size());
    for (const auto phases : {before_, after_})
      for (const TimedPhase& one : phases) longest = std::max(longest, one.phase.name.size());
    for (const Touched& column : columns_) longest_column = std::max(longest_column, column.name.size());
    left_ = margin + 18 + letter_width * static_cast<double>(longest) + 10;
    const double name = letter_width * static_cast<double>(longest_column);
    head_ = margin + legend_height + 0.87 * name + 8;
    top_ = head_ + row_height * static_cast<double>(before_.size());
    right_ = slope * name;
  }

  std::string text() {
    const double inner = column_width * static_cast<double>(columns_.size());
    const double width = left_ + inner + right_ + margin;
    const double height = top_ + row_height * static_cast<double>(systems_.size() + after_.size()) + margin;
    add(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" font-family="Helvetica, Arial, sans-serif" font-size="11" fill="#333"><rect width="100%" height="100%" fill="#fff"/>)",
        width, height);
    for (std::size_t p = 0; p < passes_.size(); ++p) draw_pass(p, inner);
    draw_phases(before_, head_);
    draw_phases(after_, row_y(systems_.size()) - row_height / 2);
    for (std::size_t c = 0; c < columns_.size(); ++c) draw_column(c);
    draw_legend();
    text_ += "</svg>\n";
    return std::move(text_);
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
    text_ += '\n';
  }

  double row_y(std::size_t system) const { return top_ + row_height * (static_cast<double>(system) + 0.5); }
  double column_x(std::size_t column) const { return left_ + column_width * (static_cast<double>(column) + 0.5); }

  void draw_pass(std::size_t p, double inner) {
    const auto [first, last] = passes_[p];
    const double y = top_ + row_height * static_cast<double>(first);
    const double height = row_height * static_cast<double>(last - first);
    add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)", margin, y, left_ - margin + inner,
        height, p % 2 == 0 ? "#f3f5f8" : "#fff");
    add(R"(<text x="{:.1f}" y="{:.1f}" font-weight="600">{}</text>)", margin + 3, y + row_height / 2 + 4, p + 1);
    for (std::size_t s = first; s < last; ++s) {
      add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)", left_ - 8, row_y(s) + 4, systems_[s].name);
    }
  }

  void draw_phases(std::span<const TimedPhase> phases, double y) {
    for (const TimedPhase& one : phases) {
      add(R"(<text class="phase" x="{:.1f}" y="{:.1f}" text-anchor="end" font-style="italic" fill="#666">{}</text>)",
          left_ - 8, y + row_height / 2 + 4, one.phase.name);
      y += row_height;
    }
  }

  void draw_column(std::size_t c) {
    const Touched& column = columns_[c];
    const double x = column_x(c);
    add(R"|(<text transform="translate({:.1f} {:.1f}) rotate(-60)">{}</text>)|", x + 4, head_ - 5, column.name);
    const auto [first, last] = std::ranges::minmax(column.by, {}, &Touched::By::system);
    add(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1:.1f}" y2="{2:.1f}" stroke="#c3c9d2"/>)", x, row_y(first.system),
        row_y(last.system));
    for (const Touched::By& by : column.by) draw_mark(by.mode, x, row_y(by.system));
  }

  /// Draws a mark. Modes differ in shape, and in colours that colour-blind people can distinguish.
  void draw_mark(Access::Mode mode, double x, double y) {
    constexpr double half = mark / 2;
    switch (mode) {
      case Access::Mode::write:
        return add(R"(<rect class="write" x="{:.1f}" y="{:.1f}" width="{}" height="{}" fill="#d55e00"/>)", x - half,
                   y - half, mark, mark);
      case Access::Mode::read:
        return add(R"(<circle class="read" cx="{:.1f}" cy="{:.1f}" r="{}" fill="#0072b2"/>)", x, y, half - 0.5);
      case Access::Mode::previous:
        return add(R"(<path class="previous" d="M{:.1f} {:.1f}l{} {}l{} 0z" fill="#56b4e9" stroke="#0072b2"/>)", x,
                   y - half, half, mark, -mark);
      case Access::Mode::lookup:
        return add(
            R"(<circle class="lookup" cx="{:.1f}" cy="{:.1f}" r="{}" fill="#fff" stroke="#0072b2" stroke-width="2"/>)",
            x, y, half - 1);
      case Access::Mode::none:
        return;
    }
  }

  void draw_legend() {
    constexpr std::pair<Access::Mode, std::string_view> marks[] = {{Access::Mode::write, "writes"},
                                                                   {Access::Mode::read, "reads its own rows"},
                                                                   {Access::Mode::previous, "reads the previous tick"},
                                                                   {Access::Mode::lookup, "looks up in other rows"}};
    double x = margin + 6;
    for (const auto& [mode, words] : marks) {
      draw_mark(mode, x, margin + 6);
      add(R"(<text x="{:.1f}" y="{:.1f}">{}</text>)", x + 9, margin + 10, words);
      x += 30 + letter_width * static_cast<double>(words.size());
    }
    add(R"(<text x="{:.1f}" y="{:.1f}">{}</text>)", margin, margin + 28,
        "Numbers: passes, between which threads wait for each other. Italics: phases, one at a time.");
  }

  std::span<const System> systems_;
  std::span<const TimedPhase> before_, after_;
  std::span<const SystemRange> passes_;
  std::vector<Touched> columns_;
  double left_, head_, top_, right_;
  std::string text_;
};

Result<void> show_schedule(const std::optional<std::string>& svg) {
  const Simulation simulation;
  if (svg) {
    if (auto place = check_result_place("--svg", *svg); !place) return place;
    return write_result("--svg", *svg, schedule_picture(simulation.schedule()));
  }
  write_output(simulation.schedule().describe());
  return {};
}

}  // namespace

std::string schedule_picture(const Schedule& schedule) {
  return Picture(schedule).text();
}

Subcommand schedule_command() {
  auto svg = std::make_shared<std::optional<std::string>>();
  Subcommand command{.name = "schedule"};
  command.footer =
      "Shows the schedule itself, whose order follows from the reads and writes of systems. A system\n"
      "without rows takes no time. For a host's own schedule call simulation.schedule().describe().\n"
      "\nExamples: mobil schedule\n"
      "          mobil schedule --svg schedule.svg";
  add_options(command, {{"--svg", svg.get(), "Write a picture to this FILE instead of printing text"}});
  command.run = [svg] { return exit_status_of("schedule", show_schedule(*svg)); };
  return command;
}

}  // namespace mobil
