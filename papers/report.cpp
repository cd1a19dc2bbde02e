#include "papers/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc::papers {
namespace {

using Json = OrderedJson;

std::string format(const char* pattern, double value) {
  char text[60];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

/// What the paper prints, or the statement: "<= 1".
std::string paperCell(const Row& row) {
  if (std::isnan(row.paper)) return "-";
  if (!row.statement) return shortText(row.paper);
  const char* sign = row.direction == Direction::kLower    ? "<= "
                     : row.direction == Direction::kHigher ? ">= "
                                                           : "= ";
  return sign + shortText(row.paper);
}

std::string spreadOf(const Row& row) {
  if (row.here.count() == 1) return "";
  std::string text = "median of " + std::to_string(row.here.count()) + ", " +
                     shortText(row.here.lowest()) + " .. " + shortText(row.here.highest());
  if (row.incomparable.empty())
    text += ", " +
            std::to_string(std::lround(row.agreeing() * static_cast<double>(row.here.count()))) +
            " agree";
  return text;
}

std::string deviationOf(const Row& row) {
  const double here = row.here.median();
  if (row.statement || !row.incomparable.empty() || !std::isfinite(row.paper - here)) return "";
  if (row.paper == 0.0) return "";
  const double off = 100.0 * std::abs(here - row.paper) / std::abs(row.paper);
  return row.verdict() == Verdict::kReproduced ? format("within %.2g %%", std::max(off, 0.01))
                                               : format("%.3g %% off", off);
}

std::string paperTitle(const std::string& key) {
  for (const auto& paper : papers())
    if (paper.key == key) return paper.title;
  return key;
}

std::vector<Outcome> ofPaper(const std::vector<Outcome>& all, const std::string& key) {
  std::vector<Outcome> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some),
               [&](const Outcome& outcome) { return outcome.experiment.paper == key; });
  return some;
}

Rows rowsOfAll(const std::vector<Outcome>& outcomes) {
  Rows rows;
  for (const auto& outcome : outcomes)
    rows.insert(rows.end(), outcome.rows.begin(), outcome.rows.end());
  return rows;
}

std::string withoutBars(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\\|");
  return text;
}

void addTable(std::string& page, const std::vector<Outcome>& outcomes) {
  page += "| | shows | quantity | paper | here | unit | verdict | remark |\n";
  page += "|---|---|---|---|---|---|---|---|\n";
  for (const auto& [experiment, rows] : outcomes) {
    std::string item = experiment.item, shows = experiment.shows;
    for (const auto& row : rows) {
      std::string line;
      for (const std::string& cell : {item, shows, row.quantity, paperCell(row), hereText(row),
                                      row.unit, std::string(name(row.verdict())), remarkOf(row)})
        line += "| " + withoutBars(cell) + " ";
      page += line + "|\n";
      item.clear();
      shows.clear();
    }
  }
}

/// Of a statement; null where there is none to judge.
Json holds(const Row& row) {
  const Verdict verdict = row.verdict();
  if (verdict == Verdict::kHolds || verdict == Verdict::kObserved) return true;
  return verdict == Verdict::kFails ? Json(false) : Json(nullptr);
}

}  // namespace

std::string hereText(const Row& row) {
  const double here = row.here.median();
  std::string text = shortText(here);
  if (row.verdict() != Verdict::kFails) return text;
  const std::string limit = shortText(row.paper);
  for (int digits = 5; text == limit && digits <= 17; ++digits)
    text = format(("%." + std::to_string(digits) + "g").c_str(), here);
  return text;
}

Counts countsOf(const Rows& rows) {
  Counts counts;
  for (const auto& row : rows) ++counts[row.verdict()];
  return counts;
}

std::string inWords(const Counts& counts) {
  std::vector<std::string> words;
  for (const auto& [verdict, count] : counts) {
    std::string word = name(verdict);
    std::replace(word.begin(), word.end(), '_', ' ');
    words.push_back(std::to_string(count) + " " + word);
  }
  return join(words);
}

std::string remarkOf(const Row& row) {
  std::vector<std::string> words;
  for (const std::string& part : {deviationOf(row), spreadOf(row), row.incomparable, row.note})
    if (!part.empty()) words.push_back(part);
  return join(words, "; ");
}

