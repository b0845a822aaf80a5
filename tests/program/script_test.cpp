// Quantities, gait parameters and scripts of walks have their documented meaning for random values. Invalid ones are
// refused in one line that names the place and the range.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/usual_gait.h>
#include "assets/gait/step_lookup.h"
#include "demo/program/units.h"
#include "demo/walk/gait_parameters.h"
#include "demo/walk/walk_script.h"
#include "systems/gait/gait.h"

namespace mobil::script_test {
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_); }
  bool coin() { return below(2) == 1; }

 private:
  std::mt19937 engine_;
};

template <class Property>
void over_random_seeds(const std::string& name, const Property& property) {
  ASSERT_TRUE(rc::check(name, [&] {
    Dice dice(*rc::gen::arbitrary<unsigned>());
    property(dice);
  }));
}

bool holds(const std::string& text, const std::string& piece) {
  return text.find(piece) != std::string::npos;
}

// ------------------------------------------------------------------------------------------------- quantities

struct KnownUnit {
  Quantity quantity;
  const char* name;
  double base;
};
const std::vector<KnownUnit> known_units = {{Quantity::length, "m", 1},
                                            {Quantity::length, "cm", 1e-2},
                                            {Quantity::length, "ft", 12 * 0.0254},
                                            {Quantity::mass, "kg", 1},
                                            {Quantity::mass, "g", 1e-3},
                                            {Quantity::speed, "m/s", 1},
                                            {Quantity::speed, "km/h", 1 / 3.6},
                                            {Quantity::frequency, "Hz", 1},
                                            {Quantity::frequency, "steps/min", 1 / 60.0},
                                            {Quantity::time, "s", 1},
                                            {Quantity::time, "min", 60},
                                            {Quantity::angle, "deg", 1},
                                            {Quantity::pressure, "Pa", 1},
                                            {Quantity::pressure, "kPa", 1000},
                                            {Quantity::density, "kg/m3", 1},
                                            {Quantity::rate, "/s", 1},
                                            {Quantity::stiffness, "kN/m", 1000},
                                            {Quantity::ratio, "", 1},
                                            {Quantity::angle, "rad", 180 / std::numbers::pi}};

TEST(Quantities, ReadBackInEveryUnitAndWithoutOne) {
  over_random_seeds("number and unit", [](Dice& dice) {
    for (const auto& unit : known_units) {
      const double value = (dice.coin() ? 1 : -1) * std::pow(10.0, dice(-12, 12));
      const std::string space(dice.below(3), ' ');
      const auto read = parse_quantity(fmt::format("{}{}{}", value, space, unit.name), unit.quantity);
      if (!read) RC_FAIL(read.error().message);
      RC_ASSERT(std::abs(*read - value * unit.base) <= 1e-15 * std::abs(*read));
      RC_ASSERT(parse_quantity(fmt::format("{}", value), unit.quantity).value() == value);
    }
  });
}

TEST(Quantities, WrongUnitIsRefusedAndValidUnitsAreListed) {
  for (const auto& unit : known_units) {
    for (const auto& other : known_units) {
      if (other.quantity == unit.quantity || *other.name == '\0') continue;
      const auto read = parse_quantity(fmt::format("1{}", other.name), unit.quantity);
      ASSERT_FALSE(read.has_value()) << other.name;
      EXPECT_TRUE(holds(read.error().message, std::string(base_unit(unit.quantity)))) << read.error().message;
      EXPECT_TRUE(holds(read.error().message, other.name)) << read.error().message;
    }
    for (const std::string text : {"", " ", "nan", "inf", "-inf", "1e999", "m", "--1"}) {
      EXPECT_FALSE(parse_quantity(text, unit.quantity).has_value()) << text;
    }
  }
}

// --------------------------------------------------------------------------------------------- gait parameters

TEST(GaitParameters, PrintedTableCanBeReadBack) {
  std::istringstream lines(gait_parameter_table());
  std::vector<std::string> listed;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::string name, standard, low, high, unit, meaning;
    cells >> name >> standard >> low >> high >> unit;
    std::getline(cells >> std::ws, meaning);
    const GaitParameter* parameter = find_gait_parameter(name);
    if (parameter == nullptr) continue;
    listed.push_back(name);
    EXPECT_EQ(unit, parameter->unit);
    EXPECT_EQ(meaning, parameter->meaning);
    EXPECT_LE(line.size(), 120U) << line;
    GaitStyle style;
    for (const auto& [text, value] : {std::pair{low, parameter->low}, std::pair{high, parameter->high},
                                      std::pair{standard, GaitStyle{}.*parameter->value}}) {
      const auto done = set_gait_parameter(name + "=" + text, style);
      EXPECT_TRUE(done.has_value()) << (done ? "" : done.error().message);
      EXPECT_EQ(style.*parameter->value, value) << line;
    }
  }
  EXPECT_EQ(listed, gait_parameter_names());
}

