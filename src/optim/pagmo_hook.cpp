// What the core knows of pagmo2: whether the program has linked it.
#include "fmbpc/base/input_error.hpp"
#include "optim/pagmo_search.hpp"

namespace fpc {
namespace {

PagmoMaker& registered() {
  static PagmoMaker maker = nullptr;
  return maker;
}

}  // namespace

bool registerPagmo(PagmoMaker maker) {
  registered() = maker;
  return true;
}

bool hasPagmo() { return registered() != nullptr; }

std::unique_ptr<PopulationSearch> makePagmoSearch(const SearchParams& params, const Matrix& first,
                                                  const Vector& lower, const Vector& upper) {
  if (!hasPagmo())
    throw InputError("search.method: expected a method of this build: " + missingMethods());
  return registered()(params, first, lower, upper);
}

}  // namespace fpc
