// A plugin that was built against another fmbpc must not be loaded: what both share would lie
// elsewhere in memory.
#pragma once

#include <cstddef>
#include <utility>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Counted up with every change of a virtual function that plugins implement.
inline constexpr std::size_t kInterface = 3;

/// Sizes of what a plugin and the core share.
template <typename... Types>
using LayoutOf = std::index_sequence<kInterface, EIGEN_MAX_ALIGN_BYTES, sizeof(Types)...>;

/// Defined in the core for its own layouts only: a library with others finds no such symbol, and
/// the loader refuses it.
template <typename Layout>
void requireSameLayout();

}  // namespace fpc
