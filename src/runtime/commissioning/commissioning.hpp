// Commissioning as one procedure: stages that each leave their files in a folder, and can be gone
// through again from any of them on.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "runtime/commissioning/brief.hpp"
#include "runtime/commissioning/plant_record.hpp"
#include "runtime/commissioning/staged_plant.hpp"

namespace fpc {

enum class CommissioningStage { kBrief, kWatch, kTest, kModel, kDesign };
inline std::vector<std::string> wordsOf(CommissioningStage) {
  return {"brief", "watch", "test", "model", "design"};
}
constexpr int kCommissioningStages = 5;
/// @throws InputError naming `field`.
CommissioningStage commissioningStage(const std::string& word, const std::string& field);

struct CommissioningOptions {
  int evaluations{48};  ///< of each search of stage design
  int members{16};      ///< of the ensemble
  int threads{0};       ///< 0: all cores
  /// A plant that lives, and the loop file of the loop that it runs in; null: the simulated one of
  /// the brief's loop file, from its start on.
  std::shared_ptr<StagedPlant> alive;
  const LoopFile* running{nullptr};
  std::function<void(CommissioningStage, const std::string&)> show;  ///< may be empty
};

/// The folder holds, of each stage that is done, STAGE.json with its figures and the fingerprint of
/// what it was made from; brief.yaml; watch.csv, test.csv (with the rows of the watch before it);
/// model.yaml and ensemble/; LOOP_law.yaml and LOOP_pi.yaml, loop files that run by themselves.
/// A brief or loop file that was changed makes all later stages new.
class Commissioning {
 public:
  /// @throws InputError, see readBrief().
  Commissioning(const std::string& brief, std::string folder, CommissioningOptions options = {});

  bool done(CommissioningStage stage) const;
  /// Goes through those up to `last` that are not done; what each says is in figures().
  /// @throws InputError where a stage cannot be gone through; those before it stay done.
  void run(CommissioningStage last);
  /// Takes the stage and all after it back.
  void undo(CommissioningStage first);
  OrderedJson figures(CommissioningStage stage) const;  ///< null if it is not done
  OrderedJson figures() const;  ///< of all stages, by name; null of those that are not done
  std::string lawFile() const;
  std::string piFile() const;

 private:
  std::string fingerprint(CommissioningStage stage) const;
  std::string file(CommissioningStage stage) const;
  void finish(CommissioningStage stage, OrderedJson figures);
  void show(CommissioningStage stage, const std::string& text) const;
  OrderedJson state() const;
  template <typename Use>
  void withPlant(Use use) const;
  OrderedJson watchPlant();
  OrderedJson testPlant();
  OrderedJson findModel();
  OrderedJson design();

  CommissioningBrief brief_;
  std::string folder_;
  CommissioningOptions options_;
  PlantRecord watched_;  // of a plant that lives, in the life of this object
};

}  // namespace fpc
