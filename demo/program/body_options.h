#pragma once
// The options that every subcommand about one person shares: what body is asked for.

#include <array>
#include <string_view>

#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include "demo/program/options.h"

namespace mobil {

inline constexpr std::array<std::string_view, 4> constitution_name = {"thin", "average", "athletic", "heavy"};
inline constexpr std::array<std::string_view, 2> sex_name = {"man", "woman"};

/// As text, as the command line hands it over.
struct BodyText {
  std::string height = "1.75", mass = "75", biotype, constitution = "average", sex = "man";
};

std::vector<Option> body_options(BodyText& text);

/// Reads and checks them. Errors name the option, the valid range and the mend; whether the parts go together is for
/// make_body to say.
Result<BodyRequest> read_body_options(const BodyText& text);

}  // namespace mobil
