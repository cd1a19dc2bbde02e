// The elementary functions of an exported block: from additions, multiplications and divisions
// only, so that every compiler of either language gives the same bits.
#pragma once

#include "export/ir.hpp"

namespace fpc::ir {

Value exponential(Program& program, const Value& x);  ///< x <= 0; within 2 ulp
Value squareRoot(Program& program, const Value& x);   ///< 0 <= x <= 1e24
Value cosine(Program& program, const Value& x);       ///< 0 <= x <= pi

}  // namespace fpc::ir