std::vector<std::string> failuresOf(const std::vector<Outcome>& outcomes,
                                    const std::vector<std::string>& failed_runs) {
  std::vector<std::string> lines;
  for (const auto& text : failed_runs) lines.push_back("failed: " + text);
  const Rows rows = rowsOfAll(outcomes);
  const auto lost = std::count_if(
      rows.begin(), rows.end(), [](const Row& row) { return row.verdict() == Verdict::kNoResult; });
  if (lost > 0) lines.push_back(std::to_string(lost) + " rows without a result");
  return lines;
}

std::string reasonOf(const Rows& rows) {
  const auto first = [&](auto&& condition) {
    return std::find_if(rows.begin(), rows.end(), condition);
  };
  auto at = first([](const Row& row) { return isShort(row.verdict()); });
  if (at != rows.end()) return at->quantity + ": " + remarkOf(*at);
  at = first([](const Row& row) { return !row.incomparable.empty(); });
  return at == rows.end() ? "" : at->incomparable;
}

std::string summaryText(const std::vector<Outcome>& outcomes) {
  std::string text;
  for (const auto& paper : papers()) {
    const auto some = ofPaper(outcomes, paper.key);
    if (some.empty()) continue;
    const auto listed = std::count_if(some.begin(), some.end(), [](const Outcome& outcome) {
      return isTableOrFigure(outcome.experiment);
    });
    text += paper.title + " (" + paper.key + ")\n  " + std::to_string(listed) +
            " tables and figures: " + inWords(countsOf(rowsOfAll(some))) + "\n";
  }
  return text + "in all: " + inWords(countsOf(rowsOfAll(outcomes))) + "\n";
}

std::string detailsText(const Outcome& outcome) {
  const Experiment& e = outcome.experiment;
  std::vector<std::vector<std::string>> table{{"quantity", "paper", "here", "unit", "verdict"}};
  for (const auto& row : outcome.rows)
    table.push_back({row.quantity, paperCell(row), hereText(row), row.unit, name(row.verdict())});
  std::string text = e.name + " (" + paperTitle(e.paper) + ", " + e.item + ": " + e.shows + ")\n" +
                     "  from " + e.behind + "\n";
  const std::string aligned = alignedTable(table);
  std::size_t from = 0, line = 0;
  for (std::size_t to; (to = aligned.find('\n', from)) != std::string::npos;
       from = to + 1, ++line) {
    text += "  " + aligned.substr(from, to - from);
    if (line > 0 && line <= outcome.rows.size()) text += "  " + remarkOf(outcome.rows[line - 1]);
    text += "\n";
  }
  return text;
}

Json toJson(const std::vector<Outcome>& outcomes) {
  Json all = Json::array();
  for (const auto& [e, rows] : outcomes)
    for (const auto& row : rows)
      all.push_back({{"name", e.name},
                     {"paper_key", e.paper},
                     {"item", e.item},
                     {"shows", e.shows},
                     {"quantity", row.quantity},
                     {"kind", row.statement ? "check" : "figure"},
                     {"paper", numberOrNull(row.paper)},
                     {"here", numberOrNull(row.here.median())},
                     {"lowest", numberOrNull(row.here.lowest())},
                     {"highest", numberOrNull(row.here.highest())},
                     {"runs", row.here.count()},
                     {"unit", row.unit},
                     {"verdict", name(row.verdict())},
                     {"holds", holds(row)},
                     {"note", remarkOf(row)},
                     {"behind", row.behind}});
  return all;
}

std::string markdown(const std::vector<Outcome>& outcomes) {
  std::string page;
  for (const auto& paper : papers()) {
    const auto some = ofPaper(outcomes, paper.key);
    if (some.empty()) continue;
    page += "## " + paper.title + "\n\n" + inWords(countsOf(rowsOfAll(some))) + ".\n\n";
    page += "| | verdicts | what is missing | from |\n|---|---|---|---|\n";
    for (const auto& [e, rows] : some)
      page += "| " + e.item + " | " + inWords(countsOf(rows)) + " | " +
              withoutBars(reasonOf(rows)) + " | " + e.behind + " |\n";
    page += "\n";
    addTable(page, some);
    page += "\n";
  }
  return page;
}

}  // namespace fpc::papers
