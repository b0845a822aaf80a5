#include "demo/program/body_options.h"

#include <fmt/format.h>

#include "demo/program/choice.h"
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
      {"--height", &text.height, "Stature, 1.2m to 2.2m", "Body"},
      {"--mass", &text.mass, "Body mass, 30kg to 200kg and what a living body of that height has", "Body"},
      {"--biotype", &text.biotype, "Heath-Carter endo-meso-ecto, like 2-5-3", "Body"},
      {"--constitution", &text.constitution, "thin, average, athletic or heavy", "Body", words_of(constitution_name)},
      {"--sex", &text.sex, "man or woman: whose girths and face the skin has", "Body", words_of(sex_name)}};
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
  const auto constitution = choose<Constitution>("--constitution", text.constitution, constitution_name);
  if (!constitution) return tl::unexpected(constitution.error());
  request.constitution = *constitution;
  const auto sex = choose<Sex>("--sex", text.sex, sex_name);
  if (!sex) return tl::unexpected(sex.error());
  request.sex = *sex;
  return request;
}

}  // namespace mobil
