#pragma once
// The options that every subcommand about one person shares: what body is asked for.

#include <CLI/CLI.hpp>
#include <array>
#include <string>
#include <string_view>

#include "components/body.h"
#include "engine/error.h"

namespace mobil {

inline constexpr std::array<std::string_view, 4> constitution_name = {"thin", "average", "athletic", "heavy"};

/// As text, as the command line hands it over.
struct BodyText {
  std::string height = "1.75", mass = "75", biotype, constitution = "average";
};

void add_body_options(CLI::App& command, BodyText& text);

/// Reads and checks them. Errors name the option, the valid range and the mend; whether the parts go together is for
/// make_body to say.
Result<BodyRequest> read_body_options(const BodyText& text);

/// An option without a value, as scripts leave it, is an error of its own; call after all options were added.
void refuse_empty_values(CLI::App& command);

}  // namespace mobil
