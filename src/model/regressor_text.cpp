#include "model/regressor_text.hpp"

#include <algorithm>

namespace fpc {
namespace {

/// The lag in "", "-1", "-12"...; nothing for anything else.
std::optional<int> parseLag(const std::string& text) {
  if (text.empty()) return 0;
  const bool digits = text.find_first_not_of("0123456789", 1) == std::string::npos;
  if (text[0] != '-' || text.size() < 2 || text.size() > 5 || !digits) return std::nullopt;
  return std::stoi(text.substr(1));
}

}  // namespace

std::optional<Regressor> parseRegressor(const TsModel& model, const std::string& text) {
  const auto open = text.find("(k");
  if (open == std::string::npos || text.back() != ')') return std::nullopt;
  const std::string name = text.substr(0, open);
  const auto lag = parseLag(text.substr(open + 2, text.size() - open - 3));
  if (!lag) return std::nullopt;
  for (const SignalKind kind :
       {SignalKind::kOutput, SignalKind::kInput, SignalKind::kDisturbance}) {
    const auto& signals = model.signals(kind);
    const auto found =
        std::find_if(signals.begin(), signals.end(), [&](const auto& s) { return s.name == name; });
    if (found != signals.end())
      return Regressor{kind, static_cast<int>(found - signals.begin()), *lag};
  }
  return std::nullopt;
}

}  // namespace fpc
