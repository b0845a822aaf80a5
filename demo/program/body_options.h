#pragma once
// Options of the body, shared by all subcommands about one person.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include "demo/program/options.h"

namespace mobil {

inline constexpr std::array<std::string_view, 4> constitution_name = {"thin", "average", "athletic", "heavy"};
inline constexpr std::array<std::string_view, 2> sex_name = {"man", "woman"};

/// Options as text from the command line.
struct BodyText {
  std::optional<std::string> height, mass;  // unset: 1.75 m, 75 kg
  std::string biotype, constitution = "average", sex = "man", age = "25";
  bool typical = false;
};

std::vector<Option> body_options(BodyText& text);

/// Reads and checks the options. Errors name the option, the valid range and the remedy. make_body checks the
/// combination.
Result<BodyRequest> read_body_options(const BodyText& text);

}  // namespace mobil
