#include "assets/finite/packed_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace mobil::inline v0_3 {
namespace {

/// Adds items to a text, separated and broken into lines.
struct LineBreaker {
  std::string text;
  std::size_t column = 0;

  void add(std::string_view item) {
    if (column + item.size() > 118) {
      text += '\n';
      column = 0;
    }
    text += item;
    column += item.size();
  }
};

}  // namespace

Result<PackedShapes> pack_shapes(const ShapeTable& table) {
  const bool fits = table.vector.size() == shape_modes &&
                    std::all_of(table.vector.begin(), table.vector.end(),
                                [](const auto& vector) { return vector.size() == packed_numbers; });
  if (!fits) return fail("a table is packed with six modes over 2x2x8 control cells; fit it so");
  PackedShapes packed{};
  for (std::size_t v = 0; v < shape_modes; ++v) {
    double most = 1e-30;
    for (const double x : table.vector[v]) most = std::max(most, std::abs(x));
    // coarser than 16 bits allow: visible motion is about 10 mm, and four digits of that are 1 µm
    packed.unit_m[v] = static_cast<float>(most / 9999);
    const auto unit = static_cast<double>(packed.unit_m[v]);
    for (std::size_t i = 0; i < packed_numbers; ++i) {
      packed.vector[v][i] = static_cast<std::int16_t>(std::lround(table.vector[v][i] / unit));
    }
    for (std::size_t t = 0; t < shape_ratio_terms; ++t) {
      for (std::size_t f = 0; f < shape_amount_count; ++f) {
        packed.coefficient[v][t * shape_amount_count + f] = static_cast<float>(table.coefficient[t][v][f]);
      }
    }
  }
  return packed;
}

ShapeTable unpack_shapes(const PackedShapes& packed) {
  ShapeTable table;
  for (auto& term : table.coefficient) term.resize(shape_modes);
  for (std::size_t v = 0; v < shape_modes; ++v) {
    auto& vector = table.vector.emplace_back(packed_numbers);
    for (std::size_t i = 0; i < packed_numbers; ++i) {
      vector[i] = static_cast<double>(packed.unit_m[v]) * packed.vector[v][i];
    }
    for (std::size_t t = 0; t < shape_ratio_terms; ++t) {
      for (std::size_t f = 0; f < shape_amount_count; ++f) {
        table.coefficient[t][v][f] = static_cast<double>(packed.coefficient[v][t * shape_amount_count + f]);
      }
    }
  }
  return table;
}

std::string initialiser(const PackedShapes& packed) {
  const auto number = [](float x) {
    const std::string digits = fmt::format("{:.5g}", static_cast<double>(x));
    return fmt::format("{}{}", digits, digits.find_first_of(".e") == std::string::npos ? ".0F" : "F");
  };
  LineBreaker out;
  const auto list = [&out](const auto& items, const auto& show) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      out.add(fmt::format("{}{}{}", i == 0 ? "{" : "", show(items[i]), i + 1 == items.size() ? "}" : ","));
    }
  };
  const auto lists = [&](const auto& rows, const auto& show) {
    out.add("{{");
    for (std::size_t r = 0; r < rows.size(); ++r) {
      out.add("{");
      list(rows[r], show);
      out.add(r + 1 == rows.size() ? "}" : "},");
    }
    out.add("}}");
  };
  out.add("{{");
  list(packed.unit_m, number);
  out.add("},");
  lists(packed.vector, [](std::int16_t x) { return fmt::format("{}", x); });
  out.add(",");
  lists(packed.coefficient, number);
  out.add("}\n");
  return out.text;
}

}  // namespace mobil::inline v0_3
