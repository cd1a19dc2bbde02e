// Structures of one output that depends on other outputs.
#pragma once

#include "identification/auto_output.hpp"

namespace fpc {

/// Linear models of five orders, fitted to one step and to free runs, with each other output, then
/// with all. None where something is known of the output.
std::vector<Candidate> linearForms(const SearchedOutput& alone, int output, int outputs);

/// For the same sets: the fuzzy model found alone; rules on the others; rules on inputs and others,
/// with one past value of each as well.
std::vector<Candidate> ruleForms(const SearchedOutput& alone, int output, int outputs);

/// More rules, and rules on the output too; none for a model without others or rules.
std::vector<Candidate> nearForms(const Candidate& chosen);

}  // namespace fpc
