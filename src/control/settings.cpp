#include "fmbpc/control/settings.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/number.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

std::vector<std::string> wordsOf(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

void readNamed(const std::vector<std::string>& words, const std::vector<SignalInfo>& signals,
               const std::string& where, Vector& values) {
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    const auto place = std::find_if(signals.begin(), signals.end(), [&](const SignalInfo& s) {
      return equals != std::string::npos && s.name == word.substr(0, equals);
    });
    require(place != signals.end(), where,
            "NAME=number, NAME one of " + join(namesOf(signals)) + ", got '" + word + "'");
    values[place - signals.begin()] = settingNumber(word.substr(equals + 1), where);
  }
}

}  // namespace

double settingNumber(const std::string& text, const std::string& where) {
  const auto value = parseNumber(text);
  require(value && std::isfinite(*value), where, "finite numbers, got '" + text + "'");
  return *value;
}

int settingInteger(const std::string& text, const std::string& where) {
  const double value = settingNumber(text, where);
  require(std::abs(value) <= 1e9 && value == std::floor(value), where, "an integer");
  return static_cast<int>(value);
}

bool settingBoolean(const std::string& text, const std::string& where) {
  const bool yes = text == "true" || text == "1";
  require(yes || text == "false" || text == "0", where, "true or false, got '" + text + "'");
  return yes;
}

void readSignalValues(const std::string& text, const std::vector<SignalInfo>& signals,
                      const std::string& where, Vector& values) {
  const std::vector<std::string> words = wordsOf(text);
  require(!words.empty(), where, "a number, one for each signal, or NAME=number");
  Vector read = values;
  if (words[0].find('=') != std::string::npos) {
    readNamed(words, signals, where, read);
  } else {
    require(words.size() == 1 || words.size() == signals.size(), where,
            "one number, or " + std::to_string(signals.size()));
    for (std::size_t i = 0; i < signals.size(); ++i)
      read[static_cast<Eigen::Index>(i)] = settingNumber(words[words.size() == 1 ? 0 : i], where);
  }
  values = read;
}

std::string signalValuesText(const Vector& values, const std::vector<SignalInfo>& signals) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < signals.size(); ++i)
    words.push_back(signals[i].name + "=" + exactText(values[static_cast<Eigen::Index>(i)]));
  return join(words, " ");
}

}  // namespace fpc
