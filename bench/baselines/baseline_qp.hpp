// Other people's solvers of quadratic programmes behind one interface, each linked if CMake has
// found it (FMBPC_BASELINES: a folder with include/ and lib/).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "optim/qp.hpp"

namespace fpc::bench {

class BaselineQp {
 public:
  virtual ~BaselineQp() = default;
  /// Whether it is made for such a problem at all; what it cannot take it is not asked.
  virtual bool canTake(const QpProblem& /*problem*/) const { return true; }
  /// Converts the problem into the solver's own layout and takes all memory; not timed.
  virtual void prepare(const QpProblem& problem) = 0;
  /// Solves the prepared problem without knowledge of the solve before. @return whether it says so
  virtual bool solve() = 0;
  /// The same with the active set or the point of the solve before; with a new Hessian no factor
  /// of it.
  virtual bool solveWarm(bool /*new_hessian*/) { return solve(); }
  virtual bool canWarm() const { return false; }
  virtual Vector x() const = 0;
};

struct BaselineType {
  std::string name;
  std::unique_ptr<BaselineQp> (*make)();
};

inline std::vector<BaselineType>& baselines() {
  static std::vector<BaselineType> all;
  return all;
}

inline bool registerBaseline(const std::string& name, std::unique_ptr<BaselineQp> (*make)()) {
  baselines().push_back({name, make});
  return true;
}

}  // namespace fpc::bench