TEST(GaitParameters, SettingChangesOnlyThatParameter) {
  over_random_seeds("settings", [](Dice& dice) {
    GaitStyle style, expected;
    for (int i = 0; i < 5; ++i) {
      const GaitParameter& p = gait_parameters[dice.below(gait_parameters.size())];
      const auto value = std::clamp(static_cast<float>(dice(p.low, p.high)), p.low, p.high);
      const bool with_unit = (p.unit == "deg" || p.unit == "m" || p.unit == "N/m") && dice.coin();
      RC_ASSERT(set_gait_parameter(fmt::format("{}={}{}", p.name, value, with_unit ? p.unit : ""), style).has_value());
      expected.*p.value = value;
      for (const GaitParameter& q : gait_parameters) RC_ASSERT((style.*q.value) == (expected.*q.value));
    }
  });
}

TEST(GaitParameters, OutsideTheRangeIsRefusedWithTheRange) {
  over_random_seeds("beyond", [](Dice& dice) {
    for (const GaitParameter& p : gait_parameters) {
      const double beyond = (p.high - p.low) * dice(0.001, 10);
      GaitStyle style;
      const auto done =
          set_gait_parameter(fmt::format("{}={}", p.name, dice.coin() ? p.low - beyond : p.high + beyond), style);
      RC_ASSERT(!done.has_value());
      RC_ASSERT(done.error().message.starts_with(p.name));
      RC_ASSERT(holds(done.error().message, fmt::format("{} to {}", p.low, p.high)));
      RC_ASSERT((style.*p.value) == (GaitStyle{}.*p.value));
    }
  });
}

TEST(GaitParameters, MissingLetterIsCorrected) {
  for (const GaitParameter& p : gait_parameters) {
    for (std::size_t i = 0; i < p.name.size(); ++i) {
      std::string name(p.name);
      name.erase(i, 1);
      GaitStyle style;
      const auto done = set_gait_parameter(name + "=1", style);
      ASSERT_FALSE(done.has_value()) << name;
      EXPECT_TRUE(holds(done.error().message, fmt::format("did you mean {}?", p.name))) << done.error().message;
      EXPECT_TRUE(holds(done.error().message, "--list-parameters")) << done.error().message;
    }
  }
}

// ----------------------------------------------------------------------------------------------------- scripts

constexpr float height_m = 1.75F;
const Body& body() {
  static const Body made = *make_body({.height_m = height_m});
  return made;
}

/// The documented rules of --help: the walk between two changes.
struct Expected {
  double speed = 0, length = 0, right = 0, left = 0;
  GaitStyle style;
  double heading_deg = 0;
  void even(double mean) {
    length = mean;
    right = mean * (1 + static_cast<double>(style.step_asymmetry));
    left = mean * (1 - static_cast<double>(style.step_asymmetry));
  }
  static double natural(double speed) {
    const double leg = make_body({.height_m = height_m})->hip_height_m;
    return shod_step_factor * usual_step_length(static_cast<float>(speed / std::sqrt(9.81 * leg))) * leg;
  }
};

using Rows = std::vector<std::pair<std::string, std::string>>;

