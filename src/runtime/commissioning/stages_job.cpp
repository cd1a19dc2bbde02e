// Fills the table through which the core reaches this library.
#include "runtime/commissioning/stages_job.hpp"

#include <algorithm>

#include "config/design_library.hpp"
#include "config/identified_file.hpp"
#include "runtime/commissioning/commissioning.hpp"

namespace fpc {
namespace {

CommissioningOptions optionsOf(const StagesWish& wish) {
  CommissioningOptions options;
  options.alive = wish.plant;
  options.running = wish.loop;
  if (wish.evaluations > 0) options.evaluations = wish.evaluations;
  if (wish.members > 0) options.members = wish.members;
  options.show = [show = wish.show](CommissioningStage stage, const std::string& text) {
    show(wordOf(stage), text);
  };
  return options;
}

class Stages : public StagesJob {
 public:
  explicit Stages(const StagesWish& wish)
      : until_(commissioningStage(wish.until, "until")),
        brief_(readBrief(wish.brief, wish.loop)),
        stages_(wish.brief, wish.folder, optionsOf(wish)) {
    if (!wish.again.empty()) stages_.undo(commissioningStage(wish.again, "again"));
  }
  bool needsPlant() const override {
    return until_ >= CommissioningStage::kWatch &&
           !stages_.done(std::min(until_, CommissioningStage::kTest));
  }
  const std::vector<std::string>& held() const override { return brief_.hold_asked; }
  const std::vector<double>& heldValues() const override { return brief_.hold_values; }
  void run() override { stages_.run(until_); }
  std::string figures() const override { return stages_.figures().dump(); }

 private:
  CommissioningStage until_;
  CommissioningBrief brief_;
  Commissioning stages_;
};

std::unique_ptr<StagesJob> makeStages(const StagesWish& wish) {
  return std::make_unique<Stages>(wish);
}

}  // namespace

extern "C" void fmbpcDesignLibrary(DesignLibrary& library) {
  library = {&identifyRecord, &readIdentified, &makeStages};
}

}  // namespace fpc
