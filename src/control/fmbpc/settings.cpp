// What may change of the fuzzy model-based predictive law in a run.
#include "control/fmbpc/law.hpp"

namespace fpc {

const SettingsTable<FmbpcParams>& fmbpcSettings() {
  static const SettingsTable<FmbpcParams> table = [] {
    SettingsTable<FmbpcParams> t;
    t.integer("coincidence_steps", &FmbpcParams::coincidence_steps,
              "H [samples], where the outputs meet their references (published, general)", 1,
              100000);
    t.ofOutputs("reference_pole", &FmbpcParams::reference_pole,
                "how slowly references go to the setpoint, [0, 1): 'x=0.9 s=0.8', or one number");
    t.ofOutputs("weight_output", &FmbpcParams::weight_output,
                "of squared errors (general, iterated): 'x=1 s=2', or '1 2', or one number");
    t.ofInputs("weight_move", &FmbpcParams::weight_move,
               "of squared moves (general, iterated), in the same way");
    t.ofInputs("weight_input", &FmbpcParams::weight_input,
               "of squared distances to input_target (iterated); leaves an offset");
    t.ofInputs("input_target", &FmbpcParams::input_target, "u_t (iterated), in the same way");
    t.integer("iterations", &FmbpcParams::iterations, "most linearisations per sample (iterated)",
              1, 1000);
    return t;
  }();
  return table;
}

}  // namespace fpc
