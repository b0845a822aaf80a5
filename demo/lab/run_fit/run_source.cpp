#include "demo/lab/run_fit/run_source.h"

#include <fmt/format.h>

#include <iterator>
#include <span>

namespace mobil {
namespace {

template <class Numbers>
void append_numbers(const Numbers& numbers, std::size_t a_line, std::string& text) {
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) text += i % a_line == 0 ? ",\n       " : ", ";
    fmt::format_to(out, "{:#.6g}", numbers[i]);
  }
}

void append_floats(const std::string& name, std::span<const float> numbers, std::string& text) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "     .{} = {{", name);
  constexpr std::size_t a_line = 29;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers.size() > a_line && i % a_line == 0) text += "\n       ";
    fmt::format_to(out, "{:#.6g}F, ", numbers[i]);
  }
  text.pop_back();
  text += "},\n";
}

}  // namespace

std::string run_source(const std::vector<RunFitNode>& nodes) {
  std::string text =
      "// Written by `mobil-lab fit-run --out assets/gait/run_table.cpp` (sources: README.md). Do not edit.\n\n"
      "#include \"assets/gait/run_table.h\"\n\nnamespace mobil::inline v0_3 {\n\n// clang-format off\n"
      "const std::array<RunGiven, run_table::speed_count> run_given = {{\n";
  const auto out = std::back_inserter(text);
  for (std::size_t s = 0; s < run_table::speed_count; ++s) {
    const RunGiven& g = nodes[s * run_table::length_count].targets.given;
    fmt::format_to(out, "  {{{:#.6g}, {:#.6g}, ", g.frequency, g.duty);
    const auto list = [&](const auto& numbers, const char* after) {
      text += "{";
      append_numbers(numbers, numbers.size(), text);
      text += after;
    };
    list(g.tilt, "}, ");
    list(g.turn, "}, ");
    list(g.list, "},\n   ");
    list(g.shoulder, "}, ");
    list(g.elbow, "}},\n");
  }
  text += "}};\n\nconst RunNodes run_nodes = {{\n";
  for (std::size_t s = 0; s < run_table::speed_count; ++s) {
    text += "  {{\n";
    for (std::size_t l = 0; l < run_table::length_count; ++l) {
      fmt::format_to(out, "    // speed {:g}, length {:g}\n    {{\n", run_table::speed[s], run_table::length[l]);
      const RunNode node = table_node(nodes[s * run_table::length_count + l]);
      append_floats("shape", node.shape, text);
      append_floats("centre_ahead", node.centre_ahead, text);
      append_floats("centre_up", node.centre_up, text);
      text += "    },\n";
    }
    text += "  }},\n";
  }
  return text + "}};\n// clang-format on\n\n}  // namespace mobil::inline v0_3\n";
}

}  // namespace mobil
