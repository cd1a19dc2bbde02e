// Stage 2: what a plant's instruments are like, and how it runs today, before anything is tested.
#pragma once

#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "runtime/commissioning/plant_record.hpp"

namespace fpc {

struct WatchedOutput {
  std::string name;
  double mean{}, deviation{};  ///< of the settled part
  double noise{};         ///< standard deviation of what changes from sample to sample at random
  double resolution{};    ///< smallest step that it shows, where that is what limits it; 0: none
  double missing{};       ///< share of the samples without a number
  bool frozen{false};     ///< shows one number for longer than its noise allows, or always
  bool quantised{false};  ///< its resolution is larger than its noise
  bool settled{true};     ///< its mean moves by less than its deviation over the last half
  double period_s{};      ///< of an oscillation that stands out; 0: none
  double memory_s{};      ///< after which it has forgotten: lag at which its correlation is 1/e
};

struct WatchedInput {
  std::string name;
  bool moves{false};
  double answers{};    ///< share of its news that past outputs explain, see feedbackShare()
  double dead_band{};  ///< commands that moved by less than this were not followed; 0: none seen
  bool stuck{false};   ///< its commands moved and it did not
  double offset{};     ///< between command and position, median
};

struct Watched {
  std::vector<WatchedOutput> outputs;
  std::vector<WatchedInput> inputs;
  Eigen::Index first{};  ///< row from which it is taken as settled
  /// What a person is to look at before the test, in words; `grave`: the test cannot be trusted.
  std::vector<std::string> remarks;
  bool grave{false};
};

Watched watch(const PlantRecord& record);
OrderedJson toJson(const Watched& watched);
Watched watchedOf(const OrderedJson& json);

}  // namespace fpc
