// Who won, by how much and at which movement.
#include <gtest/gtest.h>

#include "runtime/report.hpp"

namespace fpc {
namespace loop_verdict_test {

Summary run(const std::string& loop, const std::string& title, double ise_x, double move) {
  Summary s;
  s.loop = loop;
  s.title = title;
  s.complete = true;
  s.steps = 100;
  s.sources.assign(7, 0);
  s.sources[1] = 100;
  s.output_names = {"s", "x"};
  s.output_units = {"mg/l", "mg/l"};
  s.controlled = {false, true};
  s.outputs.resize(2);
  s.outputs[0].ise = 7.0;
  s.outputs[1].ise = ise_x;
  s.input_names = {"q"};
  s.input_units = {"m3/h"};
  s.inputs.resize(1);
  s.inputs[0].mean_abs_move = move;
  return s;
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Verdict, NamesWinnerMarginAndMovementOfWhatIsControlled) {
  const std::string text = verdictOf({run("a", "Plant, case 1, PI", 200.0, 3.0),
                                      run("b", "Plant, case 1, law", 150.0, 4.0),
                                      run("c", "Plant, case 1, other", 1500.0, 5.0)});
  for (const char* part : {"law (b) wins", "ISE of x 150, 25 % less than PI (a)",
                           "q 4 against 3 m3/h", "c has 10 times"})
    EXPECT_TRUE(says(text, part)) << part << " in: " << text;
  EXPECT_FALSE(says(text, "case 1")) << text;
  EXPECT_FALSE(says(text, "ISE of s")) << text;
}

TEST(Verdict, LessThanAPercentIsADraw) {
  EXPECT_TRUE(says(verdictOf({run("a", "", 100.0, 1.0), run("b", "", 99.5, 1.0)}), "b draws"));
}

TEST(Verdict, GoesByAllOutputsThatEverybodyControls) {
  Summary a = run("a", "", 100.0, 1.0), b = run("b", "", 130.0, 1.0);
  a.controlled = b.controlled = {true, true};
  b.outputs[0].ise = 1.0;
  const std::string text = verdictOf({a, b});
  EXPECT_TRUE(says(text, "b wins: ISE of s 1, 86 % less; ISE of x 130, 30 % more than a")) << text;
}

TEST(Verdict, NoneWhereRunsCannotBeCompared) {
  const Summary good = run("a", "", 100.0, 1.0);
  EXPECT_EQ(verdictOf({good}), "");
  Summary shorter = run("b", "", 1.0, 1.0), others = shorter, failed = shorter, held = shorter;
  shorter.steps = 99;
  others.controlled = {true, false};
  failed.complete = false;
  held.sources.assign(7, 0);
  held.sources[4] = 100;
  held.events = {eventOf(EventCode::kNeverControlled)};
  for (const Summary& other : {shorter, others, failed, held})
    EXPECT_TRUE(says(verdictOf({good, other}), "Verdict: none"));
}

TEST(Verdict, WhatIsControlledLeadsTheTable) {
  const std::string text = toTable({run("a", "Plant", 100.0, 1.0)});
  EXPECT_LT(text.find("x [mg/l]"), text.find("s [mg/l] (not controlled)")) << text;
}

}  // namespace loop_verdict_test
}  // namespace fpc
