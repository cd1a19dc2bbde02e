// fmbpc_papers [NAME...]: the papers' tables and figures, paper | here | verdict; `fmbpc
// reproduce`.
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <set>

#include "base/files.hpp"
#include "base/near_names.hpp"
#include "fmbpc/base/input_error.hpp"
#include "papers/perturbations.hpp"
#include "papers/picture.hpp"
#include "papers/report.hpp"
#include "papers/runs.hpp"
#include "runtime/plot.hpp"

namespace fpc::papers {
namespace {

using Json = OrderedJson;

struct Arguments {
  std::vector<std::string> names;
  std::string plots;    ///< folder, empty: none
  std::string perturb;  ///< empty: none
  std::size_t seeds{24};
  bool list{false}, details{false}, markdown{false}, json{false};
};

/// `word` in `text` with neither letter, digit nor underscore beside it.
bool containsWord(const std::string& text, const std::string& word) {
  const auto part = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_');
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if (!(at > 0 && part(at - 1)) && !part(at + word.size())) return true;
  return false;
}

/// A paper's key, an experiment's name or its beginning, or a loop behind it.
bool isNamed(const Experiment& e, const std::string& name) {
  return e.paper == name || e.name.rfind(name, 0) == 0 || containsWord(e.behind, name);
}

/// Papers and experiments, each once.
std::vector<std::string> experimentNames(const std::vector<Experiment>& all) {
  std::set<std::string> names;
  for (const auto& e : all) names.insert({e.paper, e.name});
  return {names.begin(), names.end()};
}

std::vector<Experiment> chosen(const std::vector<std::string>& names) {
  const auto& all = experiments();
  if (names.empty()) return all;
  std::vector<Experiment> some;
  for (const auto& name : names)
    require(!name.empty() && std::any_of(all.begin(), all.end(),
                                         [&](const Experiment& e) { return isNamed(e, name); }),
            name,
            "a paper, an experiment or a loop behind one" +
                nearNames(name, experimentNames(all), "`fmbpc reproduce --list` lists them"));
  std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&](const Experiment& e) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return isNamed(e, name); });
  });
  return some;
}

int list(const std::vector<Experiment>& all, bool json) {
  Json names = Json::array();
  for (const auto& e : all) {
    names.push_back({{"name", e.name},
                     {"paper", e.paper},
                     {"item", e.item},
                     {"shows", e.shows},
                     {"printed", e.printed},
                     {"behind", e.behind}});
    if (!json)
      std::printf("%-22s %-13s %-18s %s (%s)\n", e.name.c_str(), e.paper.c_str(), e.item.c_str(),
                  e.shows.c_str(), e.printed.c_str());
  }
  if (json) std::cout << names.dump(2) << "\n";
  return 0;
}

/// One line that changes on a terminal; else a line for every paper that begins, so that a log
/// shows that something is done.
void tellProgress(const std::vector<Experiment>& some, std::size_t i, bool terminal) {
  const Experiment& now = some[i];
  if (terminal)
    std::fprintf(stderr, "\r\033[K%zu of %zu: %s ...", i + 1, some.size(), now.name.c_str());
  else if (i == 0 || some[i - 1].paper != now.paper)
    std::fprintf(stderr, "fmbpc: reproduce: %s, from %zu of %zu\n", now.paper.c_str(), i + 1,
                 some.size());
}

std::vector<Outcome> outcomesOf(const std::vector<Experiment>& some) {
  const bool shown = isatty(STDERR_FILENO) != 0;
  std::vector<Outcome> outcomes;
  for (const auto& experiment : some) {
    tellProgress(some, outcomes.size(), shown);
    outcomes.push_back({experiment, rowsOf(experiment)});
  }
  if (shown) std::fprintf(stderr, "\r\033[K");
  return outcomes;
}

void draw(const std::vector<Outcome>& outcomes, const std::string& folder) {
  makeFolder(folder);
  bool any = false;
  for (const auto& outcome : outcomes) {
    const Experiment& e = outcome.experiment;
    if (!hasPicture(e)) continue;
    any = true;
    Json json = toJson(pictureOf(e));
    json["title"] = e.paper + ", " + e.item + ": " + e.shows;
    json["rows"] = toJson(std::vector<Outcome>{outcome});
    writeText(json.dump() + "\n", inFolder(folder, e.name + ".json"));
  }
  if (!any) return;  // tables and equations alone
  const PlotResult plot = drawReproduction(folder);
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
}

void print(const std::vector<Outcome>& outcomes, const Arguments& arguments) {
  if (arguments.json) {
    std::cout << toJson(outcomes).dump(2) << "\n";
  } else if (arguments.markdown) {
    std::cout << markdown(outcomes);
  } else {
    if (arguments.details || !arguments.names.empty())
      for (const auto& outcome : outcomes) std::cout << detailsText(outcome) << "\n";
    std::cout << summaryText(outcomes);
    if (!arguments.details && arguments.names.empty())
      std::cout << "details: fmbpc reproduce --details, or the name of a paper in brackets\n";
  }
}

/// Rows without a result and failed runs, on standard error.
int failures(const std::vector<Outcome>& outcomes) {
  const auto lines = failuresOf(outcomes, failedRuns());
  for (const auto& line : lines) std::fprintf(stderr, "fmbpc: %s\n", line.c_str());
  return lines.empty() ? 0 : 1;
}

int reproduce(const Arguments& arguments) {
  const auto some = chosen(arguments.names);
  if (arguments.list) return list(some, arguments.json);
  if (!arguments.perturb.empty()) perturb(arguments.perturb);
  setSeeds(arguments.seeds);
  const auto outcomes = outcomesOf(some);
  print(outcomes, arguments);
  if (!arguments.plots.empty()) draw(outcomes, arguments.plots);
  return failures(outcomes);
}

}  // namespace
}  // namespace fpc::papers

int main(int argc, char** argv) {
  fpc::papers::Arguments a;
  CLI::App app{"Tables and figures of the papers: paper | here | verdict", "fmbpc reproduce"};
  app.add_option(
      "NAME", a.names,
      "papers, experiments (or how their names begin), loops behind them; all of them if "
      "none is named");
  app.add_flag("--list", a.list, "only list them: what each shows and prints");
  app.add_flag("--details", a.details,
               "every row of every paper; a paper that is named shows its rows anyway");
  app.add_option("--plots", a.plots, "folder for a picture of every figure")
      ->check([](const std::string& text) {
        return text.empty() ? std::string("expected a name, got none") : std::string();
      });
  app.add_flag("--markdown", a.markdown, "the page docs/results.md");
  app.add_flag("--json", a.json, "print one JSON array and nothing else");
  app.add_option("--perturb", a.perturb,
                 "a wrong plant or law in every loop (papers/perturbations.yaml), to see which "
                 "verdicts notice");
  app.add_option("--seeds", a.seeds, "runs of each loop with random disturbances, for a quick look")
      ->check(CLI::Range(std::size_t{2}, std::size_t{1000}))
      ->capture_default_str();
  app.footer("Example: fmbpc reproduce blazic2007 --plots figures\n");
  try {
    app.parse(argc, argv);
    const int code = fpc::papers::reproduce(a);
    std::cout.flush();
    fpc::require(std::cout.good() && std::fflush(stdout) == 0, "standard output",
                 "room for what is printed");
    return code;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::fprintf(stderr, "fmbpc: reproduce: %s\n", e.what());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fmbpc: %s\n", e.what());
  }
  return 1;
}
