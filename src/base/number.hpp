// Numbers as text and back, the same bytes with every standard library: std::to_chars and
// std::from_chars where they know double, else (libstdc++ before 11) the same results through the C
// library.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fpc {

/// Shortest text from which `value` is read back exactly, as std::to_chars writes it; "nan", "inf"
/// and "-inf" as words.
std::string printNumber(double value);

/// The number that the whole of `text` is, by the grammar of std::from_chars (no spaces, no leading
/// +, no hexadecimal); nothing if it is none or out of the range of double. "nan" and "inf" are
/// numbers here.
std::optional<double> parseNumber(std::string_view text);

namespace portable {  // what is used without std::to_chars of double; tested beside it where there
                      // is one
std::string printNumber(double value);
std::optional<double> parseNumber(std::string_view text);
}  // namespace portable

}  // namespace fpc
