// What computes a number of a row: "ise(asp_case1*, x) / ise(asp_case1_pi_x*, x)".
//
// + - * / and parentheses over numbers and values of several runs (one value goes with all), the
// functions abs, sqrt, mean, median, lowest, highest, max (of two), distance (of a number from the
// range of some values) and those that are registered, whose arguments are words.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "papers/values.hpp"

namespace fpc::papers {

using Words = std::vector<std::string>;
using Computation = std::function<Values(const Words&)>;

/// @param arguments how many it takes. @return true
bool registerComputation(const std::string& name, std::size_t arguments, Computation computation);
/// Numbers by their name alone, such as "deviation".
using Names = std::function<Values(const std::string&)>;
/// Each call of a computation is done once. @throws InputError naming the expression and the place.
Values evaluate(const std::string& expression, const Names& names = {});
/// Whether it could be: syntax, names, numbers of arguments. @throws InputError likewise
void requireSound(const std::string& expression, const std::vector<std::string>& names);

}  // namespace fpc::papers
