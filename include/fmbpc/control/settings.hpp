// What a person may change of a controller while it runs: keys, texts, and the table that tells
// tools what to offer.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// Keys and values, as a person writes them.
using Settings = std::vector<std::pair<std::string, std::string>>;

enum class SettingKind { kNumber, kInteger, kBoolean, kText };

/// One key of the section `controller` that may change in a run. Values of several signals are one
/// text: see readSignalValues().
struct SettingInfo {
  std::string key;
  SettingKind kind{SettingKind::kText};
  std::string description;                            ///< one line, with an example
  double lower{-std::numeric_limits<double>::max()};  ///< of numbers and integers
  double upper{std::numeric_limits<double>::max()};
};

/// @throws InputError naming `where` unless the text is a number, or an integer.
double settingNumber(const std::string& text, const std::string& where);
int settingInteger(const std::string& text, const std::string& where);
/// "true", "false", "1" or "0". @throws InputError naming `where`.
bool settingBoolean(const std::string& text, const std::string& where);
/// "2" for all, "2 3" for each, or "NAME=2" with the others left as they are; commas are spaces.
/// @throws InputError naming `where`, then `values` (of the size of `signals`) stays.
void readSignalValues(const std::string& text, const std::vector<SignalInfo>& signals,
                      const std::string& where, Vector& values);
/// "NAME=2 OTHER=3"
std::string signalValuesText(const Vector& values, const std::vector<SignalInfo>& signals);

}  // namespace fpc
