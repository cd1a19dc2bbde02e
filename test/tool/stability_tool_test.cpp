// fmbpc stability: which files are loops, how far it looks, and what it would ignore.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/loop_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_stability_tool_test {

using StabilityTool = LoopFolder;

nlohmann::json steadyStates(const std::string& subject) {
  const Outcome outcome = tool("stability --json " + subject);
  EXPECT_EQ(outcome.code, 0) << subject;
  return nlohmann::json::parse(outcome.printed)["steady_states"];
}

TEST_F(StabilityTool, ALoopOfOnesOwnIsOneWhereverItLies) {
  const std::string loop = write("mine.yaml", "extends: heated_tank\n");
  EXPECT_EQ(steadyStates(loop)["input"], "heat");
  const Outcome model = tool("resolve heated_tank > " + path("whole.yaml"));
  ASSERT_EQ(model.code, 0);
  EXPECT_EQ(steadyStates(path("whole.yaml"))["input"], "heat") << "with plant in place of extends";
}

TEST_F(StabilityTool, TheRangeIsThatOfTheLoopAndIsPrinted) {
  const auto tank = steadyStates("heated_tank");
  EXPECT_DOUBLE_EQ(tank["input_lower"], 0.2);
  EXPECT_DOUBLE_EQ(tank["input_upper"], 20.0) << "said by the loop, though it is the plant's";
  EXPECT_EQ(tank["cut"], false);
  const std::string narrow = write(
      "narrow.yaml",
      "extends: heated_tank\nactuator:\n  input_lower: {heat: 2}\n  input_upper: {heat: 18}\n");
  const auto states = steadyStates(narrow);
  EXPECT_DOUBLE_EQ(states["input_lower"], 2.0);
  EXPECT_DOUBLE_EQ(states["input_upper"], 18.0);
  const std::string printed = tool("stability " + narrow).printed;
  EXPECT_NE(printed.find("over heat [kW] from 2 to 18"), std::string::npos) << printed;
}

Matrix matrixOf(const nlohmann::json& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Matrix m(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      m(i, j) = rows[static_cast<std::size_t>(i)].at(static_cast<std::size_t>(j));
  return m;
}

/// P > 0 and decay^2 P - A' P A > 0 of every named map, from what is printed alone.
void expectCertified(const nlohmann::json& certificate, const nlohmann::json& maps) {
  const Matrix P = matrixOf(certificate["P"]);
  const double decay = certificate["decay"];
  EXPECT_LT(decay, 1.0);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix>(P).eigenvalues().minCoeff(), 0.0);
  for (const auto& map : maps) {
    const Matrix A = matrixOf(map["A"]);
    const Matrix left = decay * decay * (1.0 + 1e-9) * P - A.transpose() * P * A;
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix>(left).eigenvalues().minCoeff(), -1e-12);
  }
}

TEST_F(StabilityTool, TheCertificateCanBeCheckedByOthers) {
  const auto report = nlohmann::json::parse(tool("stability --json cstr_tracking_literal").printed);
  const auto& certificate = report["certificate"];
  if (certificate["status"] == "csdp not installed") GTEST_SKIP() << "csdp is not installed";
  ASSERT_EQ(certificate["status"], "found");
  EXPECT_EQ(certificate["maps"].size(), certificate["applicable"].get<std::size_t>());
  expectCertified(certificate, certificate["maps"]);
  const auto some = nlohmann::json::parse(tool("stability --json fm_1 --horizon 1..3").printed);
  const auto& region = some["certificate"]["region"];
  nlohmann::json members = nlohmann::json::array();
  for (const auto& map : some["certificate"]["maps"])
    if (std::count(region["rules"].begin(), region["rules"].end(), map["rules"]))
      members.push_back(map);
  ASSERT_GT(members.size(), 1U);
  EXPECT_EQ(members.size(), region["rules"].size());
  expectCertified(region, members);
}

TEST_F(StabilityTool, TheTableHasUnitsAndALegend) {
  const std::string model =
      tool("stability fm_1 --at q_r=570,q_i=1300,s_i=366.67 --horizon 1..3").printed;
  for (const char* words :
       {"at q_r = 570 m3/h; q_i = 1300 m3/h, s_i = 366.67 mg/l\n",
        " mg/l, x = ", "H: coincidence horizon", "|open|, |closed|: ", "rho: ", "0: none"})
    EXPECT_NE(model.find(words), std::string::npos) << words << "\n" << model;
  const std::string loop = tool("stability cstr_tracking --horizon 1..3").printed;
  EXPECT_NE(loop.find("at q_c = 103.407 l/min\n"), std::string::npos) << loop;
  EXPECT_NE(loop.find("fold at 119.7128: CA = 0.257799 mol/l, T = 417.667 K"), std::string::npos)
      << loop;
}

TEST_F(StabilityTool, OptionsThatOnlyALawUnderstandsAreRefusedWithoutOne) {
  for (const char* option :
       {"--at bogus=7", "--at heat=7", "--noise-gain 3", "--settling 3", "--horizon 1..9"}) {
    const Outcome outcome = tool(std::string("stability heated_tank ") + option, true);
    EXPECT_EQ(outcome.code, 1) << option;
    EXPECT_NE(outcome.printed.find(std::string(option).substr(0, 4)), std::string::npos)
        << outcome.printed;
  }
}

TEST_F(StabilityTool, NothingToLookAtIsAnError) {
  const Outcome outcome = tool("stability example_external", true);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.printed.find("external"), std::string::npos) << outcome.printed;
}

TEST_F(StabilityTool, WithoutLimitsOfTheLoopTheRestOfTheRangeIsNamed) {
  const std::string loop =
      write("free.yaml",
            "plant:\n  type: transfer_matrix\n  matrix:\n"
            "    outputs: [{name: T, unit: K, nominal: 40, lower: 0, upper: 100}]\n"
            "    inputs: [{name: heat, unit: kW, nominal: 5, lower: 0, upper: 20}]\n"
            "    elements: [{output: T, from: heat, gain: 2, time_constant_min: 9}]\n"
            "sampling: {sample_time_s: 30, duration_h: 1}\n"
            "controller:\n  type: pi\n"
            "  loops: [{input: heat, output: T, kp: 1, ki_per_h: 4}]\n");
  const auto states = steadyStates(loop);
  EXPECT_DOUBLE_EQ(states["input_upper"], 15.0) << "three times 5 kW";
  EXPECT_EQ(states["cut"], true);
  const std::string printed = tool("stability " + loop).printed;
  EXPECT_NE(printed.find("not looked at: the rest of 0 to 20"), std::string::npos) << printed;
  EXPECT_EQ(tool("stability heated_tank").printed.find("not looked at"), std::string::npos);
  for (const char* limit : {"actuator.input_upper=20", "actuator.input_upper=[20]"}) {
    const Outcome said = tool("resolve " + loop + " --set '" + limit + "' > " + path("said.yaml"));
    ASSERT_EQ(said.code, 0);
    EXPECT_DOUBLE_EQ(steadyStates(path("said.yaml"))["input_upper"], 20.0) << limit;
  }
}

}  // namespace tool_stability_tool_test
}  // namespace fpc
