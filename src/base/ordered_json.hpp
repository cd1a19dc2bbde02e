// JSON whose objects keep the order in which their keys were set; nlohmann-json from 3.7 on.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

namespace fpc {

#if NLOHMANN_JSON_VERSION_MAJOR > 3 || NLOHMANN_JSON_VERSION_MINOR >= 9
using OrderedJson = nlohmann::ordered_json;
#else
/// A key is before those that were seen after it; copies of a map share what was seen.
template <class Key>
class SeenFirst {
 public:
  bool operator()(const Key& one, const Key& other) const { return turn(one) < turn(other); }

 private:
  std::size_t turn(const Key& key) const {
    return seen_->emplace(key, seen_->size()).first->second;
  }
  std::shared_ptr<std::map<Key, std::size_t> > seen_{
      std::make_shared<std::map<Key, std::size_t> >()};
};

template <class Key, class Value, class, class Allocator>
using MapAsSet = std::map<Key, Value, SeenFirst<Key>, Allocator>;
using OrderedJson = nlohmann::basic_json<MapAsSet>;
#endif

}  // namespace fpc
