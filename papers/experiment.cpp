#include "papers/experiment.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>

#include "base/yaml_node.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "papers/expression.hpp"
#include "papers/paper_file.hpp"
#include "papers/settings.hpp"

namespace fpc::papers {
namespace {

const char* const kKeys[] = {"blazic2007", "vallejo2019", "vallejo2021a", "vallejo2021b",
                             "karer2007",  "mekki",       "taieb2017",    "bsm1"};
const std::vector<std::string> kDeviations{"deviation", "deviation_of_medians"};

/// Median over the rows so far that have a printed number other than 0, of 100 |here / printed -
/// 1|: of each run, or of the rows' medians.
Values deviation(const Rows& rows, bool of_medians) {
  std::vector<double> all;
  const auto of = [&](auto&& here) {
    std::vector<double> off;
    for (const Row& row : rows)
      if (!row.statement && std::isfinite(row.paper) && row.paper != 0.0)
        off.push_back(100.0 * std::abs(here(row) / row.paper - 1.0));
    return Values(off).median();
  };
  if (of_medians) return of([](const Row& row) { return row.here.median(); });
  for (std::size_t run = 0; run < rows.at(0).here.count(); ++run)
    all.push_back(of([&](const Row& row) { return row.here.all().at(run); }));
  return all;
}

std::string filled(std::string text, double number) {
  const auto at = text.find("{}");
  return at == std::string::npos ? text : text.replace(at, 2, shortText(number));
}

Row computed(const PlannedRow& planned, const Rows& before) {
  Row row = planned.row;
  try {
    row.here = evaluate(planned.here, [&](const std::string& name) {
      return deviation(before, name == kDeviations[1]);
    });
    if (planned.only_if) {
      const double found = evaluate(planned.only_if->here).median();
      if (!(found >= planned.only_if->at_least && found <= planned.only_if->at_most))
        row.incomparable = filled(planned.only_if->otherwise, found);
    }
    if (!planned.note_value.empty())
      row.note = filled(row.note, evaluate(planned.note_value).median());
  } catch (const std::exception& e) {
    row.here = kNotPrinted;
    row.incomparable.clear();
    row.note = e.what();
  }
  return row;
}

/// A number, or how it comes of printed ones: "0.05 * 2000".
void readNumber(YamlSection& s, const std::string& key, double& value) {
  std::string text;
  s.text(key, text);
  if (text.empty()) return;
  checked(s, [&] { value = evaluate(text).median(); });
  if (!std::isfinite(value)) s.fail(key, "a number, or an expression that is one");
}

void readStatement(YamlSection& s, Row& row) {
  for (const auto& [key, side] : {std::pair<const char*, Direction>{"at_most", Direction::kLower},
                                  {"at_least", Direction::kHigher},
                                  {"equals", Direction::kEqual}}) {
    if (!s.has(key)) continue;
    row.statement = true;
    row.direction = side;
    readNumber(s, key, row.paper);
  }
  s.number("within", row.tolerance.absolute, kFiniteNotNegative);
}

void readFigure(YamlSection& s, Row& row) {
  readNumber(s, "paper", row.paper);
  s.number("reproduced", row.tolerance.reproduced, kFiniteNotNegative);
  s.number("close", row.tolerance.close, kFiniteNotNegative);
  s.number("absolute", row.tolerance.absolute, kFiniteNotNegative);
  if (!s.has("better")) return;
  std::string better = "lower";
  s.oneOf("better", better, {"lower", "higher"});
  row.direction = better == "lower" ? Direction::kLower : Direction::kHigher;
}

void readCondition(YamlSection s, PlannedRow& planned) {
  PlannedRow::Condition condition;
  for (const char* key : {"here", "otherwise"}) need(s, key, "a text");
  s.text("here", condition.here);
  s.number("at_least", condition.at_least, kFinite);
  s.number("at_most", condition.at_most, kFinite);
  s.text("otherwise", condition.otherwise);
  s.finish();
  planned.only_if = condition;
}

/// What a row, or the `each` of an experiment, says over what it has.
void readInto(YamlSection& s, PlannedRow& planned) {
  Row& row = planned.row;
  s.text("of", row.quantity);
  s.text("unit", row.unit);
  readStatement(s, row);
  readFigure(s, row);
  s.text("not_compared", row.incomparable);
  s.text("note", row.note);
  s.text("behind", row.behind);
  s.text("here", planned.here);
  s.text("note_value", planned.note_value);
  if (s.has("only_if")) readCondition(s.section("only_if"), planned);
  s.finish();
}

using Environment = std::map<std::string, std::string>;

std::string replaced(std::string text, const Environment& environment) {
  for (const auto& [key, value] : environment)
    for (std::size_t at = 0; (at = text.find("{" + key + "}", at)) != std::string::npos;
         at += value.size())
      text.replace(at, key.size() + 2, value);
  return text;
}

/// A copy of the node with every {key} of its texts replaced.
YAML::Node replaced(const YAML::Node& node, const Environment& environment) {
  if (node.IsScalar()) {
    YAML::Node copy = YAML::Clone(node);
    copy = replaced(node.Scalar(), environment);
    return copy;
  }
  YAML::Node copy(node.Type());
  if (node.IsMap())
    for (const auto& entry : node) copy[entry.first.Scalar()] = replaced(entry.second, environment);
  if (node.IsSequence())
    for (const auto& entry : node) copy.push_back(replaced(entry, environment));
  return copy;
}

/// The lists of `over`, side by side. @throws InputError unless they are equally long
std::vector<Environment> environmentsOf(const YAML::Node& over, const std::string& where) {
  std::vector<Environment> all;
  for (const auto& entry : over) {
    require(entry.second.IsSequence() && (all.empty() || all.size() == entry.second.size()),
            where + "over." + entry.first.Scalar(), "a list, as long as those beside it");
    all.resize(entry.second.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i][entry.first.Scalar()] = entry.second[i].Scalar();
  }
  require(!all.empty(), where + "over", "a mapping of lists");
  return all;
}

/// Rows, and groups of rows over lists of words: {over: {loop: [a, b]}, rows: [...]}.
class RowReader {
 public:
  RowReader(const std::string& file, Experiment& experiment, const PlannedRow& each)
      : file_(file), experiment_(experiment), each_(each) {}

