#include "papers/words.hpp"

#include <algorithm>

#include "base/number.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc::papers {

double toNumber(const std::string& word) {
  const auto value = parseNumber(word);
  require(value.has_value(), "'" + word + "'", "a number");
  return *value;
}

std::size_t placeOf(const std::string& word, const std::vector<std::string>& known) {
  const auto at = std::find(known.begin(), known.end(), word);
  require(at != known.end(), "'" + word + "'", "one of " + join(known));
  return static_cast<std::size_t>(at - known.begin());
}

}  // namespace fpc::papers
