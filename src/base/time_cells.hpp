// What cells of a time column cannot mean as plain numbers. Private to the package.
#pragma once

#include "base/csv.hpp"

namespace fpc {

/// @throws InputError naming file, line and column: every cell is a date without hyphens (20250228,
/// 202502282330, 20250228233000), whose differences are no times; or the first one is so large that
/// it counts milliseconds, or less, since 1970.
void requirePlainTimes(const CsvTable& table, Eigen::Index column);

}  // namespace fpc
