#include "identification/auto_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmbpc/base/text.hpp"
#include "identification/coupled_candidates.hpp"
#include "identification/coupled_options.hpp"

namespace fpc {
namespace {

using Eigen::Index;
using Choice = CoupledChoice;
using Figures = std::vector<AutoFigures>;

constexpr double kHurt = 1.03;  // of a linear model whose partner became fuzzy

class Coupling {
 public:
  Coupling(const std::vector<SearchedOutput>& alone, const SearchLimits& limits,
           AutoIdentification& result)
      : alone_(alone),
        limits_(limits),
        result_(result),
        n_(alone.size()),
        lines_(alone, limits),
        rules_(alone, limits) {}

  void run() {
    const bool begun = addLines();
    if (begun) {
      line_ = Choice(n_, 0);
      if (chooseLines()) adoptLines();
      if (addRules()) adoptRules();
    }
    if (lines_.isOver())
      result_.remarks.push_back(
          leftOutWords(limits_, "models in which outputs depend on each other"));
  }

 private:
  /// Option 0 of each output is its linear model alone. false: no time.
  bool addLines() {
    for (std::size_t i = 0; i < n_; ++i) {
      if (lines_.add(i, {alone_[i].linear}).front() != 0) return false;
      const auto list = linearForms(alone_[i], static_cast<int>(i), static_cast<int>(n_));
      std::vector<std::size_t> places = lines_.add(i, list);
      const std::size_t forms = places.size() / (n_ > 2 ? n_ : 1);  // each other output, then all
      together_.emplace_back(places.end() - static_cast<std::ptrdiff_t>(forms), places.end());
    }
    return true;
  }

  /// All outputs with all others, in one form.
  std::vector<Choice> starts() const {
    std::vector<Choice> list{Choice(n_, 0)};
    std::size_t forms = 0;
    for (const auto& t : together_) forms = std::max(forms, t.size());
    for (std::size_t f = 0; f < forms; ++f) {
      Choice choice(n_, 0);
      for (std::size_t i = 0; i < n_; ++i)
        if (f < together_[i].size() && together_[i][f] != CoupledOptions::kNone)
          choice[i] = together_[i][f];
      list.push_back(choice);
    }
    return list;
  }

  /// The choice of linear models into line_; false: all stay alone.
  bool chooseLines() {
    const Figures alone = lines_.figures(line_);
    Choice best = line_;
    double lowest = kInfinity;
    for (const auto& start : starts()) {
      const double value = lines_.objective(start);
      if (!(value < lowest)) continue;
      lowest = value;
      best = start;
    }
    line_ = prunedLines(lines_.descend(best), alone);
    if (isAlone(line_) && !isAlone(best)) line_ = prunedLines(lines_.descend(Choice(n_, 0)), alone);
    return !isAlone(line_);
  }

  static bool isAlone(const Choice& choice) {
    return std::all_of(choice.begin(), choice.end(), [](std::size_t o) { return o == 0; });
  }

  /// Outputs that gain too little by the others go back to their own model, the least gain first.
  Choice prunedLines(Choice choice, const Figures& alone) const {
    for (;;) {
      const Figures now = lines_.figures(choice);
      std::size_t worst = n_;
      for (std::size_t i = 0; i < n_; ++i) {
        if (choice[i] == 0 || isWorthIt(now[i], alone[i])) continue;
        if (worst == n_ || now[i].mean * alone[worst].mean > now[worst].mean * alone[i].mean)
          worst = i;
      }
      if (worst == n_) return choice;
      choice[worst] = 0;
    }
  }

  /// The fit to all rows, or nothing.
  bool fitAll(const CoupledOptions& from, std::size_t i, std::size_t o, const AutoFigures& figures,
              OutputModel& model) const {
    Judgement judged;
    judged.candidate = from.option(i, o).candidate;
    judged.rmse = figures.free_run;
    const Fitted whole = fitWhole(from.data(i), judged, limits_.window);
    if (!whole.finite) return false;
    model = toSubmodel(from.data(i), whole);
    return true;
  }

  void adoptLines() {
    const Figures alone = lines_.figures(Choice(n_, 0));
    std::vector<OutputModel> models(n_);
    for (std::size_t i = 0; i < n_; ++i)
      if (line_[i] != 0 && !fitAll(lines_, i, line_[i], lines_.figures(line_)[i], models[i])) {
        line_[i] = 0;
        line_ = prunedLines(line_, alone);
      }
    const Figures now = lines_.figures(line_);
    for (std::size_t i = 0; i < n_; ++i) {
      if (line_[i] == 0) continue;
      AutoOutput& found = result_.outputs[i];
      found.linear = now[i];
      result_.linear.submodels[i] = models[i];
      if (!found.fuzzy_model) result_.model.submodels[i] = models[i];
      tell(i, lines_.option(i, line_[i]), now[i], ModelKind::kLinear);
    }
  }

