// Linked where pagmo2 is not installed.
#include "fmbpc/base/input_error.hpp"
#include "optim/pagmo_search.hpp"

namespace fpc {

bool hasPagmo() { return false; }

std::unique_ptr<PopulationSearch> makePagmoSearch(const SearchParams&, const Matrix&, const Vector&,
                                                  const Vector&) {
  throw InputError("search.method: expected a method of this build: " + missingMethods());
}

}  // namespace fpc
