// Stage 5: a predictive law and the PI that it falls back to, both tuned over the same ensemble
// with the same effort, and the word which of the two is offered.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "model/linear_model.hpp"
#include "runtime/commissioning/process_models.hpp"

namespace fpc {

struct DesignParams {
  int evaluations{48};   ///< points that each search judges, each over the tuned members
  int tuned_members{4};  ///< beside the likeliest model
  /// Largest sensitivity that a member may have (astrom2008), or that of the control in charge on
  /// half of them.
  double peak{2.0};
  double movement{0.1};  ///< weight of the moves beside the errors
  int threads{0};        ///< 0: all cores
  std::uint64_t seed{1};
  std::function<void(const std::string&)> show;  ///< called with what is done; may be empty
};

/// What one law reaches over an ensemble.
struct DesignFigures {
  double tuned{kInfinity};    ///< mean cost over what it was tuned on; infinite: was not tuned
  std::vector<double> costs;  ///< of each member that was held out
  double worst_peak{};        ///< sensitivity, largest of the models probed; infinite: not stable
  double least_gain{}, least_delay_s{};  ///< margins, least of them
};

struct Design {
  std::string law, pi;  ///< the texts of the two loop files
  DesignFigures law_figures, pi_figures;
  double ratio{kInfinity};  ///< cost of the law over that of the PI, mean of the held-out pairs
  double ratio_bound{kInfinity};  ///< half width of its 95 % interval
  /// Stable on all members, and better than the control in charge and the PI beyond the bounds.
  bool offers_law{};
  /// The law is not offered, and the PI is stable on all members and better than that control.
  bool offers_pi{};
  std::vector<double> present_costs;  ///< as `costs`, of the control in charge; empty: none
  std::vector<std::string> remarks;
  std::vector<WeakDirection> weak;
  /// Of the control in charge, median of the members; infinite: none, or not looked at.
  double present_peak{kInfinity};
  std::size_t refuted{};  ///< members of the ensemble on which the control in charge is not stable
  std::size_t probed{};   ///< models: the likeliest, and all members that were not refuted
};

/// @throws InputError if the plant's loop file cannot be rewritten, or if no output is to be held.
Design designLaws(const CommissioningBrief& brief, const Vector& noise,
                  const std::string& model_file, const ProcessModels& models,
                  const DesignParams& params);
OrderedJson toJson(const Design& design, const PlantInfo& plant);

/// Whether the present control holds half of the ensemble at least; true without such a control.
bool presentHolds(const CommissioningBrief& brief, const ProcessModels& models);

/// The loop with a model in the place of its plant, which begins at `rest`, with neither schedule.
LoopFile onModel(const LoopFile& loop, const TsModel& model, const LinearPoint& rest);

}  // namespace fpc
