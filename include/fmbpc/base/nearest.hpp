// What somebody may have meant who wrote a name that does not exist.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fpc {

/// The known words that somebody may have meant, the likeliest first, at most `limit`: few letters
/// left out, added, changed or swapped, or the same beginning. Empty if none is near.
std::vector<std::string> nearest(const std::string& word, const std::vector<std::string>& known,
                                 std::size_t limit = 3);

}  // namespace fpc
