#include "identification/auto_structures.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace fpc {
namespace {

constexpr int kSearchIterations = 60;  // models of the output's past
constexpr int kStateIterations = 100;
constexpr int kLongestOfRules = 4;    // past values
constexpr std::size_t kFamilies = 3;  // whose ridge and number of rules are refined

/// Leaves out what was judged before; `known` are texts.
Candidates fresh(const Candidates& list, std::vector<std::string> known) {
  Candidates kept;
  for (const auto& c : list) {
    const std::string text = c.text();
    if (std::find(known.begin(), known.end(), text) != known.end()) continue;
    known.push_back(text);
    kept.push_back(c);
  }
  return kept;
}

}  // namespace

Candidates delayCandidates(const Candidate& base) {
  Candidates list;
  Candidate c = base;
  c.iterations = kSearchIterations;
  for (const auto& [n, m] : std::vector<std::pair<int, int>>{{1, 1}, {2, 2}})
    for (const bool free : {false, true}) {
      c.order = n;
      c.input_terms = m;
      c.free_run = free;
      list.push_back(c);
    }
  return list;
}

Candidates linearCandidates(const Candidate& base, bool states) {
  Candidates list;
  Candidate c = base;
  c.iterations = kSearchIterations;
  const std::vector<std::pair<int, int>> orders{{1, 1}, {1, 2}, {2, 1}, {2, 2},
                                                {3, 2}, {3, 3}, {4, 4}};
  for (const auto& [n, m] : orders)
    for (const bool free : {false, true})
      for (const double ridge : {1e-3, 1.0, 100.0}) {
        if (!free && ridge > 1e-3) continue;
        c.order = n;
        c.input_terms = m;
        c.free_run = free;
        c.linear_ridge = ridge;
        list.push_back(c);
      }
  c = base;
  c.iterations = kSearchIterations;
  c.hidden = true;
  for (int n = 1; states && n <= 4; ++n)
    for (const bool chain : {false, true})
      for (const double ridge : {1e-3, 1.0}) {
        if (n == 1 && chain) continue;
        c.order = n;
        c.chain = chain;
        c.linear_ridge = ridge;
        list.push_back(c);
      }
  return list;
}

Candidates longerLines(const Candidate& base) {
  Candidates list;
  Candidate c = base;
  c.iterations = kSearchIterations;
  for (const int n : {5, 6, 8, 10})
    for (const bool free : {false, true}) {
      c.order = c.input_terms = n;
      c.free_run = free;
      list.push_back(c);
    }
  return list;
}

Candidates laterLines(const Candidate& base, const std::vector<int>& second) {
  Candidates list;
  Candidate c = base;
  c.iterations = kSearchIterations;
  c.second = second;
  for (const auto& [n, m] : std::vector<std::pair<int, int>>{{1, 1}, {2, 1}, {2, 2}, {3, 3}})
    for (const bool free : {false, true}) {
      c.order = n;
      c.input_terms = m;
      c.free_run = free;
      list.push_back(c);
    }
  return list;
}

Candidates ruleCandidates(const Candidate& base, const std::vector<Judgement>& linear) {
  Candidates list;
  std::vector<std::pair<int, int>> orders;
  for (const auto& j : linear) {
    if (j.candidate.hidden || j.candidate.order > kLongestOfRules) continue;
    const std::pair<int, int> o{j.candidate.order, j.candidate.input_terms};
    if (orders.size() < 2 && std::find(orders.begin(), orders.end(), o) == orders.end())
      orders.push_back(o);
  }
  for (const auto& o : {std::pair<int, int>{2, 2}, std::pair<int, int>{1, 1}})
    if (std::find(orders.begin(), orders.end(), o) == orders.end()) orders.push_back(o);
  Candidate c = base;
  c.iterations = kSearchIterations;
  for (const int rules : {2, 3})
    for (const auto& [n, m] : orders)
      for (const auto on : {AntecedentChoice::kOutput, AntecedentChoice::kOutputAndInputs,
                            AntecedentChoice::kInputs, AntecedentChoice::kOutputs}) {
        if (n == 1 && on == AntecedentChoice::kOutputs) continue;
        c.order = n;
        c.input_terms = m;
        c.rules = rules;
        c.antecedents = on;
        list.push_back(c);
      }
  return list;
}