  void take(const YAML::Node& rows) {
    require(rows.IsSequence(), where() + "rows", "a list of rows");
    for (const auto& node : rows) {
      if (!node.IsMap() || !node["over"]) {
        one(node);
        continue;
      }
      YAML::Node body = YAML::Clone(node);
      body.remove("over");
      for (const Environment& environment : environmentsOf(node["over"], where()))
        one(replaced(body, environment));
    }
  }

 private:
  std::string where() const { return file_ + ": " + experiment_.name + "."; }

  void one(const YAML::Node& node) {
    if (node.IsMap() && node["rows"]) return take(node["rows"]);
    PlannedRow planned = each_;
    YamlSection section(
        YamlNode(node), file_,
        experiment_.name + ".rows[" + std::to_string(experiment_.rows.size()) + "]");
    readInto(section, planned);
    check(section, planned);
    experiment_.rows.push_back(std::move(planned));
  }

  void check(const YamlSection& section, const PlannedRow& planned) const {
    need(section, "of", "a text");
    if (planned.here.empty()) section.fail("here", "an expression");
    if (!planned.row.statement && !std::isfinite(planned.row.paper) &&
        planned.row.incomparable.empty())
      section.fail("paper", "a number, at_most, at_least, equals or not_compared");
    try {
      requireSound(planned.here, kDeviations);
      if (planned.only_if) requireSound(planned.only_if->here, {});
      if (!planned.note_value.empty()) requireSound(planned.note_value, {});
    } catch (const InputError& e) {
      section.fail("here", e.what());
    }
  }