/// Returns the rows of one time and applies them to the walk before. Values are far from the body's limits.
Rows random_change(Dice& dice, Expected& walk) {
  Rows rows;
  const auto add = [&](const std::string& name, double value, const std::string& unit = "", double one = 1) {
    rows.emplace_back(name, fmt::format("{}{}", value / one, unit));
  };
  const double speed = dice(1.2, 1.5), length = dice(0.6, 0.8), frequency = dice(1.8, 2.0);
  const bool stands = walk.speed == 0;
  switch (dice.below(stands ? 4 : 9)) {
    case 0:
      add("speed", speed, "km/h", 1 / 3.6);
      walk.speed = speed;
      walk.even(Expected::natural(speed));
      break;
    case 1:
      add("step_length", length, "cm", 0.01);
      add("step_frequency", frequency, "steps/min", 1 / 60.0);
      walk.speed = length * frequency;
      walk.even(length);
      break;
    case 2:
      add("speed", speed);
      add("step_length", length);
      walk.speed = speed;
      walk.even(length);
      break;
    case 3:
      walk.heading_deg = dice(-360, 360);
      add("heading", walk.heading_deg);
      break;
    case 4:
      add("step_length", length);
      walk.even(length);
      break;
    case 5:
      add("step_frequency", frequency);
      walk.even(walk.speed / frequency);
      break;
    case 6:
      rows.push_back(std::array<Rows::value_type, 3>{{{"stop", ""}, {"stop", "1"}, {"speed", "0km/h"}}}[dice.below(3)]);
      walk.speed = 0;
      break;
    case 7:
      walk.right = length;
      add("step_length_right", length);
      if (dice.coin()) {
        walk.left = dice(0.6, 0.8);
        add("step_length_left", walk.left);
      }
      walk.length = (walk.right + walk.left) / 2;
      walk.style.step_asymmetry = static_cast<float>((walk.right - walk.left) / (walk.right + walk.left));
      break;
    default:
      walk.left = length;
      add("step_length_left", length, "mm", 0.001);
      walk.length = (walk.right + walk.left) / 2;
      walk.style.step_asymmetry = static_cast<float>((walk.right - walk.left) / (walk.right + walk.left));
  }
  if (dice.coin()) {
    walk.style.toe_out_deg = static_cast<float>(dice(-15, 30));
    add("toe_out_deg", static_cast<double>(walk.style.toe_out_deg), dice.coin() ? "deg" : "");
  }
  if (dice.coin()) std::reverse(rows.begin(), rows.end());
  return rows;
}

TEST(Script, ChangesFollowTheRulesOfHelp) {
  over_random_seeds("scripts", [](Dice& dice) {
    const GaitRequest start{.speed_m_s = 1.4F};
    Expected walk;
    walk.speed = 1.4;
    walk.even(Expected::natural(1.4));
    std::string text = "time_s,parameter,value\n";
    std::vector<double> times;
    std::vector<Expected> expected;
    double time = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      for (const auto& [name, value] : random_change(dice, walk)) text += fmt::format("{},{},{}\n", time, name, value);
      times.push_back(time);
      expected.push_back(walk);
      time += dice(0.01, 2);
    }
    const auto script = parse_walk_script(text, "random.csv");
    if (!script) RC_FAIL(script.error().message);
    const auto changes = plan_changes(*script, body(), start);
    if (!changes) RC_FAIL(changes.error().message + "\n" + text);
    RC_ASSERT(changes->size() == expected.size());
    GaitRequest request = start;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const ScriptedChange& change = (*changes)[i];
      const Expected& e = expected[i];
      RC_ASSERT(change.time_s == times[i]);
      if (change.gait) request = *change.gait;
      if (change.heading_rad)
        RC_ASSERT(std::abs(static_cast<double>(*change.heading_rad) * 180 / std::numbers::pi - e.heading_deg) < 1e-4);
      RC_ASSERT(request.style.toe_out_deg == e.style.toe_out_deg);
      RC_ASSERT(std::abs(request.style.step_asymmetry - e.style.step_asymmetry) < 1e-5F);
      if (e.speed == 0) {
        RC_ASSERT(request.speed_m_s == 0.0F);
        RC_ASSERT(!request.step_length_m && !request.step_frequency_hz);
        continue;
      }
      const auto gait = resolve_gait(body(), request);
      RC_ASSERT(gait.has_value());
      const double mean = gait->step_length_m, a = gait->style.step_asymmetry;
      RC_ASSERT(std::abs(gait->speed_m_s - e.speed) < 1e-5);
      RC_ASSERT(std::abs(mean - e.length) < 1e-5);
      RC_ASSERT(std::abs(mean * (1 + a) - e.right) < 1e-5);
      RC_ASSERT(std::abs(mean * (1 - a) - e.left) < 1e-5);
    }
  });
}

/// Required text of the message, in addition to file and line.
struct Bad {
  Rows rows;  // at one time
  std::string piece;
};

