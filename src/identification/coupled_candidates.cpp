#include "identification/coupled_candidates.hpp"

#include <utility>

namespace fpc {
namespace {

constexpr int kIterations = 60;
constexpr int kMore = 2;  // rules

/// Sets of other outputs: each one, then all.
std::vector<std::vector<int>> partnersOf(int output, int outputs) {
  std::vector<std::vector<int>> sets;
  std::vector<int> all;
  for (int j = 0; j < outputs; ++j)
    if (j != output) all.push_back(j);
  for (const int j : all) sets.push_back({j});
  if (all.size() > 1) sets.push_back(all);
  return sets;
}

}  // namespace

std::vector<Candidate> linearForms(const SearchedOutput& alone, int output, int outputs) {
  std::vector<Candidate> list;
  if (!alone.data.known.empty()) return list;
  Candidate c = alone.linear;
  c.iterations = kIterations;
  c.linear_ridge = Candidate{}.linear_ridge;
  for (const auto& set : partnersOf(output, outputs))
    for (const auto& [order, terms] :
         std::vector<std::pair<int, int>>{{1, 1}, {2, 1}, {2, 2}, {3, 2}, {3, 3}})
      for (const bool free : {false, true}) {
        c.partners = set;
        c.order = order;
        c.input_terms = terms;
        c.free_run = free;
        list.push_back(c);
      }
  return list;
}

std::vector<Candidate> ruleForms(const SearchedOutput& alone, int output, int outputs) {
  std::vector<Candidate> list;
  if (!alone.data.known.empty()) return list;
  Candidate base = alone.linear;
  base.iterations = kIterations;
  base.free_run = true;
  base.order = base.input_terms = base.rules = 2;
  if (alone.fuzzy) base = *alone.fuzzy;
  const auto add = [&list](Candidate c, AntecedentChoice on, int rules) {
    c.antecedents = on;
    c.rules = rules;
    list.push_back(c);
  };
  for (const auto& set : partnersOf(output, outputs)) {
    base.partners = set;
    add(base, base.antecedents, base.rules);
    add(base, AntecedentChoice::kPartners, 2);
    add(base, AntecedentChoice::kPartners, 3);
    if (base.antecedents != AntecedentChoice::kOutputAndInputs)
      add(base, AntecedentChoice::kOutputAndInputs, 2);
    Candidate brief = base;
    brief.order = brief.input_terms = 1;
    add(brief, AntecedentChoice::kInputs, 2);
    add(brief, AntecedentChoice::kInputs, 4);
  }
  return list;
}

std::vector<Candidate> nearForms(const Candidate& chosen) {
  std::vector<Candidate> list;
  if (chosen.partners.empty() || chosen.rules < 2) return list;
  for (const auto on : {AntecedentChoice::kInputs, AntecedentChoice::kOutputAndInputs})
    for (const int rules : {chosen.rules, chosen.rules + kMore}) {
      if (on == chosen.antecedents && rules == chosen.rules) continue;
      list.push_back(chosen);
      list.back().antecedents = on;
      list.back().rules = rules;
    }
  return list;
}

}  // namespace fpc
