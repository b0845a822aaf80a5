#include "demo/program/body_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "demo/program/units.h"

namespace mobil {
namespace {

Result<Biotype> read_biotype(const std::string& text) {
  if (text.empty()) return Biotype{};
  Biotype biotype;
  int used = 0;
  const int read = std::sscanf(text.c_str(), "%f-%f-%f%n", &biotype.endo, &biotype.meso, &biotype.ecto, &used);
  const bool whole = read == 3 && used == static_cast<int>(text.size());
  const auto valid = [](float part) { return part >= 0.1F && part <= 12.0F; };
  if (!whole || !valid(biotype.endo) || !valid(biotype.meso) || !valid(biotype.ecto)) {
    return fail(fmt::format("--biotype '{}': write endo-meso-ecto, each 0.1 to 12, like 2-5-3", text));
  }
  return biotype;
}

}  // namespace

void add_body_options(CLI::App& command, BodyText& text) {
  command.add_option("--height", text.height, "Stature, 1.2m to 2.2m")->capture_default_str()->group("Body");
  command.add_option("--mass", text.mass, "Body mass, 30kg to 200kg and what a living body of that height has")
      ->capture_default_str()
      ->group("Body");
  command.add_option("--biotype", text.biotype, "Heath-Carter endo-meso-ecto, like 2-5-3")->group("Body");
  command.add_option("--constitution", text.constitution, "thin, average, athletic or heavy")
      ->capture_default_str()
      ->group("Body");
}

Result<BodyRequest> read_body_options(const BodyText& text) {
  BodyRequest request;
  const auto height = read_value("--height", text.height, Quantity::length, 1.2, 2.2);
  if (!height) return tl::unexpected(height.error());
  request.height_m = static_cast<float>(*height);
  const auto mass = read_value("--mass", text.mass, Quantity::mass, 30, 200);
  if (!mass) return tl::unexpected(mass.error());
  request.mass_kg = static_cast<float>(*mass);
  const auto biotype = read_biotype(text.biotype);
  if (!biotype) return tl::unexpected(biotype.error());
  request.biotype = *biotype;
  const auto named = std::ranges::find(constitution_name, text.constitution);
  if (named == constitution_name.end()) {
    return fail(
        fmt::format("--constitution '{}': choose one of {}", text.constitution, fmt::join(constitution_name, ", ")));
  }
  request.constitution = static_cast<Constitution>(named - constitution_name.begin());
  return request;
}

void refuse_empty_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->get_items_expected() > 0; })) {
    option->check([](const std::string& value) {
      return value.empty() ? std::string("is empty; give a value or leave the option out") : std::string();
    });
  }
}

}  // namespace mobil
