// Small helpers for messages and files: lists of names, numbers that survive a round trip.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fpc {

/// "a, b, c"
std::string join(const std::vector<std::string>& words, const std::string& separator = ", ");
/// Shortest decimal text that reads back to the same double.
std::string exactText(double value);
/// The finite decimal number that the whole text is, "+1.5e3"; empty if it is none.
std::optional<double> numberOf(const std::string& text);
/// Four significant digits, for people; "-" for NaN.
std::string shortText(double value);
/// Rows of equally many cells, in lines: first column left, the others right aligned.
std::string alignedTable(const std::vector<std::vector<std::string>>& rows);
/// The same with all columns left aligned, for words; no blanks at the end of a line.
std::string leftTable(const std::vector<std::vector<std::string>>& rows);
/// The known words that somebody may have meant, the likeliest first, at most `limit`: few letters
/// left out, added, changed or swapped, or the same beginning. Empty if none is near.
std::vector<std::string> nearest(const std::string& word, const std::vector<std::string>& known,
                                 std::size_t limit = 3);
/// The text with every ${NAME} replaced by the environment variable NAME.
/// @throws InputError naming `where` if a variable is not set or a brace is not closed.
std::string expandEnvironment(const std::string& text, const std::string& where);

}  // namespace fpc
