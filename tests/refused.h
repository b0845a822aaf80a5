#pragma once
// Matcher for refusals: an error of one line that names the reason.

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <string_view>

namespace mobil {

/// Succeeds if a result is an error whose message is one line and contains all `pieces`.
template <class Result, class... Pieces>
testing::AssertionResult is_refused(const Result& result, const Pieces&... pieces) {
  if (result) return testing::AssertionFailure() << "not refused";
  const std::string& line = result.error().message;
  if (line.empty() || line.find('\n') != line.npos) return testing::AssertionFailure() << "no line: " << line;
  for (const std::string_view piece : std::initializer_list<std::string_view>{pieces...})
    if (line.find(piece) == line.npos) return testing::AssertionFailure() << "no '" << piece << "' in: " << line;
  return testing::AssertionSuccess();
}

}  // namespace mobil
