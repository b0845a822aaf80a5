// demo/program/json.h compared with the full JSON library: equal text from equal calls.
#include "demo/program/json.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace mobil::json_test {
template <class J>
J values() {
  J json;
  json["texts"] = {{"literal", "a"}, {"string", std::string("b")}, {"view", std::string_view("c\"\n\t")}};
  json["numbers"] = {0.0, -0.0, 0.1, 1e-5, 1e15, 1e16, 1e300, 123456789012345678.0};
  json["float"] = 0.1F;
  json["whole"] = {{"least", std::int64_t{-3}},
                   {"most", std::numeric_limits<std::uint64_t>::max()},
                   {"small", std::uint8_t{7}},
                   {"apart", std::ptrdiff_t{4}}};
  json["no_numbers"] = {NAN, std::numeric_limits<double>::infinity()};
  json["flags"] = {true, false, nullptr};
  return json;
}

template <class J>
J shapes() {
  const std::string_view name = "named";
  J json = {{"two_texts", {"right", "left"}}, {"one", {{"member", 1}}}};
  json["no_items"] = std::vector<std::string>{};
  json["items"] = std::vector<std::string>{"ä", "b"};
  json["points"] = std::array{1.5, 2.5};
  json["no_members"] = J::object();
  json["deep"]["deeper"]["deepest"] = 1;
  auto& rows = json["rows"] = J::array();
  for (int i = 0; i < 3; ++i) rows.push_back({{"i", i}, {"list", {i, i + 1}}});
  json["made"].push_back({{"x", 1}});
  J more = {{name, 3.25}};
  more.update({{"new", 1}, {"named", 2}});
  json["updated"] = more;
  json["copied"] = json["rows"];
  json["two_texts"] = J();
  return json;
}

TEST(Json, MatchesTheLibrarysText) {
  EXPECT_EQ(values<Json>().dump(2), values<nlohmann::ordered_json>().dump(2));
  EXPECT_EQ(shapes<Json>().dump(2), shapes<nlohmann::ordered_json>().dump(2));
  EXPECT_EQ(shapes<Json>().dump(1), shapes<nlohmann::ordered_json>().dump(1));
}

TEST(Json, RoundTripsThroughTheLibrary) {
  const auto read = nlohmann::json::parse(values<Json>().dump(2));
  EXPECT_EQ(read["texts"]["view"], "c\"\n\t");
  EXPECT_EQ(read["numbers"][3], 1e-5);
  EXPECT_EQ(read["whole"]["most"], std::numeric_limits<std::uint64_t>::max());
  EXPECT_TRUE(read["no_numbers"][0].is_null());
  EXPECT_EQ(nlohmann::json::parse(shapes<Json>().dump(2))["updated"], (nlohmann::json{{"named", 2}, {"new", 1}}));
}

}  // namespace mobil::json_test