  const std::string& file_;
  Experiment& experiment_;
  const PlannedRow& each_;
};

Experiment readExperiment(YamlSection s, const std::string& key) {
  Experiment e;
  e.paper = key;
  for (const char* word : {"name", "item", "shows", "printed", "behind", "rows"})
    need(s, word, "what the other experiments have");
  s.text("name", e.name);
  s.text("item", e.item);
  s.text("shows", e.shows);
  s.text("printed", e.printed);
  s.text("behind", e.behind);
  if (s.has("picture")) {
    YamlSection picture = s.section("picture");
    e.picture.emplace();
    picture.names("runs", e.picture->runs);
    picture.names("signals", e.picture->signals);
    picture.finish();
  }
  PlannedRow each;
  each.row.behind = e.behind;
  YamlSection defaults = s.section("each");
  readInto(defaults, each);
  RowReader(s.file(), e, each).take(s.raw("rows"));
  s.finish();
  return e;
}

struct Book {
  std::vector<Paper> papers;
  std::vector<Experiment> experiments;
  Settings settings;
};

void readSettings(YamlSection s, Settings& settings) {
  for (const std::string& name : s.keys()) {
    const YamlNode node = s.raw(name);
    std::vector<Overrides> all;
    const auto add = [&](const YAML::Node& one) {
      Overrides set;
      for (const auto& entry : one) set.emplace_back(entry.first.Scalar(), entry.second.Scalar());
      all.push_back(std::move(set));
    };
    if (node.IsSequence())
      for (const auto& one : node) add(one);
    else
      add(node);
    require(settings.emplace(name, std::move(all)).second, s.where(name), "a name that is new");
  }
}

void readPaper(YamlSection s, const std::string& key, Book& book) {
  Paper paper{key, ""};
  need(s, "title", "the paper's");
  s.text("title", paper.title);
  readSettings(s.section("settings"), book.settings);
  for (YamlSection& one : s.list("experiments"))
    book.experiments.push_back(readExperiment(std::move(one), key));
  s.finish();
  book.papers.push_back(std::move(paper));
}

/// What papers/verdicts has found to hold with every wrong plant and law.
void markObserved(YamlSection s, std::vector<Experiment>& experiments) {
  for (Experiment& e : experiments) {
    std::vector<std::string> quantities;
    s.names(e.name, quantities);
    for (const std::string& quantity : quantities) {
      const auto found = std::find_if(e.rows.begin(), e.rows.end(), [&](const PlannedRow& planned) {
        return planned.row.statement && planned.row.quantity == quantity;
      });
      if (found == e.rows.end()) s.fail(e.name, "statements of it; got '" + quantity + "'");
      found->row.observed = true;
    }
  }
  s.finish();
}

const Book& book() {
  static const Book all = [] {
    Book book;
    for (const char* key : kKeys) readPaper(YamlSection::load(paperFile(key)), key, book);
    markObserved(YamlSection::load(paperFile("observed")), book.experiments);
    return book;
  }();
  return all;
}

}  // namespace

Verdict Row::verdictAt(double value) const {
  return verdictOf({statement, paper, value, tolerance, direction, incomparable.empty(), observed});
}

double Row::agreeing() const {
  const Verdict median = verdict();
  const auto same = std::count_if(here.all().begin(), here.all().end(),
                                  [&](double value) { return verdictAt(value) == median; });
  return static_cast<double>(same) / static_cast<double>(std::max<std::size_t>(here.count(), 1));
}

std::string paperFile(const std::string& name) {
  for (const auto& folder : configFolders()) {
    std::string file = folder + "/../papers/" + name + ".yaml";
    if (std::filesystem::exists(file)) return file;
  }
  throw InputError("papers/" + name + ".yaml: expected beside one of the config folders");
}

const std::vector<Paper>& papers() { return book().papers; }
const std::vector<Experiment>& experiments() { return book().experiments; }
const Settings& settings() { return book().settings; }

std::vector<Experiment> experimentsIn(const std::string& text, const std::string& key) {
  Book book;
  readPaper(YamlSection::parse(text, key), key, book);
  return book.experiments;
}

Rows rowsOf(const Experiment& experiment) {
  Rows rows;
  for (const PlannedRow& planned : experiment.rows) rows.push_back(computed(planned, rows));
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

}  // namespace fpc::papers