  /// Option 0: the linear choice; 1: the fuzzy model alone, if it stands; then with other outputs.
  bool addRules() {
    for (std::size_t i = 0; i < n_; ++i) {
      if (rules_.add(i, {lines_.option(i, line_[i]).candidate}).front() != 0) return false;
      if (aloneRules(i) != 0 && rules_.add(i, {*alone_[i].fuzzy}).front() != 1) return false;
      rules_.add(i, ruleForms(alone_[i], static_cast<int>(i), static_cast<int>(n_)));
    }
    return true;
  }

  /// Then what is near the rules that were chosen with other outputs.
  Choice descended(Choice choice) {
    choice = rules_.descend(choice);
    for (std::size_t i = 0; i < n_; ++i)
      rules_.add(i, nearForms(rules_.option(i, choice[i]).candidate));
    return rules_.descend(choice);
  }

  std::size_t aloneRules(std::size_t i) const { return result_.outputs[i].fuzzy_model ? 1 : 0; }

  /// The first output that does not keep its option, n_: none.
  std::size_t refused(const Choice& choice, const Figures& line, const Figures& alone) const {
    const Figures now = rules_.figures(choice);
    for (std::size_t i = 0; i < n_; ++i) {
      const bool asBefore = choice[i] == aloneRules(i) && line_[i] == 0;
      if (!asBefore && choice[i] > 0 && !(now[i].fit > 0.0 && isWorthIt(now[i], line[i]))) return i;
      if (choice[i] > aloneRules(i) && !isWorthIt(now[i], alone[i])) return i;
      if (choice[i] > 0 || !(now[i].mean > kHurt * line[i].mean)) continue;
      for (const int partner : rules_.option(i, 0).candidate.partners)
        if (choice[static_cast<std::size_t>(partner)] > 0) return static_cast<std::size_t>(partner);
    }
    return n_;
  }

  Choice prunedRules(Choice choice, const Figures& line, const Figures& alone) const {
    for (std::size_t i = refused(choice, line, alone); i < n_; i = refused(choice, line, alone))
      choice[i] = choice[i] > aloneRules(i) ? aloneRules(i) : 0;
    return choice;
  }

  void adoptRules() {
    Choice choice(n_);
    for (std::size_t i = 0; i < n_; ++i) choice[i] = aloneRules(i);
    const Figures line = rules_.figures(Choice(n_, 0)), alone = rules_.figures(choice);
    choice = descended(choice);
    for (std::size_t i = 0; i < n_; ++i) choice[i] = std::max(choice[i], aloneRules(i));
    choice = prunedRules(choice, line, alone);
    std::vector<OutputModel> models(n_);
    for (std::size_t i = 0; i < n_; ++i)
      if (choice[i] > aloneRules(i) &&
          !fitAll(rules_, i, choice[i], rules_.figures(choice)[i], models[i])) {
        choice[i] = aloneRules(i);
        choice = prunedRules(choice, line, alone);
      }
    const Figures now = rules_.figures(choice);
    for (std::size_t i = 0; i < n_; ++i) {
      AutoOutput& found = result_.outputs[i];
      const bool coupled = choice[i] > aloneRules(i);
      if (coupled) {
        found.regressors = now[i];
        found.blend = {};  // was that of another model
        result_.model.submodels[i] = models[i];
        tell(i, rules_.option(i, choice[i]), now[i], ModelKind::kRegressors);
      } else if (choice[i] == 0) {
        result_.model.submodels[i] = result_.linear.submodels[i];
      }
      found.fuzzy_model = choice[i] > 0;
      if (!found.fuzzy_model) found.blend = {};
    }
  }

  /// A trial of its own, chosen instead of the one before.
  void tell(std::size_t i, const CoupledOption& option, const AutoFigures& f, ModelKind kind) {
    const std::string& output = result_.outputs[i].output;
    std::vector<std::string> names;
    for (const int j : option.candidate.partners)
      names.push_back(result_.outputs[static_cast<std::size_t>(j)].output);
    auto at = result_.trials.end();
    for (auto t = result_.trials.begin(); t != result_.trials.end(); ++t) {
      if (t->output != output || t->kind != kind) continue;
      t->chosen = false;
      if (at == result_.trials.end()) at = t;
    }
    double spread = 0.0;
    for (const double b : f.blocks)
      spread += (b - f.mean) * (b - f.mean) / static_cast<double>(f.blocks.size());
    result_.trials.insert(at, {output, kind, option.candidate.text() + " (" + join(names) + ")",
                               option.parameters, f.mean, std::sqrt(spread), true});
  }

  const std::vector<SearchedOutput>& alone_;
  const SearchLimits& limits_;
  AutoIdentification& result_;
  std::size_t n_;
  CoupledOptions lines_, rules_;
  std::vector<std::vector<std::size_t>> together_;  ///< per output, forms with all others
  Choice line_;
};

}  // namespace

void coupleOutputs(const std::vector<SearchedOutput>& alone, const SearchLimits& limits,
                   AutoIdentification& result) {
  if (alone.size() < 2) return;
  Coupling(alone, limits, result).run();
}

}  // namespace fpc
