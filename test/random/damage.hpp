// Text files damaged as people and editors damage them.
#pragma once

#include <string>

#include "random/dice.hpp"

namespace fpc {

/// The text with one to three damages: a value replaced by a strange one, a line gone, twice,
/// moved or indented otherwise, a key misspelt, a byte flipped, the end cut off.
std::string damaged(const std::string& text, Dice& dice);

}  // namespace fpc
