// fmbpc reproduce [NAME...]: the papers' experiments, paper | here | ratio | verdict.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "fmbpc/base/input_error.hpp"
#include "tool/commands.hpp"
#include "tool/reproduce/experiment.hpp"

namespace fpc::tool {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Experiment> chosen(const std::vector<std::string>& names) {
  const auto all = experiments();
  if (names.empty()) return all;
  std::vector<Experiment> some;
  for (const auto& name : names) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Experiment& e) { return e.name == name; });
    require(found != all.end(), name, "an experiment that fmbpc reproduce --list names");
    some.push_back(*found);
  }
  return some;
}

std::string cell(double value) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void print(const Experiment& experiment, const std::vector<ReproduceRow>& rows) {
  std::cout << experiment.name << ": " << experiment.source << "\n";
  for (const auto& row : rows) {
    char line[600];
    std::snprintf(line, sizeof line, "  %-52s %12s %12s %9s %-9s %-16s %s\n", row.quantity.c_str(),
                  cell(row.paper).c_str(), cell(row.here).c_str(),
                  cell(row.paper == 0.0 ? std::nan("") : row.here / row.paper).c_str(),
                  row.unit.c_str(), name(row.verdict), row.note.c_str());
    std::cout << line;
  }
  std::cout << "\n";
}

int list(const std::vector<Experiment>& all, bool json) {
  Json names = Json::array();
  for (const auto& experiment : all) {
    names.push_back({{"name", experiment.name}, {"source", experiment.source}});
    if (!json) std::printf("%-28s %s\n", experiment.name.c_str(), experiment.source.c_str());
  }
  if (json) std::cout << names.dump(2) << "\n";
  return 0;
}

}  // namespace

int reproduce(const ReproduceArguments& arguments) {
  const auto some = chosen(arguments.names);
  if (arguments.list) return list(some, arguments.json);
  const bool shown = isatty(STDERR_FILENO) != 0;
  Json all = Json::array();
  if (!arguments.json)
    std::printf("  %-52s %12s %12s %9s %-9s %-16s %s\n", "quantity", "paper", "here", "ratio",
                "unit", "verdict", "note");
  std::fflush(stdout);
  for (const auto& experiment : some) {
    if (shown) std::fprintf(stderr, "\r\033[K%s ...", experiment.name.c_str());
    const auto rows = experiment.rows();
    if (shown) std::fprintf(stderr, "\r\033[K");
    if (!arguments.json) print(experiment, rows);
    for (const auto& row : rows)
      all.push_back({{"name", experiment.name},
                     {"source", experiment.source},
                     {"quantity", row.quantity},
                     {"paper", number(row.paper)},
                     {"here", number(row.here)},
                     {"unit", row.unit},
                     {"verdict", name(row.verdict)},
                     {"note", row.note}});
  }
  if (arguments.json) std::cout << all.dump(2) << "\n";
  return 0;
}

}  // namespace fpc::tool