Candidates refinedRules(const std::vector<Judgement>& regressors) {
  Candidates list;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, regressors.size()); ++i) {
    Candidate c = regressors[i].candidate;
    for (const double ridge : {0.1, 1.0, 100.0, 1000.0}) {
      Candidate other = c;
      other.ridge = ridge;
      list.push_back(other);
    }
    for (int more = 1; more <= 2; ++more) {
      Candidate other = c;
      other.rules += more;
      list.push_back(other);
      other = c;
      other.seed += static_cast<std::uint64_t>(more);
      list.push_back(other);
    }
  }
  std::vector<std::string> known;
  for (const auto& j : regressors) known.push_back(j.candidate.text());
  return fresh(list, std::move(known));
}

Candidates stateCandidates(const Candidate& base, bool absolute) {
  using A = AntecedentChoice;
  struct Form {
    int order;
    bool chain, absolute;
    A on;
  };
  std::vector<Form> forms{{2, true, false, A::kState},   {2, true, false, A::kStateAndInputs},
                          {2, true, false, A::kOutput},  {2, false, false, A::kState},
                          {2, false, false, A::kOutput}, {3, true, false, A::kState},
                          {3, false, false, A::kState},  {2, false, false, A::kInputs},
                          {3, false, false, A::kInputs}};
  if (absolute)
    forms.insert(forms.begin(), {{3, false, true, A::kOutput},
                                 {2, false, true, A::kOutput},
                                 {3, false, true, A::kState},
                                 {2, false, true, A::kState}});
  Candidates list;
  for (const auto& form : forms)
    for (const int rules : {1, 2, 3}) {
      if (rules == 1 && (!form.absolute || form.on != A::kOutput)) continue;
      Candidate c = base;
      c.hidden = true;
      c.iterations = kStateIterations;
      c.order = form.order;
      c.chain = form.chain;
      c.absolute = form.absolute;
      c.antecedents = form.on;
      c.rules = rules;
      list.push_back(c);
    }
  return list;
}

namespace {

std::vector<Candidate> bestFamilies(const std::vector<Group>& state) {
  std::vector<Candidate> families;
  for (const auto& g : state) {
    const Candidate& c = g.members.front().candidate;
    const auto same = [&c](const Candidate& f) {
      return f.order == c.order && f.chain == c.chain && f.absolute == c.absolute &&
             f.antecedents == c.antecedents;
    };
    if (families.size() < kFamilies && std::none_of(families.begin(), families.end(), same))
      families.push_back(c);
  }
  return families;
}

/// All delays by so many samples earlier or later; none twice.
void addShifted(const Candidate& c, Candidates& list) {
  const int longest = c.delay.empty() ? 0 : *std::max_element(c.delay.begin(), c.delay.end());
  for (const int later : {-2, -1, 1, 2}) {
    if (longest + later < 0) continue;
    list.push_back(c);
    list.back().later = later;
  }
}

std::vector<std::string> textsOf(const std::vector<Group>& state) {
  std::vector<std::string> known;
  for (const auto& g : state) known.push_back(g.members.front().candidate.text());
  return known;
}

}  // namespace

Candidates shiftedLines(const std::vector<Judgement>& linear) {
  Candidates list;
  for (const auto& j : linear) {
    if (j.candidate.hidden) continue;
    addShifted(j.candidate, list);
    break;
  }
  return list;
}

Candidates shiftedStates(const std::vector<Group>& state) {
  Candidates list;
  for (const auto& c : bestFamilies(state)) addShifted(c, list);
  return fresh(list, textsOf(state));
}

Candidates refinedStates(const std::vector<Group>& state) {
  Candidates list;
  for (const auto& c : bestFamilies(state)) {
    for (const double ridge : {3.0, 30.0, 100.0}) {
      Candidate other = c;
      other.ridge = ridge;
      list.push_back(other);
    }
    Candidate other = c;
    other.rules += 1;
    list.push_back(other);
  }
  return fresh(list, textsOf(state));
}

}  // namespace fpc
