// Ages of people in the C interface, and structs of programs from before ages.
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/usual_gait.h>
#include "tests/c/c_fixture.h"

namespace mobil::c_age_test {
namespace {
using namespace c_test;

TEST(CAge, IsKeptToHalfYears) {
  const Sim sim;
  auto person = filled<mobil_person>(MOBIL_PERSON), back = person;
  EXPECT_EQ(person.age_y, 25);
  person.height_m = 1.28F;
  person.mass_kg = 26;
  person.sex = MOBIL_WOMAN;
  mobil_id id;
  for (const auto& [asked, kept] : {std::pair{8.2F, 8.0F}, {9.0F, 9.0F}}) {
    person.age_y = asked;
    ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
    ASSERT_EQ(mobil_get_person(sim, id, &back), MOBIL_OK);
    EXPECT_EQ(back.age_y, kept);
  }
  for (const float age_y : {0.0F, 30.0F, std::nanf(""), std::numeric_limits<float>::infinity(), -1.0F}) {
    person.age_y = age_y;  // of an adult, or no age
    EXPECT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_REFUSED) << age_y;
  }
}

TEST(CAge, ZeroAndOlderStructsAreAdults) {
  const Sim sim;
  auto person = filled<mobil_person>(MOBIL_PERSON), back = person;
  person.age_y = 0;
  mobil_id id;
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
  ASSERT_EQ(mobil_get_person(sim, id, &back), MOBIL_OK);
  EXPECT_EQ(back.age_y, 25);
  // Interface 6: the struct ends before the age, after padding. Interface 1: it ends before the sex.
  for (const std::size_t size : {offsetof(mobil_person, age_y), offsetof(mobil_person, sex)}) {
    std::memset(&person, 0xff, sizeof person);
    ASSERT_EQ(mobil_defaults(MOBIL_PERSON, &person, size), MOBIL_OK);
    std::memset(&person.unused_2, 0xff, sizeof person.unused_2);
    ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
    ASSERT_EQ(mobil_get_person(sim, id, &back), MOBIL_OK);
    EXPECT_EQ(back.age_y, 25);
    EXPECT_EQ(back.sex, MOBIL_MAN);
  }
}

TEST(CAge, TypicalPeopleAreThoseOfCpp) {
  const Sim sim;
  auto person = filled<mobil_person>(MOBIL_PERSON);
  std::vector<float> style(gait_parameters.size());
  ASSERT_EQ(mobil_typical_person(MOBIL_WOMAN, 72, 1, -0.5F, style.data(), style.size(), &person), MOBIL_OK);
  const BodyRequest body = typical_body(Sex::woman, 72, 1, -0.5F);
  mobil_id id;
  ASSERT_EQ(mobil_spawn(sim, &person, 0, 1, nullptr, &id), MOBIL_OK) << sim.message();
  Simulation simulation;
  ASSERT_TRUE(simulation.spawn(body, {.speed_m_s = usual_speed_m_s(body), .style = usual_style(body)}));
  EXPECT_EQ(sim.hash(), simulation.state_hash());
  const mobil_person before = person;
  for (const float z : {9.0F, std::nanf("")})
    EXPECT_EQ(mobil_typical_person(MOBIL_MAN, 30, z, 0, nullptr, 0, &person), MOBIL_REFUSED);
  EXPECT_EQ(mobil_typical_person(2, 30, 0, 0, nullptr, 0, &person), MOBIL_REFUSED);
  EXPECT_EQ(mobil_typical_person(MOBIL_MAN, 30, 0, 0, style.data(), style.size() + 1, &person), MOBIL_REFUSED);
  EXPECT_EQ(mobil_typical_person(MOBIL_MAN, 30, 0, 0, nullptr, 0, nullptr), MOBIL_REFUSED);
  EXPECT_EQ(std::memcmp(&before, &person, sizeof person), 0);
  person.size = offsetof(mobil_person, age_y);
  EXPECT_EQ(mobil_typical_person(MOBIL_MAN, 30, 0, 0, nullptr, 0, &person), MOBIL_STRUCT);
}

}  // namespace
}  // namespace mobil::c_age_test
