// What an unknown name is answered with: what was meant, or where all names are.
#include <gtest/gtest.h>

#include <algorithm>

#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_suggestions_test {

void expectAnswer(const std::string& arguments, const std::string& part) {
  const Outcome outcome = tool(arguments, true);
  EXPECT_EQ(outcome.code, 1) << arguments;
  EXPECT_EQ(std::count(outcome.printed.begin(), outcome.printed.end(), '\n'), 1) << outcome.printed;
  EXPECT_NE(outcome.printed.find(part), std::string::npos) << arguments << ": " << outcome.printed;
}

TEST(Suggestions, CapitalsPartsAndSlips) {
  expectAnswer("run ASP_CASE1", "near: asp_case1");
  expectAnswer("run case1_clp", "near: asp_case1_clp");
  expectAnswer("run sludge", "near: bsm1_fmbpc_sludge");
  expectAnswer("reproduce blazik2007", "near: blazic2007");
  expectAnswer("reproduce blazic", "near: blazic2007");
  expectAnswer("reproduce Blazic2007", "near: blazic2007");
  expectAnswer("study Cstr_mismatch", "near: cstr_mismatch");
  expectAnswer("model FM_1", "near: fm_1");
  expectAnswer("identify x.csv ASP_D", "asp_d");
  expectAnswer("loops adaptiv_pi", "near: adaptive_pi");
}

TEST(Suggestions, HelpOfACommandThatIsNone) {
  expectAnswer("identfy --help", "unknown command 'identfy', did you mean identify?");
  expectAnswer("nonsense -h", "unknown command 'nonsense'");
}

TEST(Suggestions, WhereNothingIsNearTheyAreListedOrTheirListIsNamed) {
  expectAnswer("run thermostat", "; `fmbpc loops` lists them");
  expectAnswer("loops two_inputs", "; `fmbpc loops` lists them");
  expectAnswer("study nothing", "; `fmbpc loops` lists them; studies: ");
  expectAnswer("reproduce wood1973", "; `fmbpc reproduce --list` lists them");
  expectAnswer("model nothing", "; there are asp_a");
  expectAnswer("tune asp_case1 nothing", "; there are ");
}

}  // namespace tool_suggestions_test
}  // namespace fpc
