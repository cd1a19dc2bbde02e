// fmbpc commission: stages from a brief to a law and its PI, with a folder for what is done.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/commissioning/commissioning.hpp"
#include "runtime/operator_line.hpp"
#include "runtime/plot.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Json = OrderedJson;

std::string figure(const Json& value) {
  return value.is_number() ? shortText(value.get<double>()) : "-";
}

void printRemarks(const Json& stage) {
  for (const auto& remark : stage.value("remarks", Json::array()))
    std::cout << "  ! " << remark.get<std::string>() << "\n";
}

void printWatch(const Json& stage) {
  std::vector<std::vector<std::string>> rows{
      {"  output", "mean", "deviation", "noise", "resolution", "memory s"}};
  for (const auto& y : stage["outputs"])
    rows.push_back({"  " + y["name"].get<std::string>(), figure(y["mean"]), figure(y["deviation"]),
                    figure(y["noise"]), figure(y["resolution"]), figure(y["memory_s"])});
  std::cout << alignedTable(rows);
  printRemarks(stage);
}

void printTest(const Json& stage) {
  std::cout << "  ended: " << stage["ended"].get<std::string>() << " after "
            << figure(stage["hours"]) << " h, " << figure(stage["settling_times"])
            << " settling times of " << figure(stage["settling_s"]) << " s; " << stage["turned"]
            << " steps turned, " << stage["limits_left"] << " limits left\n";
  if (stage["ended"] != "enough") std::cout << "  ! " << stage["reason"].get<std::string>() << "\n";
}

void printModel(const Json& stage) {
  std::vector<std::vector<std::string>> rows{
      {"  element", "gain", "+-", "lags s", "damping", "lead s", "dead time s", "+-", "kind"}};
  for (const auto& y : stage["outputs"])
    for (const auto& e : y["elements"]) {
      const std::string name =
          "  " + y["name"].get<std::string>() + " from " + e["from"].get<std::string>();
      if (!e["seen"].get<bool>()) {
        rows.push_back({name, "not seen", figure(e["gain_bound"]), "-", "-", "-", "-", "-"});
        continue;
      }
      rows.push_back({name, figure(e["gain"]), figure(e["gain_bound"]),
                      figure(e["time_constant_s"]) + " " + figure(e["second_s"]),
                      figure(e["damping"]), figure(e["lead_s"]), figure(e["dead_time_s"]),
                      figure(e["dead_time_bound_s"]), y["kind"].get<std::string>()});
    }
  std::cout << alignedTable(rows);
}

void printDesign(const Json& stage) {
  std::vector<std::vector<std::string>> rows{
      {"  ", "tuned cost", "peak of S", "gain margin", "delay margin s"}};
  for (const char* what : {"law", "pi"})
    rows.push_back({std::string("  ") + what, figure(stage[what]["tuned_cost"]),
                    figure(stage[what]["sensitivity_peak"]), figure(stage[what]["gain_margin"]),
                    figure(stage[what]["delay_margin_s"])});
  std::cout << alignedTable(rows)
            << "  cost of the law over that of the PI, on models that were held out: "
            << figure(stage["cost_ratio"]) << " +- " << figure(stage["cost_ratio_bound"]) << "\n";
  printRemarks(stage);
  std::cout << "  offered: " << stage["offered"].get<std::string>() << "\n";
}

void print(const Json& all, bool json) {
  if (json) {
    std::cout << all.dump(2) << "\n";
    return;
  }
  for (const auto& [word, figures] : all.items()) {
    std::cout << word << (figures.is_null() ? ": to be done" : ": done") << "\n";
    if (figures.is_null()) continue;
    if (word == wordOf(CommissioningStage::kWatch)) printWatch(figures);
    if (word == wordOf(CommissioningStage::kTest)) printTest(figures);
    if (word == wordOf(CommissioningStage::kModel)) printModel(figures);
    if (word == wordOf(CommissioningStage::kDesign)) printDesign(figures);
  }
}

void draw(const CommissionArguments& a, const std::string& folder) {
  if (a.no_plot || !fs::exists(fs::path(folder) / "watch.csv")) return;
  const PlotResult plot = drawCommissioning(folder);
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
}

}  // namespace

int commission(const CommissionArguments& a) {
  const std::string folder =
      a.folder.empty() ? fs::path(a.brief).stem().string() + "_commissioned" : a.folder;
  if (a.topics) {
    require(!a.undo, "--undo", "a command without --topics: it only takes files back");
    const std::string figures = commissionLoop(
        {fs::absolute(a.brief).string(), fs::absolute(folder).lexically_normal().string(), a.until,
         a.again, a.evaluations, a.members},
        [&](const std::string& stage, const std::string& text) {
          if (!a.json) std::cerr << stage << ": " << text << "\n";
        });
    print(Json::parse(figures), a.json);
    draw(a, folder);
    return 0;
  }
  CommissioningOptions options;
  options.evaluations = a.evaluations;
  options.members = a.members;
  options.threads = a.threads;
  if (!a.json)
    options.show = [](CommissioningStage stage, const std::string& text) {
      std::cerr << wordOf(stage) << ": " << text << "\n";
    };
  Commissioning commissioning(a.brief, folder, options);
  require(!a.undo || !a.again.empty(), "--undo", "--again with the stage that is taken back");
  if (!a.again.empty()) commissioning.undo(commissioningStage(a.again, "--again"));
  if (!a.undo) commissioning.run(commissioningStage(a.until, "--until"));
  print(commissioning.figures(), a.json);
  draw(a, folder);
  return 0;
}

}  // namespace fpc::tool
