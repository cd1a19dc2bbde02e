// What may be done to cells that are missing or cannot be true, and doing it: for records of
// disturbances and for identification alike. Everything done is counted.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

enum class MissingCells { kError, kDrop, kInterpolate, kHold };
enum class Implausible { kError, kClip, kHold, kInterpolate, kDrop };

/// For one column.
struct ColumnRules {
  MissingCells missing{MissingCells::kError};
  double lower{-std::numeric_limits<double>::infinity()};  ///< of what is plausible
  double upper{std::numeric_limits<double>::infinity()};
  Implausible implausible{Implausible::kError};
  std::string unit;             ///< for messages
  std::string missing_key;      ///< the key that allows missing cells, for messages
  std::string implausible_key;  ///< the key that says what to do with implausible cells
};

struct ColumnRepairs {
  std::uint64_t missing{};      ///< cells that were filled (or left missing with kDrop)
  std::uint64_t implausible{};  ///< cells outside lower..upper that were clipped, filled or dropped
};

/// Repairs a column in place. Held cells take the last measured value, interpolated ones lie on the
/// straight line between their measured neighbours in `times`; before the first measured cell the
/// first one stands, after the last one the last. Dropped cells are NaN.
/// `where` names the place of a row for messages.
/// @throws InputError where a rule says kError, or if nothing plausible is left.
ColumnRepairs repairColumn(Eigen::Ref<Vector> cells, const std::vector<double>& times,
                           const ColumnRules& rules,
                           const std::function<std::string(Eigen::Index)>& where);

}  // namespace fpc
