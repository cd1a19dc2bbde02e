// What `fmbpc reproduce` prints: a summary per paper, details, JSON, a page in Markdown.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "papers/experiment.hpp"

namespace fpc::papers {

/// An experiment with its rows.
struct Outcome {
  Experiment experiment;
  Rows rows;
};

using Counts = std::map<Verdict, std::size_t>;
Counts countsOf(const Rows& rows);
/// "3 reproduced, 1 close; 2 hold, 1 fails": figures, then statements, then rows without a result.
std::string inWords(const Counts& counts);
/// "within 0.3 %", "12 % off", "median of 24, 0.31..0.52, 22 agree" and the row's own words.
std::string remarkOf(const Row& row);
/// Of the row that says most about what is not reached; empty if all is.
std::string reasonOf(const Rows& rows);

/// As shortText(), but of a statement that fails with as many digits as tell it from its limit:
/// "1.00001" where "1" would hide why.
std::string hereText(const Row& row);
/// One line for each failed run and one that counts the rows without a result; empty: none.
std::vector<std::string> failuresOf(const std::vector<Outcome>& outcomes,
                                    const std::vector<std::string>& failed_runs);

std::string summaryText(const std::vector<Outcome>& outcomes);
std::string detailsText(const Outcome& outcome);
OrderedJson toJson(const std::vector<Outcome>& outcomes);
std::string markdown(const std::vector<Outcome>& outcomes);

}  // namespace fpc::papers
