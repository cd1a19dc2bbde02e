// fmbpc health: a historian's table becomes figures, a page for each loop and a table of the plant.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "paths.hpp"
#include "supervision/simulated_loops.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_health_tool_test {

using health_test::drawLoop;
using health_test::Fault;

std::string historian(Fault fault) {
  const ControlRecord r = drawLoop(health_test::settingPlants()[0], fault, 2);
  const std::string file = resultsDir() + "/historian.csv";
  std::ofstream csv(file);
  csv << "time[s],PV[degC],SP[degC],OP[%],MODE\n";
  for (std::size_t k = 0; k < r.y.size(); ++k)
    csv << k << "," << r.y[k] << "," << r.setpoint[k] << "," << r.u[k] << "," << (k < 600 ? 2 : 1)
        << "\n";
  return file;
}

TEST(HealthTool, AStickingValveOfAHistoriansTableIsFound) {
  const std::string out = resultsDir() + "/health";
  const std::string arguments = historian(Fault::kStiction) +
                                " --outputs PV --setpoints SP --inputs OP --mode MODE --automatic "
                                "1 --manual 2 --dead-time 6 --limits 0:100 --out " +
                                out + " --json";
  const Outcome outcome = tool("health " + arguments);
  ASSERT_EQ(outcome.code, 0);
  const auto loop = nlohmann::json::parse(outcome.printed)["loops"][0];
  EXPECT_EQ(loop["cause"], "stiction");
  EXPECT_EQ(loop["dead_time"], "given");
  EXPECT_DOUBLE_EQ(loop["manual"], 0.1);
  EXPECT_DOUBLE_EQ(loop["automatic"], 0.9);
  EXPECT_GT(loop["valve"]["dead_band"], 0.0);
  for (const char* file : {"index.html", "health.json", "historian_PV.html"})
    EXPECT_TRUE(std::filesystem::is_regular_file(out + "/" + file)) << file;
}

TEST(HealthTool, WhatIsMissingIsNamed) {
  const std::string file = historian(Fault::kNone);
  EXPECT_NE(tool("health " + file, true).printed.find("--outputs"), std::string::npos);
  EXPECT_NE(tool("health " + file + " --outputs NONE", true).printed.find("NONE"),
            std::string::npos);
  EXPECT_NE(tool("health " + file + " --outputs PV --inputs OP,SP", true).printed.find("--outputs"),
            std::string::npos);
  EXPECT_NE(tool("health " + file + " --outputs PV --limits 3", true).printed.find("--limits"),
            std::string::npos);
}

}  // namespace tool_health_tool_test
}  // namespace fpc
