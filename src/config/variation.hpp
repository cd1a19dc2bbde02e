// Seeds, and numbers that are drawn anew for each of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

/// A number that is drawn anew for every seed, the same for all loops.
struct Variation {
  std::string key;  ///< path as --set takes it
  double lower{}, upper{};
  bool factor{true};  ///< of the loop's or the plant's own number; false: the number itself
};

/// "1:40", "1,2,7" or a mixture. @throws InputError naming `where`.
std::vector<std::uint64_t> parseSeeds(const std::string& text, const std::string& where);
/// "KEY=0.7:1.3" (factors) or "KEY=value:0.1:0.2" (numbers). @throws InputError.
Variation parseVariation(const std::string& text);
/// @throws InputError naming the key.
void checkVariations(const std::vector<Variation>& vary);

/// A number as a file or an option has it. @throws InputError naming `where`.
double plainNumber(const std::string& text, const std::string& where);
/// Under `seeds`: a text as above, or a list.
std::vector<std::uint64_t> readSeeds(YamlSection& section);
/// Under `vary`: {KEY: [lower, upper]} are factors, {KEY: {values: [lower, upper]}} numbers.
std::vector<Variation> readVariations(YamlSection& section);

}  // namespace fpc
