#include "demo/program/body_options.h"

#include <mobil/anthropometry.h>
#include <mobil/body_composition.h>
#include "demo/program/units.h"

namespace mobil {
namespace {

Result<Biotype> read_biotype(const std::string& text) {
  if (text.empty()) return Biotype{};
  const auto parts = parse_list<3>(text, '-', 0.1, 12);
  if (!parts) return fail(fmt::format("--biotype '{}': write endo-meso-ecto, each 0.1 to 12, like 2-5-3", text));
  const auto [endo, meso, ecto] = *parts;
  return Biotype{static_cast<float>(endo), static_cast<float>(meso), static_cast<float>(ecto)};
}

}  // namespace

std::vector<Option> body_options(BodyText& text) {
  return {
      {"--height", &text.height, "Stature, 1.2m to 2.2m, by default 1.75m; children: in the range of that age", "Body"},
      {"--mass", &text.mass,
       "Body mass, 30kg to 200kg, by default 75kg, in the range of real bodies of that height and age", "Body"},
      {"--biotype", &text.biotype, "Heath-Carter endo-meso-ecto, like 2-5-3", "Body"},
      {"--constitution", &text.constitution, "thin, average, athletic or heavy", "Body", words_of(constitution_name)},
      {"--sex", &text.sex, "man or woman: proportions, fat, muscle, skin and manner of walking", "Body",
       words_of(sex_name)},
      {"--age", &text.age, "Age, 6 to 95 years, in half years", "Body"},
      {"--typical", &text.typical, "Set the median height and mass, and the usual speed, of that sex and age", "Body"}};
}

Result<BodyRequest> read_body_options(const BodyText& text) {
  BodyRequest request;
  OptionReader read;
  request.sex = read(choose<Sex>("--sex", text.sex, sex_name));
  request.age_y = static_cast<float>(read(read_value("--age", text.age, Quantity::ratio, 6, 95)));
  if (text.typical) {
    if (text.height || text.mass) read.refuse("--typical sets height and mass; give it without --height and --mass");
    request = typical_body(request.sex, request.age_y);
  }
  if (text.height) {
    const auto [low, high] = living_height_m(request.sex, request.age_y);
    request.height_m = static_cast<float>(read(read_value("--height", *text.height, Quantity::length, low, high)));
  }
  if (text.mass) {
    const double least = half_years(request.age_y) < 18 ? 12 : 30;
    request.mass_kg = static_cast<float>(read(read_value("--mass", *text.mass, Quantity::mass, least, 200)));
  }
  request.biotype = read(read_biotype(text.biotype));
  request.constitution = read(choose<Constitution>("--constitution", text.constitution, constitution_name));
  return read.result(request);
}

}  // namespace mobil
