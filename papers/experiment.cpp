#include "papers/experiment.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc::tool {
namespace {

std::vector<Experiment>& registry() {
  static std::vector<Experiment> all;
  return all;
}

std::size_t rankOf(const std::string& key) {
  const auto& all = papers();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Paper& p) { return p.key == key; });
  require(at != all.end(), key, "the key of a paper");
  return static_cast<std::size_t>(at - all.begin());
}

/// "figure 9" before "figure 10": digits get leading zeros.
std::string sortable(const std::string& text) {
  std::string result, digits;
  for (const char c : text + " ") {
    if (std::isdigit(static_cast<unsigned char>(c))) {
      digits += c;
      continue;
    }
    if (!digits.empty()) result += std::string(6 - std::min<std::size_t>(digits.size(), 6), '0');
    result += digits + c;
    digits.clear();
  }
  return result;
}

bool before(const Experiment& a, const Experiment& b) {
  if (a.paper != b.paper) return rankOf(a.paper) < rankOf(b.paper);
  const auto ours = [](const Experiment& e) { return e.item.rfind("beyond", 0) == 0; };
  if (ours(a) != ours(b)) return ours(b);
  return sortable(a.item + a.name) < sortable(b.item + b.name);
}

}  // namespace

bool Values::sound() const {
  return !all_.empty() &&
         std::all_of(all_.begin(), all_.end(), [](double value) { return std::isfinite(value); });
}

double Values::median() const {
  if (!sound()) return notPrinted();
  std::vector<double> sorted = all_;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

double Values::lowest() const {
  return sound() ? *std::min_element(all_.begin(), all_.end()) : notPrinted();
}

double Values::highest() const {
  return sound() ? *std::max_element(all_.begin(), all_.end()) : notPrinted();
}

Verdict ReproduceRow::verdict() const {
  return verdictOf({statement, paper, here.median(), tolerance, direction, incomparable.empty()});
}

double ReproduceRow::agreeing() const {
  double same = 0.0;
  for (const double value : here.all())
    if (verdictOf({statement, paper, value, tolerance, direction, incomparable.empty()}) ==
        verdict())
      same += 1.0;
  return same / static_cast<double>(std::max<std::size_t>(here.count(), 1));
}

ReproduceRow figure(std::string quantity, double paper, Values here, std::string unit,
                    Judged judged, std::string note) {
  ReproduceRow row;
  row.quantity = std::move(quantity);
  row.paper = paper;
  row.here = std::move(here);
  row.unit = std::move(unit);
  row.tolerance = {Tolerance{}.reproduced, judged.close, judged.absolute};
  row.direction = judged.better;
  row.note = std::move(note);
  return row;
}

ReproduceRow check(std::string quantity, Values here, Direction side, double limit,
                   std::string unit, std::string note, double absolute) {
  ReproduceRow row = figure(std::move(quantity), limit, std::move(here), std::move(unit),
                            {0.0, side, absolute}, std::move(note));
  row.statement = true;
  return row;
}

ReproduceRow incomparable(std::string quantity, double paper, Values here, std::string unit,
                          std::string reason) {
  ReproduceRow row = figure(std::move(quantity), paper, std::move(here), std::move(unit));
  require(!reason.empty(), row.quantity, "the reason why it cannot be compared");
  row.incomparable = std::move(reason);
  return row;
}

double notPrinted() { return std::numeric_limits<double>::quiet_NaN(); }

const std::vector<Paper>& papers() {
  static const std::vector<Paper> all{
      {"blazic2007", "Blazic and Skrjanc 2007: stirred-tank reactor"},
      {"vallejo2019",
       "Vallejo and Vega 2019 (article 1 of the thesis of 2021): activated sludge, law and cases A "
       "to D"},
      {"vallejo2021a",
       "Vallejo and Vega 2021 (article 2): activated sludge, stability, cases 1 to 3"},
      {"vallejo2021b", "Vallejo and Vega 2021 (article 3): activated sludge, FMBPC/CLP"},
      {"karer2007", "Karer, Music, Skrjanc and Zupancic 2007: batch reactor"},
      {"mekki", "Mekki and Saad: distillation column"},
      {"taieb2017", "Taieb, Soltani and Chaari 2017: surge tank and stirred tank"},
      {"bsm1", "Alex et al. 2008: benchmark simulation model no. 1, reference figures"}};
  return all;
}

bool registerExperiments(std::vector<Experiment> some) {
  for (auto& experiment : some) registry().push_back(std::move(experiment));
  return true;
}

std::vector<Experiment> experiments() {
  std::vector<Experiment> all = registry();
  std::sort(all.begin(), all.end(), before);
  return all;
}

Rows rowsOf(const Experiment& experiment) {
  Rows rows;
  try {
    rows = experiment.rows();
  } catch (const std::exception& e) {
    rows = {figure("rows of " + experiment.name, notPrinted(), notPrinted(), "-", {}, e.what())};
  }
  for (auto& row : rows)
    if (row.behind.empty()) row.behind = experiment.behind;
  return rows;
}

bool isTableOrFigure(const Experiment& experiment) {
  for (const std::string kind : {"table ", "figure "}) {
    if (experiment.item.rfind(kind, 0) != 0) continue;
    const auto first = static_cast<unsigned char>(experiment.item[kind.size()]);
    return std::isdigit(first) || std::isupper(first);  // "table 3", "table A1"
  }
  return false;
}

}  // namespace fpc::tool
