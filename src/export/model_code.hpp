// A Takagi-Sugeno model, how far it is trusted, and the references, as code of a block. Private to
// the room.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "export/clp_code.hpp"
#include "fmbpc/control/predictive_law.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// LocalModel: blend() makes y(k+1) = A x + B u + g at the given antecedents; only the rows of the
/// outputs are stored, the others shift.
class ModelCode {
 public:
  /// `model` is matched to the plant. Names of variables begin with `prefix`; tables with `tables`,
  /// which two copies of a model share.
  ModelCode(BlockParts& parts, const TsModel& model, const std::string& prefix,
            const std::string& tables);
  const LocalModel& layout() const { return layout_; }
  int n_x() const { return static_cast<int>(layout_.stateSize()); }
  int partitionOf(int output) const;  ///< the first output with the weights of this one
  int outputRow(int output) const { return static_cast<int>(layout_.outputState(output)); }

  /// Firing weights and rows at this state (u(k) replaced by u(k-1)) and d(k).
  void blend(const ir::Value& state, const ir::Value& d);
  /// All of a state at rest.
  void rest(const ir::Value& state, const ir::Value& y, const ir::Value& u, const ir::Value& d);
  /// Calls for every row whose value stands in the next one a sample later.
  void eachShift(const std::function<void(int row)>& see) const;
  /// A state one sample on: `y` enters, `u` and `d` become the newest past ones.
  void shift(const ir::Value& state, const ir::Value& y, const ir::Value& u, const ir::Value& d);

  ir::Value A, B, g;               ///< n_y n_x, n_y n_u, n_y
  std::vector<ir::Value> weights;  ///< of each output

 private:
  /// Tables of trapezes, one entry for each antecedent and rule.
  struct Flanks {
    std::string name;
    ir::Value lower{0}, upper{0}, left{0}, right{0};
    double least{}, least_span{};  ///< half of the smallest flank and span that are above 0
  };
  /// Antecedents with sets of one shape; their values begin at `first`.
  struct Group {
    MembershipShape shape;
    std::vector<std::size_t> of;
    int first;
    Flanks flanks;
  };
  void fire(int output, const ir::Value& state, const ir::Value& d);
  void sum(const ir::Value& w, int n);
  std::vector<Group> groupsOf(int output) const;
  void declareFlanks(int output, const std::vector<std::size_t>& of, Flanks& flanks);
  void degrees(int output, const Group& group, const ir::Value& z, const ir::Value& alive,
               const ir::Value& product);
  void nearest(int output, const std::vector<Group>& groups, const ir::Value& z);
  ir::Value placed(const Regressor& r, const ir::Value& state, const ir::Value& d) const;
  ir::Value table(const std::string& name, const std::vector<double>& values);

  BlockParts& b_;
  ir::Program& p_;
  LocalModel layout_;
  std::string prefix_, tables_;
  ir::Value a_, b1_, c_, n_, part_;
};

/// u(k) inside what the guard leaves of the moves: see GuardedController without fallback, locks
/// and swings. @throws InputError for those.
class GuardCode {
 public:
  GuardCode(BlockParts& parts, const TsModel& model);
  void begin();
  /// After the law, whose answer it narrows, and what an optimizer may ask for.
  void step(ClpCode* optimizer);

 private:
  void distance();
  void reach(const ir::Value& to, const ir::Value& limit, const ir::Value& i);
  void leaveAll(ClpCode& optimizer);

  BlockParts& b_;
  ir::Program& p_;
  const TsModel& model_;
  bool known_;
  ir::Value trust_, square_, nearest_, a_, move_, lower_, upper_, acting_, trust_out_;
};

/// What PredictiveLaw is to every law with a model: references, hand-over, holding.
class PredictiveCode : public LawCode {
 public:
  void begin() override { guard_.begin(); }
  void reset() override;
  void step() override;
  ClpCode* optimizer() override { return clp_ ? &*clp_ : nullptr; }

 protected:
  PredictiveCode(BlockParts& parts, const PredictiveLawParams& params, const TsModel& model);
  virtual void startModel() = 0;    ///< at rest at this sample
  virtual void advanceModel() = 0;  ///< from k-1
  virtual void propose() = 0;       ///< b_.u before transfer and limits; may take b_.ok away
  virtual void keep() {}            ///< for the next sample
  virtual ir::Value healthy() = 0;  ///< whether the states can be used
  /// For a loop with a section clp; propose() then fills it.
  void beginOptimizer(const LocalModel& model, int lead);

  BlockParts& b_;
  ir::Program& p_;
  const PredictiveLawParams& law_;
  ir::Value reference_, start_, dm_, past_;
  std::optional<ClpCode> clp_;

 private:
  GuardCode guard_;
  ir::Value pending_, bias_, clipped_;
};

}  // namespace fpc
