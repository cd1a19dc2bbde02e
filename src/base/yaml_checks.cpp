// What readers of sections share: required keys, names of signals, checks that know only the field.
#include "fmbpc/base/text.hpp"
#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

void need(const YamlSection& section, const std::string& key, const std::string& expected) {
  if (!section.has(key)) section.fail(key, expected);
}

int indexByName(YamlSection& section, const std::string& key,
                const std::vector<std::string>& names) {
  std::string name;
  need(section, key, "one of " + join(names));
  section.oneOf(key, name, names);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<int>(i);
  section.fail(key, "one of " + join(names));
}

namespace {

/// The place of a field that was named by its whole path from the top of the file; empty if it is
/// not one below the section.
std::string placeOfPath(const YamlSection& section, const std::string& path) {
  for (std::size_t from = 0; from < path.size(); from = path.find('.', from) + 1) {
    const std::string place = section.where(path.substr(from));
    const bool longer = place.size() > path.size();
    const std::size_t begin = longer ? place.size() - path.size() : 0;
    if (place.substr(begin) == path && (!longer || place[begin - 1] == ' ')) return place;
    if (path.find('.', from) == std::string::npos) break;
  }
  return "";
}

}  // namespace

void failAt(const YamlSection& section, const std::string& message) {
  const auto colon = message.find(':');
  std::string field = message.substr(0, colon);
  if (colon != std::string::npos && field.find(' ') == std::string::npos) {
    const std::string place = placeOfPath(section, field);
    if (!place.empty()) throw InputError(place + message.substr(colon));
  }
  field = field.substr(field.find_last_of('.') + 1);
  const bool is_field =
      colon != std::string::npos && field.find_first_of(" /[]") == std::string::npos;
  if (is_field) throw InputError(section.where(field) + message.substr(colon));
  std::string place = section.where("");
  if (place.back() == '.') place.pop_back();
  if (place.back() == ' ') place.erase(place.find_last_not_of(": ") + 1);
  throw InputError(place + ": " + message);
}

}  // namespace fpc