TEST(Script, BadRowIsRefusedByFileAndLine) {
  const std::vector<Bad> all_bad = {
      {{{"speedd", "1"}}, "did you mean speed?"},
      {{{"toe_out", "1"}}, "did you mean toe_out_deg?"},
      {{{"", "1"}}, "--list-parameters"},
      {{{"speed", ""}}, "speed ''"},
      {{{"speed", "5kg"}}, "km/h"},
      {{{"speed", "nan"}}, "'nan'"},
      {{{"speed", "40"}}, "0 to 10 m/s"},
      {{{"speed", "5"}}, "m/s for a height of"},
      {{{"speed", "-1"}}, "0 to 10 m/s"},
      {{{"step_length", "2"}}, "m for a height of"},
      {{{"step_length", "0"}}, "0.01 to 3 m"},
      {{{"step_frequency", "50"}}, "0.01 to 10 Hz"},
      {{{"heading", "361"}}, "-360 to 360 deg"},
      {{{"stop", "0"}}, "empty"},
      {{{"pelvis_list_deg", "11"}}, "0 to 10 deg"},
      {{{"step_length_left", "0.2"}}, "step_asymmetry"},
      {{{"speed", "1"}, {"speed", "1.1"}}, "speed of line"},
      {{{"toe_out_deg", "1"}, {"toe_out_deg", "2"}}, "toe_out_deg of line"},
      {{{"stop", ""}, {"speed", "1.1"}}, "stop of line"},
      {{{"step_length", "0.7"}, {"step_length_left", "0.7"}}, "step_length of line"},
      {{{"step_asymmetry", "0"}, {"step_length_right", "0.7"}}, "step_asymmetry of line"}};
  over_random_seeds("bad rows", [&](Dice& dice) {
    const Bad& bad = all_bad[dice.below(all_bad.size())];
    std::string text = "time_s,parameter,value\n";
    const std::size_t before = dice.below(4);
    for (std::size_t i = 0; i < before; ++i) text += fmt::format("{},speed,{}\n", i, dice(1.2, 1.5));
    for (const auto& [name, value] : bad.rows) text += fmt::format("10,{},{}\n", name, value);
    text += "20,stop,\n";
    const auto script = parse_walk_script(text, "bad.csv");
    const auto changes = script ? plan_changes(*script, body(), {}) : tl::unexpected(script.error());
    RC_ASSERT(!changes.has_value());
    const std::string message = changes.error().message;
    RC_LOG() << text << message;
    RC_ASSERT(message.starts_with(fmt::format("bad.csv line {}: ", 1 + before + bad.rows.size())));
    RC_ASSERT(holds(message, bad.piece));
    RC_ASSERT(!holds(message, "\n"));
  });
}

TEST(Script, TimesGoForward) {
  over_random_seeds("times", [](Dice& dice) {
    const double later = dice(0.1, 10), earlier = dice(0, 0.99) * later;
    const auto script =
        parse_walk_script(fmt::format("time_s,parameter,value\n{},speed,1\n{},speed,1\n", later, earlier), "t.csv");
    RC_ASSERT(!script.has_value());
    RC_ASSERT(script.error().message.starts_with("t.csv line 3: time"));
  });
  for (const std::string time : {"-0.1", "soon", "", "nan", "1e999"}) {
    const auto script = parse_walk_script("time_s,parameter,value\n" + time + ",speed,1\n", "t.csv");
    ASSERT_FALSE(script.has_value()) << time;
    EXPECT_TRUE(script.error().message.starts_with("t.csv line 2: time_s")) << script.error().message;
  }
}

TEST(Script, StandingWalkerNeedsSpeedToWalk) {
  for (const std::string row : {"step_length,0.7", "step_frequency,2", "step_length_left,0.7"}) {
    const auto script = parse_walk_script("time_s,parameter,value\n1,stop,\n2," + row + "\n", "s.csv");
    ASSERT_TRUE(script.has_value());
    const auto changes = plan_changes(*script, body(), {});
    ASSERT_FALSE(changes.has_value()) << row;
    EXPECT_TRUE(changes.error().message.starts_with("s.csv line 3: the walker stands")) << changes.error().message;
    const auto mended = parse_walk_script("time_s,parameter,value\n1,stop,\n2,speed,1.4\n3," + row + "\n", "s.csv");
    EXPECT_TRUE(plan_changes(mended.value(), body(), {}).has_value()) << row;
  }
}

TEST(Script, HelpNamesEveryWord) {
  for (const std::string word : {"speed", "step_length", "step_frequency", "step_length_right", "step_length_left",
                                 "heading", "stop", "--list-parameters"}) {
    EXPECT_TRUE(holds(std::string(walk_script_help), word)) << word;
  }
  // and its example is a valid script
  const std::string help(walk_script_help);
  const auto from = help.find("    time_s,");
  const auto script = parse_walk_script(help.substr(from, help.find("Each", from) - from), "help");
  ASSERT_TRUE(script.has_value()) << script.error().message;
  const auto changes = plan_changes(*script, body(), {});
  EXPECT_TRUE(changes.has_value()) << changes.error().message;
}

}  // namespace mobil::script_test
